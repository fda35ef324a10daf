"""Wedges, spikes and slits: what an acute angle of the input may cost, as properties of a sweep."""

import numpy as np
import pytest

from DelaunayMesher import mesh, quality
from DelaunayMesher.plc import Plc

SIZE = 0.05


def wedge(angle):
    """Points and triangles of a block 1 x 1 whose two square faces meet at `angle` degrees."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    points = np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (c, 0, s), (c, 1, s)], float)
    faces = [(0, 1, 3, 2), (0, 4, 5, 1), (0, 2, 4), (1, 5, 3), (2, 3, 5, 4)]
    triangles = [(f[0], f[i], f[i + 1]) for f in faces for i in range(1, len(f) - 1)]
    return points, np.array(triangles)


def mesh_wedge(angle):
    made = mesh(wedge(angle), max_size=SIZE, threads=1)
    tets = np.asarray(made.tets)
    return np.asarray(made.points), tets, quality.dihedral_angles(made.points, tets).min(axis=1)


def check_wedge(angle):
    points, tets, angles = mesh_wedge(angle)
    volume = 0.5 * np.sin(np.radians(angle))
    assert quality.volumes(points, tets).sum() == pytest.approx(volume, rel=1e-9)
    assert angles.min() > 0.6 * min(angle, 30)
    # The strip in which the solid is thinner than half an element decides its angles; nothing else is bad.
    thin = 0.5 * SIZE / np.tan(np.radians(angle))
    bad = angles < 20
    nearest = points[tets[bad], :].reshape(-1, 4, 3)[:, :, [0, 2]]
    distance = np.hypot(nearest[:, :, 0], nearest[:, :, 1]).min(axis=1)
    assert (distance > 1.5 * thin + SIZE).sum() <= 5
    return len(tets), int(bad.sum())


def test_wedge_of_5_degrees():
    count, bad = check_wedge(5)
    assert count < 5500
    assert bad < 0.1 * count


@pytest.mark.long
def test_wedges_from_90_to_1_degree():
    """Sharper wedges hold less and so have fewer elements: nothing blows up on the way."""
    counts = [check_wedge(angle)[0] for angle in (90, 75, 60, 45, 30, 20, 15, 10, 7, 5, 3, 2, 1.5, 1)]
    for wider, sharper in zip(counts, counts[1:]):
        assert sharper < 1.05 * wider


def spike():
    """Points and triangles of a pyramid of height 1 on a square of 0.03."""
    a = 0.03
    points = np.array([(0, 0, 0), (a, 0, 0), (a, a, 0), (0, a, 0), (a / 2, a / 2, 1)], float)
    return points, np.array([(0, 2, 1), (0, 3, 2), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])


@pytest.mark.parametrize("angle", [2, 5])
def test_what_is_forced_by_the_input_is_said_to_be(angle):
    """Also away from the sharp edge, where elements reach from one side to the other."""
    made = mesh(wedge(angle), max_size=SIZE, threads=1)
    forced = [bad for bad in made.below_target if bad["angle"] < 10]
    assert forced
    assert {bad["reason"] for bad in forced} == {"input_angle"}


def test_the_tip_of_a_spike_is_cut_off():
    """At a fiftieth of the size, and that is said."""
    made = mesh(spike(), max_size=SIZE, threads=1)
    assert quality.dihedral_angles(made.points, made.tets).min() > 25
    assert 1 - SIZE / 50 / 0.03 < made.points[:, 2].max() < 1
    assert "Vertex5" in made.warnings[0]


def test_what_is_not_forced_by_the_input_is_not_said_to_be():
    made = mesh(wedge(90), max_size=0.3, target_angle=30, optimise=False, threads=1)
    assert {bad["reason"] for bad in made.below_target} == {"fallback"}


def test_a_face_that_meets_itself_explains_only_what_lies_at_the_edge():
    """The outline is a drop: two lines at 40 degrees and an arc, one face all round."""
    half = np.radians(20)
    arc = np.linspace(np.pi / 2 + half, -np.pi / 2 - half, 30)
    outline = np.concatenate([[(0, 0)], [(np.cos(a) + 1 / np.sin(half), np.sin(a)) for a in arc]])
    n = len(outline)
    points = np.concatenate([np.insert(outline, 2, z, axis=1) for z in (0, 1)])
    sides = [((i + 1) % n, i, i + n, (i + 1) % n + n) for i in range(n)]
    triangles = [(a, b, c) for a, b, c, _ in sides] + [(a, c, d) for a, _, c, d in sides]
    triangles += [(0, i, i + 1) for i in range(1, n - 1)] + [(n, n + i + 1, n + i) for i in range(1, n - 1)]
    drop = Plc.from_triangles(points, np.array(triangles))
    assert len(drop.face_solids) == 3
    made = mesh(drop, max_size=0.15, target_angle=30, optimise=False, threads=1)
    away = [bad["reason"] for bad in made.below_target if bad["place"][0] > 1]
    assert away
    assert set(away) == {"fallback"}
