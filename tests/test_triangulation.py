"""The Delaunay kernel against scipy (Qhull), on point sets whose triangulation is unique by a wide margin."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

import DelaunayMesher
from DelaunayMesher import quality

RANDOM = np.random.default_rng(7)
POINT_SETS = {
    "cube": RANDOM.random((3000, 3)),
    "normal": RANDOM.normal(size=(3000, 3)),
    "ball, denser in the middle": RANDOM.normal(size=(2000, 3)) * (0.1 + RANDOM.random((2000, 1))),
    "flat box": RANDOM.random((2000, 3)) * [10, 10, 1],
    "clusters": np.repeat(RANDOM.random((20, 3)), 100, axis=0) + 0.03 * RANDOM.normal(size=(2000, 3)),
    "shaken grid": np.indices((12, 12, 12)).reshape(3, -1).T + 0.3 * RANDOM.random((1728, 3)),
    "far from the origin": 1000 + RANDOM.random((1500, 3)),
    "micrometres": 1e-6 * RANDOM.random((1500, 3)),
}


def as_set(tets):
    return {tuple(row) for row in np.sort(tets, axis=1).tolist()}


@pytest.mark.parametrize("name", POINT_SETS)
def test_same_tetrahedra_as_scipy(name):
    points = POINT_SETS[name]
    tets = DelaunayMesher.delaunay(points)
    assert (quality.volumes(points, tets) > 0).all()
    # Qhull decides in rounded arithmetic: leave out what is flat to its rounding, on the hull.
    theirs = Delaunay(points).simplices
    size = np.ptp(points, axis=0).max()
    thin = 1e-14 * size**3
    keep_ours = quality.volumes(points, tets) > thin
    keep_theirs = np.abs(quality.volumes(points, theirs)) > thin
    assert as_set(tets[keep_ours]) == as_set(theirs[keep_theirs])
    assert keep_ours.mean() > 0.99


def test_hull_volume_of_points_on_a_sphere():
    points = RANDOM.normal(size=(2000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    tets = DelaunayMesher.delaunay(points)
    assert quality.volumes(points, tets).sum() == pytest.approx(ConvexHull(points).volume, rel=1e-12)


def test_threads_do_not_change_the_result():
    points = RANDOM.random((20000, 3))
    assert np.array_equal(DelaunayMesher.delaunay(points), DelaunayMesher.delaunay(points, threads=2))
