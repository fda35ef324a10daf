import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from DelaunayMesher.errors import InputError
from DelaunayMesher.polygons import plane_triangles, triangulate_facet


def area_vector(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a).sum(axis=0) / 2


def star(random, count):
    """Corners of a star-shaped polygon round the origin."""
    angle = 2 * np.pi * (np.arange(count) + random.uniform(0, 0.9, count)) / count
    radius = random.uniform(0.3, 1, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(count)], axis=1)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1), st.integers(4, 60))
def test_star_with_a_hole_anywhere_in_space(seed, count):
    random = np.random.default_rng(seed)
    flat = star(random, count)
    turned = np.concatenate([flat, 0.05 * flat]) @ np.linalg.qr(random.normal(size=(3, 3)))[0]
    outer, inner = list(range(count)), list(range(count, 2 * count))
    expected = np.cross(turned[:count], np.roll(turned[:count], -1, axis=0)).sum(axis=0) / 2
    full = triangulate_facet(turned, [outer])
    assert len(full) == count - 2
    assert area_vector(turned, full) == pytest.approx(expected, abs=1e-12)
    holed = triangulate_facet(turned, [outer, inner], [np.zeros(3)])
    assert len(holed) == 2 * count
    assert area_vector(turned, holed) == pytest.approx((1 - 0.05**2) * expected, abs=1e-12)


def grid(count):
    return np.array([[i, j, 0.0] for i in range(count) for j in range(count)])


def test_points_on_the_sides_stay():
    rim = [0, 1, 2, 3, 7, 11, 15, 14, 13, 12, 8, 4]
    assert len(triangulate_facet(grid(4), [rim])) == 10
    with_points = triangulate_facet(grid(4), [rim, [5], [6], [9], [10]])
    assert len(with_points) == 18
    with_segment = triangulate_facet(grid(4), [rim, [5, 10], [6], [9]])
    edges = {frozenset(pair) for t in with_segment.tolist() for pair in zip(t, t[1:] + t[:1])}
    assert frozenset((5, 10)) in edges


def test_orientation_follows_the_polygon():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    assert area_vector(square, triangulate_facet(square, [[0, 1, 2, 3]]))[2] == pytest.approx(1)
    assert area_vector(square, triangulate_facet(square, [[3, 2, 1, 0]]))[2] == pytest.approx(-1)


def test_crossing_polygons_are_refused():
    points = np.array(
        [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [2, 2, 0], [6, 2, 0], [6, 3, 0], [2, 3, 0.0]]
    )
    with pytest.raises(InputError) as caught:
        triangulate_facet(points, [[0, 1, 2, 3], [4, 5, 6, 7]])
    assert caught.value.code == "bad_facet"


def test_facet_without_area_is_refused():
    with pytest.raises(InputError):
        triangulate_facet(np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0.0]]), [[0, 1, 2, 3]])


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 2**32 - 1), st.integers(8, 40), st.integers(0, 60))
def test_inner_edges_are_delaunay(seed, count, inner):
    """No corner of a neighbour lies in the circle of a triangle (distances, instead of a determinant)."""
    random = np.random.default_rng(seed)
    points = np.concatenate([star(random, count), 0.1 * star(random, inner + 4)])
    loops = [list(range(count)), *([number] for number in range(count, len(points)))]
    triangles = plane_triangles(points, loops)
    assert len(triangles) == count - 2 + 2 * (len(points) - count)
    beyond = {}
    for corners in triangles.tolist():
        for k in range(3):
            beyond[corners[k], corners[k - 2]] = corners[k - 1]
    for (a, b), c in beyond.items():
        d = beyond.get((b, a))
        if d is None or {a, b} <= set(loops[0]):
            continue
        p, q, r = (points[v][:2] for v in (a, b, c))
        rows = np.array([q - p, r - p])
        if abs(np.linalg.det(rows)) < 1e-9:
            continue
        centre = p + np.linalg.solve(2 * rows, (rows**2).sum(axis=1))
        radius = np.linalg.norm(centre - p)
        assert np.linalg.norm(centre - points[d][:2]) > radius - 1e-6 * max(radius, 1)


def test_a_hole_is_left_open_and_points_in_the_plane_stay():
    points = np.array(
        [[0, 0, 0], [6, 0, 0], [6, 6, 0], [0, 6, 0], [1, 1, 0], [1, 3, 0], [3, 3, 0], [3, 1, 0], [5, 5, 0.0]]
    )
    triangles = plane_triangles(points, [[0, 1, 2, 3], [4, 5, 6, 7], [8]])
    assert area_vector(points, triangles)[2] == pytest.approx(32)
    assert (triangles == 8).any()
    assert plane_triangles(points, [[0, 2, 1, 3]]) is None


def test_a_segment_across_very_many_edges():
    """One corner a hair off a straight side of many points: its triangles reach along all of them."""
    count = 300
    side = [[0.0, y, 0.0] for y in np.linspace(0, 29, count)]
    points = np.array(
        [*side, [0.07, 28.9, 0], [2, 28.8, 0], [2e-15, 29.4, 0], [0, 37, 0], [6, 37, 0], [6, 0, 0.0]]
    )
    triangles = triangulate_facet(points, [list(range(len(points)))])
    assert len(triangles) == len(points) - 2
    right = points[[0, count - 1, *range(count, len(points))]]  # the same outline
    outline = np.cross(right, np.roll(right, -1, axis=0)).sum(axis=0) / 2
    assert area_vector(points, triangles) == pytest.approx(outline)
