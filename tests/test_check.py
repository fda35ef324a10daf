"""The exact checks: clean meshes pass, every kind of fault is found."""

import numpy as np
import pytest
from sample_surfaces import box, joined, sphere

import DelaunayMesher
from DelaunayMesher import check, quality

SQUARE = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4], [4, 4, 4.0]])
TWO = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])


def positive(points, tets):
    flipped = quality.volumes(points, tets) < 0
    return np.where(flipped[:, None], tets[:, [1, 0, 2, 3]], tets)


@pytest.mark.parametrize("surface, size", [(box(), 0.2), (sphere(), 0.3)], ids=["box", "sphere"])
def test_a_mesh_that_is_not_optimised_is_delaunay(surface, size):
    found = check.verify(DelaunayMesher.mesh(surface, max_size=size, optimise=False))
    assert found.pop("delaunay") == "yes"
    assert all(len(faults) == 0 for faults in found.values())


def test_an_optimised_mesh_with_two_solids_and_second_order():
    surface = joined(box(), box((1, 0, 0), (2, 1, 1)))
    found = check.verify(DelaunayMesher.mesh(surface, max_size=0.2, order=2), target=25)
    assert found.pop("delaunay") == "no"
    assert all(len(faults) == 0 for faults in found.values())


def test_a_higher_limit_is_not_met():
    mesh = DelaunayMesher.mesh(box(), max_size=0.25, optimise=False)
    angles = quality.dihedral_angles(mesh.points, mesh.tets).min(axis=1)
    assert check.slivers(mesh.points, mesh.tets, 30).tolist() == np.flatnonzero(angles < 30).tolist()


def test_faults_of_the_boundary():
    mesh = DelaunayMesher.mesh(box(), max_size=0.5)
    given = mesh.tets, mesh.tet_solid
    assert len(check.wrong_boundary(*given, mesh.triangles)) == 0
    missing = check.wrong_boundary(*given, mesh.triangles[1:])
    assert missing.tolist() == [sorted(mesh.triangles[0].tolist())]
    other = mesh.tet_solid.copy()
    other[5] = 2
    assert len(check.wrong_boundary(mesh.tets, other, mesh.triangles)) in (1, 2, 3, 4)
    assert len(
        check.wrong_boundary(np.concatenate([mesh.tets, mesh.tets[:1]]), np.ones(len(other) + 1), [[0, 1, 2]])
    )


def test_inverted():
    tets = positive(SQUARE, TWO)
    assert len(check.inverted(SQUARE, tets)) == 0
    assert check.inverted(SQUARE, tets[:, [1, 0, 2, 3]]).tolist() == [0, 1]
    flat = np.array([[0, 0, 0], [0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [1, 0, 0]])
    assert check.inverted(flat, [[0, 1, 2, 3]]).tolist() == [0]


@pytest.mark.parametrize("inwards, faults", [(-1e-15, 0), (0, 0), (4e-15, 2)])
def test_not_delaunay_to_the_last_bit(inwards, faults):
    points = SQUARE.copy()
    points[4] -= inwards  # (4, 4, 4) lies on the sphere of the other four
    tets = positive(points, TWO)
    assert len(check.not_delaunay(points, tets)) == faults // 2
    assert len(check.points_in_spheres(points, tets)) == faults
    assert len(check.not_delaunay(points, tets, [[3, 2, 1]])) == 0  # constrained there


def test_a_point_behind_the_boundary():
    apart = np.concatenate([SQUARE[:4], SQUARE[:4] + [2.5, 2.5, 2.5]])
    tets = positive(apart, np.array([[0, 1, 2, 3], [4, 5, 6, 7]]))
    assert len(check.not_delaunay(apart, tets)) == 0
    assert [0, 4] in check.points_in_spheres(apart, tets).tolist()


def test_an_angle_at_the_limit_is_decided_exactly():
    # The dihedral angle at the edge from corner 0 to corner 1 is 45 degrees, or nearly so.
    for tilt, sharp in ((1.0, False), (1 - 1e-8, True), (1 + 1e-8, False)):
        points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, 1, tilt]])
        tets = positive(points, np.array([[0, 1, 2, 3]]))
        assert (len(check.slivers(points, tets, 45)) == 1) == sharp


def test_flat_elements_are_slivers():
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1e-13]])
    assert check.slivers(points, positive(points, np.array([[0, 1, 2, 3]])), 1e-9).tolist() == []
    assert check.slivers(points, positive(points, np.array([[0, 1, 2, 3]])), 1e-6).tolist() == [0]


def test_nothing_to_check():
    none = np.zeros((0, 4), dtype=np.int32)
    assert len(check.slivers(SQUARE, none, 20)) == len(check.inverted(SQUARE, none)) == 0
    assert len(check.not_delaunay(SQUARE, none)) == 0
