"""Closed pieces of one triangulated surface: apart, nested, touching, crossing."""

import numpy as np
import pytest
from sample_surfaces import box, joined, sphere, volume

from DelaunayMesher import pipeline
from DelaunayMesher.errors import MeshError
from DelaunayMesher.overlaps import find_overlaps
from DelaunayMesher.surface_plcs import to_plcs

UNIT = box()


def volumes(plcs):
    return [plc.volume(solid) for plc in plcs for solid in range(1, plc.solid_count + 1)]


@pytest.mark.parametrize(
    "low, high",
    [
        ((0.3, 0.4, 0.6), (0.8, 0.7, 1.2)),  # pokes out: its largest facets lie outside
        ((0.3, 0.4, 0.2), (0.8, 0.7, 1.05)),  # ... or inside, as those of a cavity would
        ((0.5, 0.5, 0.5), (1.5, 1.5, 1.5)),  # passes only through edges of the triangles
        ((-1, 0.2, 0.3), (2, 0.4, 0.6)),  # no corner of one lies in the other
    ],
)
def test_pieces_that_cross_are_solids_of_their_own(low, high):
    plcs = to_plcs(*joined(UNIT, box(low, high)))
    assert volumes(plcs) == pytest.approx([1, np.prod(np.subtract(high, low))])
    assert "cross or overlap each other" in plcs[0].warnings[0]
    assert [plc.solid_numbers.tolist() for plc in plcs] == [[1], [2]]
    assert np.unique(plcs[0].triangle_face).tolist() == list(range(6))
    assert np.unique(plcs[1].triangle_face).tolist() == list(range(6, 12))
    for plc in plcs:
        plc.check()


def test_pieces_that_do_not_cross_stay_together():
    for other in (
        box((2, 0, 0), (3, 1, 1)),
        box((0.2, 0.2, 0.2), (0.8, 0.8, 0.8)),
        box((1, 0, 0), (2, 1, 1)),
    ):
        plcs = to_plcs(*joined(UNIT, other))
        assert len(plcs) == 1 and not plcs[0].warnings
    cavity = to_plcs(*joined(UNIT, box((0.2, 0.2, 0.2), (0.8, 0.8, 0.8))))
    assert volumes(cavity) == pytest.approx([1 - 0.6**3])


@pytest.mark.parametrize("seed", range(8))
def test_orientation_of_the_triangles_does_not_matter(seed):
    cavity = joined(UNIT, box((0.1, 0.2, 0.3), (0.8, 0.7, 0.6)))
    crossing = joined(UNIT, box((0.5, 0.5, 0.5), (1.5, 1.5, 1.5)))
    for (points, triangles), expected, count in ((cavity, [1 - 0.7 * 0.5 * 0.3], 1), (crossing, [1, 1], 2)):
        flip = np.random.default_rng(seed).random((len(triangles), 1)) < 0.5
        plcs = to_plcs(points, np.where(flip, triangles[:, ::-1], triangles))
        assert volumes(plcs) == pytest.approx(expected) and len(plcs) == count


def test_a_cavity_of_one_of_several_that_cross():
    crossing = joined(UNIT, box((0.1, 0.1, 0.1), (0.3, 0.3, 0.3)), box((0.7, 0.7, 0.7), (1.5, 1.5, 1.5)))
    assert volumes(to_plcs(*crossing)) == pytest.approx([1 - 0.2**3, 0.8**3])


def test_bodies_that_lie_on_each_other_with_other_triangles():
    """The upper one stands on a part of the lower one's top, with two corners in common."""
    same_wall = box((0, 0.5, 1), (1, 1, 2))  # as the second one
    surface = joined(UNIT, box((0, 0, 1), (1, 0.5, 2)), same_wall, box((3, 0, 0), (4, 1, 1)))
    plcs = to_plcs(*surface)
    assert sorted(volumes(plcs)) == pytest.approx([0.5, 0.5, 1, 1])
    assert len(plcs) == 3 and "overlap" in plcs[0].warnings[0]
    with pytest.raises(MeshError) as caught:  # no body after the other: nothing says what belongs together
        to_plcs(surface[0], np.random.default_rng(1).permutation(surface[1]))
    assert caught.value.code == "overlap"


def test_the_mesh_of_pieces_that_cross():
    ball = sphere(0.4)
    result = pipeline.run(joined(UNIT, (ball[0] + 1, ball[1])), {"max_size": 0.2, "sizes": {"Solid2": 0.1}})
    assert sorted(set(result.tet_solid.tolist())) == [1, 2]
    corners = result.points[result.tets]
    of_tet = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    assert of_tet[result.tet_solid == 1].sum() == pytest.approx(1)
    assert of_tet[result.tet_solid == 2].sum() == pytest.approx(volume(*ball), rel=0.03)
    edges = np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1)
    assert edges[result.tet_solid == 2].mean() < 0.7 * edges[result.tet_solid == 1].mean()


def corners(surface):
    return surface[0][surface[1]]


def test_overlaps():
    bodies = [corners(UNIT), corners(box((0.5, 0.5, 0.5), (2, 2, 2))), corners(box((1, 0, 0), (2, 0.4, 0.4)))]
    bodies.append(corners(box((0.1, 0.1, 0.1), (0.2, 0.2, 0.2))))
    known = np.zeros((4, 4), dtype=bool)
    found = {(inner, outer): (place, whole) for inner, outer, place, whole in find_overlaps(bodies, known)}
    assert sorted(found) == [(0, 1), (1, 0), (3, 0)]
    assert [whole for _, whole in found.values()] == [False, False, True]
    assert (found[1, 0][0] == 0.5).all() and (found[0, 1][0] == 1).all()
    known[:, 0] = True
    assert [item[:2] for item in find_overlaps(bodies, known)] == [(0, 1)]
