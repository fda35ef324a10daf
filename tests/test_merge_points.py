"""Merging points: everything within the tolerance, nothing far beyond it."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from DelaunayMesher.merge_points import merge_points


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**31), st.sampled_from([1e-7, 1e-3]), st.sampled_from([1.0, 1e5]))
def test_merges_what_is_near_and_only_that(seed, tolerance, size):
    random = np.random.default_rng(seed)
    points = random.uniform(-size, size, (60, 3))
    points[:10] = np.round(points[:10] / (4 * tolerance)) * (4 * tolerance)  # on borders of cells
    copies = points + random.uniform(-0.5, 0.5, points.shape) * tolerance
    everything = np.concatenate([points, copies])
    root = merge_points(everything, tolerance)
    assert (root[root] == root).all() and (root <= np.arange(len(root))).all()
    near = cKDTree(everything).query_pairs(tolerance, output_type="ndarray")
    assert (root[near[:, 0]] == root[near[:, 1]]).all()
    assert np.linalg.norm(everything - everything[root], axis=1).max() < 30 * tolerance


def test_no_points():
    assert len(merge_points(np.zeros((0, 3)), 1e-7)) == 0
