"""Triangle soup -> a surface with shared points: merge what coincides, drop what is flat or unused."""

import numpy as np

from .cells import half_edges
from .errors import MeshError
from .merge_points import merge_points
from .sizing import diagonal

EXACT = 1e-10  # relative to the diagonal: the same point written twice
LOOSE = 1e-6  # what single precision files may leave open


def clean(points, triangles, labels=None, repeated=False):
    """Points (n, 3), triangles (m, 3) int64 and labels (m,) without duplicates, and a list of warnings.

    repeated: whether triangles on the same three points all stay, as walls between two bodies have them.
    Merges points closer than 1e-10 of the diagonal; if edges stay open, closer than 1e-6 (single precision).
    Raises MeshError for an empty surface, numbers that are not finite and indices out of range.
    """
    points = np.array(points, dtype=np.float64)
    triangles = np.array(triangles, dtype=np.int64)
    if triangles.size == 0 or points.size == 0:
        raise MeshError("plc", "empty", "there is nothing to mesh: the surface has no triangles")
    if points.ndim != 2 or points.shape[1] != 3 or triangles.ndim != 2 or triangles.shape[1] != 3:
        raise MeshError("plc", "bad_array", "points must be (n, 3) and triangles (m, 3)")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise MeshError("plc", "out_of_range", "a triangle uses a point that does not exist")
    labels = np.zeros(len(triangles), np.int64) if labels is None else np.array(labels, np.int64)
    used = np.unique(triangles)
    if not np.isfinite(points[used]).all():
        bad = used[~np.isfinite(points[used]).all(axis=1)][0]
        raise MeshError("plc", "not_finite", "point %d has a coordinate that is no number" % bad)
    points, triangles = points[used], np.searchsorted(used, triangles)
    length = diagonal(points)
    if length == 0:
        raise MeshError("plc", "empty", "all points of the surface coincide", points[0])
    spread = np.linalg.svd(np.cov(points.T), compute_uv=False)
    if spread[2] <= (EXACT * length) ** 2:
        raise MeshError("plc", "zero_volume", "all points of the surface lie in one plane", points[0])
    merged = _merged(points, triangles, labels, EXACT * length, repeated)
    warnings = []
    if _has_open_edges(merged[0]):
        loose = _merged(points, triangles, labels, LOOSE * length, repeated)
        if not _has_open_edges(loose[0]):
            merged = loose
            warnings.append("points closer than %.3g mm were merged to close the surface" % (LOOSE * length))
    triangles, labels = merged
    if len(triangles) == 0:
        raise MeshError("plc", "empty", "there is nothing to mesh: all triangles are flat")
    return points, triangles, labels, warnings


def _merged(points, triangles, labels, tolerance, repeated):
    """Triangles on merged points, without flat ones, and repeated ones unless wanted."""
    triangles = merge_points(points - points[0], tolerance)[triangles]
    a, b, c = triangles.T
    keep = (a != b) & (b != c) & (c != a)
    triangles, labels = triangles[keep], labels[keep]
    if repeated:
        return triangles, labels
    order, same = _same_as_before(np.sort(triangles, axis=1).T)
    first = np.sort(order[~same])
    return triangles[first], labels[first]


def _has_open_edges(triangles):
    return bool((half_edges(triangles).sizes == 1).any())


def _same_as_before(columns):
    """Order that sorts rows given as columns, and whether each row in that order equals the one before it."""
    order = np.lexsort(columns)
    same = np.zeros(len(order), bool)
    same[1:] = np.all([np.diff(column[order]) == 0 for column in columns], axis=0)
    return order, same


def drop_unused(points, triangles, segments, corners):
    """The same with the points renumbered so that each belongs to a triangle."""
    used = np.unique(triangles)
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    return points[used], number[triangles], number[segments], number[corners]
