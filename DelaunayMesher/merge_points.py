"""Merges points that coincide within a tolerance, without a loop over points."""

import itertools

import numpy as np

HASH_FACTORS = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)
DIRECTION = np.array([0.41357, 0.67291, 0.61328])  # in which no two points of a part are likely to agree


def merge_points(points, tolerance):
    """Index of the representative (the first of its cluster) of each point.

    points: (n, 3) float64.  Returns (n,) int64 with ``result[result] == result``.  Two points within
    `tolerance` always share a representative: of two grids shifted by half a cell, at least one has no border
    between them, in each direction; so eight grids of cells 4 * tolerance see every pair. Points with no
    other at about the same distance along one direction are left out before.  Cost O(n log n).
    """
    root = np.arange(len(points))
    crowd = crowded(points, tolerance)
    root[crowd] = crowd[merge_in_grids(points[crowd], tolerance)]
    return root


def crowded(points, tolerance):
    """Indices, ascending, of the points that others may coincide with, judged along DIRECTION."""
    along = points @ DIRECTION
    order = np.argsort(along)
    rounding = 1e-14 * np.abs(along).max(initial=0.0)
    near = np.diff(along[order]) <= 7.0 * tolerance + rounding  # the diagonal of a cell
    doubtful = np.zeros(len(points), dtype=bool)
    doubtful[order[1:][near]] = doubtful[order[:-1][near]] = True
    return np.flatnonzero(doubtful)


def merge_in_grids(points, tolerance):
    """As merge_points(), of all points."""
    root = np.arange(len(points))
    for shift in itertools.product((0.0, 0.5), repeat=3):
        alive = np.flatnonzero(root == np.arange(len(root)))
        cells = np.floor(points[alive] / (4.0 * tolerance) + shift).astype(np.int64)
        key = (cells.view(np.uint64) * HASH_FACTORS).sum(axis=1, dtype=np.uint64)
        order = np.argsort(key, kind="stable")
        first = np.empty(len(order), dtype=bool)
        first[:1] = True
        first[1:] = key[order][1:] != key[order][:-1]
        leader = order[first][np.cumsum(first) - 1]
        same = (cells[order] == cells[leader]).all(axis=1)  # unequal cells with equal keys stay apart
        root[alive[order[same]]] = alive[leader[same]]
        root = root[root]
    return root
