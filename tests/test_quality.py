from itertools import product

import numpy as np
import pytest

from DelaunayMesher import quality

REGULAR = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]])
CORNER = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
ONE = np.array([[0, 1, 2, 3]])


def positive(points):
    return points if quality.volumes(points, ONE)[0] > 0 else points[[1, 0, 2, 3]]


def second_order(points):
    """The straight element of ten nodes."""
    return np.concatenate([points, [(points[i] + points[j]) / 2 for i, j in quality.EDGES]])


def test_regular_tetrahedron():
    points = positive(REGULAR)
    edge = np.sqrt(8)
    assert quality.volumes(points, ONE) == pytest.approx(edge**3 / np.sqrt(72))
    assert quality.dihedral_angles(points, ONE) == pytest.approx(np.degrees(np.arccos(1 / 3)))
    assert quality.edge_lengths(points, ONE) == pytest.approx(edge)
    assert quality.inradius(points, ONE) == pytest.approx(edge * np.sqrt(6) / 12)
    assert quality.circumradius(points, ONE) == pytest.approx(edge * np.sqrt(6) / 4)
    assert quality.radius_ratio(points, ONE) == pytest.approx(1)
    assert quality.aspect_ratio(points, ONE) == pytest.approx(1)
    assert quality.radius_edge_ratio(points, ONE) == pytest.approx(np.sqrt(6) / 4)
    assert quality.scaled_jacobian(points, ONE) == pytest.approx(1)


def test_corner_of_a_cube():
    assert quality.volumes(CORNER, ONE) == pytest.approx(1 / 6)
    slanted = np.degrees(np.arctan(np.sqrt(2)))
    assert sorted(quality.dihedral_angles(CORNER, ONE)[0]) == pytest.approx([slanted] * 3 + [90] * 3)
    assert quality.circumradius(CORNER, ONE) == pytest.approx(np.sqrt(3) / 2)
    assert quality.scaled_jacobian(CORNER, ONE) == pytest.approx(np.sqrt(2) / 2)


@pytest.mark.parametrize("angle", [1e-6, 0.01, 1, 30, 90, 150, 179, 179.999])
def test_angles_keep_their_precision(angle):
    turn = np.radians(angle)
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, np.cos(turn), np.sin(turn)]])
    assert quality.dihedral_angles(points, ONE)[0].tolist().count(0) == 0
    found = quality.dihedral_angles(points, ONE)[0]
    assert np.abs(found - angle).min() < 1e-9 * max(angle, 1)


def test_flat_and_inverted():
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]])
    angles = quality.dihedral_angles(flat, ONE)
    assert angles.min() == pytest.approx(0, abs=1e-5) and angles.max() == pytest.approx(180, abs=1e-5)
    assert quality.radius_ratio(flat, ONE)[0] == 0
    assert quality.radius_edge_ratio(flat, ONE)[0] == np.inf
    inverted = CORNER[[1, 0, 2, 3]]
    assert quality.volumes(inverted, ONE)[0] < 0
    assert quality.scaled_jacobian(inverted, ONE)[0] < 0
    assert quality.dihedral_angles(inverted, ONE)[0].sum() == pytest.approx(
        quality.dihedral_angles(CORNER, ONE)[0].sum()
    )


def jacobian_at(nodes, place):
    """Determinant by differences of the shape functions."""

    def position(u, v, w):
        b = np.array([1 - u - v - w, u, v, w])
        shape = [*(b * (2 * b - 1)), *(4 * b[i] * b[j] for i, j in quality.EDGES)]
        return np.array(shape) @ nodes

    step = 1e-6
    u, v, w = place
    columns = [
        (position(u + step, v, w) - position(u - step, v, w)) / (2 * step),
        (position(u, v + step, w) - position(u, v - step, w)) / (2 * step),
        (position(u, v, w + step) - position(u, v, w - step)) / (2 * step),
    ]
    return np.linalg.det(np.array(columns))


def test_straight_second_order_element():
    coefficients = quality.jacobian_coefficients(second_order(CORNER), np.arange(10)[None])
    assert coefficients == pytest.approx(1)
    points = second_order(positive(REGULAR))
    assert quality.scaled_jacobian(points, np.arange(10)[None]) == pytest.approx(1)


def test_only_curved_elements_need_coefficients():
    straight, bent = second_order(CORNER), second_order(CORNER)
    bent[7] += (0.05, 0.02, 0.0)
    points = np.concatenate([straight, bent]) + 1000.0  # far away, where midpoints are rounded
    tets = np.arange(20).reshape(2, 10)
    assert quality.is_curved(points, tets).tolist() == [False, True]
    lengths = quality.scaled_jacobian(points, tets[:, :4])
    smallest = quality.jacobian_coefficients(points, tets).min(axis=1) / (6 * quality.volumes(points, tets))
    assert quality.scaled_jacobian(points, tets) == pytest.approx(lengths * smallest)
    assert smallest[1] < 0.99


def test_bernstein_coefficients_bound_the_jacobian():
    random = np.random.default_rng(5)
    for bend in (0.02, 0.1, 0.3):
        nodes = second_order(CORNER)
        nodes[4:] += random.uniform(-bend, bend, (6, 3))
        coefficients = quality.jacobian_coefficients(nodes, np.arange(10)[None])[0]
        values = [jacobian_at(nodes, p) for p in product(np.linspace(0, 1, 7), repeat=3) if sum(p) <= 1]
        assert min(values) >= coefficients.min() - 1e-6
        assert max(values) <= coefficients.max() + 1e-6
        assert jacobian_at(nodes, (0, 0, 0)) in [pytest.approx(c, abs=1e-6) for c in coefficients]


def test_bent_too_far_is_seen():
    nodes = second_order(CORNER)
    nodes[4] += [0, 0.6, 0.6]  # the middle of edge 01 is pushed right through the element
    assert quality.scaled_jacobian(nodes, np.arange(10)[None])[0] < 0


def test_summary_counts():
    points = np.concatenate([positive(REGULAR), CORNER + 5])
    tets = np.array([[0, 1, 2, 3], [4, 5, 6, 7]])
    summary = quality.summary(points, tets)
    assert summary["min_dihedral"] == pytest.approx(np.degrees(np.arctan(np.sqrt(2))))
    assert summary["max_dihedral"] == pytest.approx(90)
    assert summary["below"] == {"5": 0, "10": 0, "15": 0, "20": 0, "30": 0}
    assert sum(summary["histogram"]["counts"]) == 12
    assert quality.summary(points, tets[:0]) == {}


def test_median_in_pieces():
    lengths = np.random.default_rng(1).lognormal(0.0, 2.0, 10001)
    assert quality.median(
        sum(quality.logarithms(part) for part in np.array_split(lengths, 7))
    ) == pytest.approx(np.median(lengths), rel=2e-4)
