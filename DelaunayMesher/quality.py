"""Quality of tetrahedra in plain numpy, independent of the core.

points (n, 3) float64; tets (t, 4) or (t, 10) in VTK order (mid-side nodes 01 12 02 03 13 23). Every measure
but the Jacobian of second order looks at the four corners only.
"""

from itertools import combinations
from math import factorial

import numpy as np

DIHEDRAL_LIMITS = (5, 10, 15, 20, 30)
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
CHUNK = 50000  # elements at once where a measure needs much memory per element
BINADES, BINS = 50, 5000  # of median(): powers of two on either side of 1, and parts of each


def corners(points, tets):
    """(4, t, 3) coordinates of the corners."""
    return points[np.asarray(tets)[:, :4].T]


def volumes(points, tets):
    """(t,) signed volumes; positive for VTK order."""
    a, b, c, d = corners(points, tets)
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def _face_vectors(points, tets):
    """(4, t, 3) outward area vectors (twice the area) of the faces opposite each corner."""
    a, b, c, d = corners(points, tets)
    return np.stack(
        [np.cross(c - b, d - b), np.cross(d - a, c - a), np.cross(b - a, d - a), np.cross(c - a, b - a)]
    )


def dihedral_angles(points, tets):
    """(t, 6) dihedral angles in degrees; 0 where a face is flat."""
    normals = _face_vectors(points, tets)
    normals *= np.where(volumes(points, tets) < 0, -1.0, 1.0)[:, None]
    angles = np.empty((normals.shape[1], 6))
    for column, (i, j) in enumerate(combinations(range(4), 2)):
        # The half-angle form keeps full precision near 0 and 180 degrees.
        m, n = normals[i], normals[j]
        lm, ln = (np.linalg.norm(v, axis=1)[:, None] for v in (m, n))
        along, across = np.linalg.norm(m * ln - n * lm, axis=1), np.linalg.norm(m * ln + n * lm, axis=1)
        angles[:, column] = 180 - np.degrees(2 * np.arctan2(along, across))
        angles[(lm * ln)[:, 0] == 0, column] = 0
    return angles


def edge_lengths(points, tets):
    """(t, 6) lengths of the edges 01 12 02 03 13 23."""
    p = corners(points, tets)
    return np.stack([np.linalg.norm(p[i] - p[j], axis=1) for i, j in EDGES], axis=1)


def inradius(points, tets):
    """(t,) radius of the inscribed sphere."""
    areas = np.linalg.norm(_face_vectors(points, tets), axis=2).sum(axis=0) / 2
    return _ratio(3 * np.abs(volumes(points, tets)), areas)


def circumradius(points, tets):
    """(t,) radius of the circumscribed sphere; infinite for flat elements."""
    a, b, c, d = corners(points, tets)
    u, v, w = b - a, c - a, d - a
    lu, lv, lw = (np.einsum("ij,ij->i", x, x)[:, None] for x in (u, v, w))
    top = np.linalg.norm(lu * np.cross(v, w) + lv * np.cross(w, u) + lw * np.cross(u, v), axis=1)
    below = 12 * np.abs(volumes(points, tets))
    return np.divide(top, below, out=np.full(len(top), np.inf), where=below > 0)


def radius_ratio(points, tets):
    """(t,) 3 * inradius / circumradius: 1 for a regular tetrahedron, 0 for a flat one."""
    return 3 * inradius(points, tets) / circumradius(points, tets)


def radius_edge_ratio(points, tets):
    """(t,) circumradius / shortest edge: 0.612 for a regular tetrahedron."""
    return _ratio(circumradius(points, tets), edge_lengths(points, tets).min(axis=1), np.inf)


def aspect_ratio(points, tets):
    """(t,) longest edge / (2 sqrt 6 * inradius): 1 for a regular tetrahedron, infinite for a flat one."""
    return _ratio(edge_lengths(points, tets).max(axis=1), 2 * np.sqrt(6) * inradius(points, tets), np.inf)


def scaled_jacobian(points, tets):
    """(t,) smallest Jacobian over the corners divided by the edges' lengths: 1 for a regular tetrahedron.

    For 10 nodes: the smallest Bernstein coefficient of the Jacobian (jacobian_coefficients) instead of the
    Jacobian of the straight element, so that a positive value proves the element valid everywhere.
    """
    lengths = edge_lengths(points, tets)
    at_corners = [lengths[:, [0, 2, 3]], lengths[:, [0, 1, 4]], lengths[:, [1, 2, 5]], lengths[:, [3, 4, 5]]]
    longest = np.max([edges.prod(axis=1) for edges in at_corners], axis=0)
    tets = np.asarray(tets)
    jacobian = 6 * volumes(points, tets)  # everywhere, in a straight element
    if tets.shape[1] == 10:
        curved = np.flatnonzero(is_curved(points, tets))
        jacobian[curved] = jacobian_coefficients(points, tets[curved]).min(axis=1)
    return _ratio(np.sqrt(2) * jacobian, longest)


def is_curved(points, tets):
    """(t,) whether a mid-side node of a 10-node element is off the middle by more than rounding."""
    ends = np.array(EDGES).T
    off = 2 * points[tets[:, 4:]] - points[tets[:, ends[0]]] - points[tets[:, ends[1]]]
    return np.abs(off).max(axis=(1, 2)) > 1e-14 * np.abs(points).max()


def _ratio(top, below, otherwise=0.0):
    return np.divide(top, below, out=np.full(len(top), float(otherwise)), where=below > 0)


_CUBIC = [(i, j, k, 3 - i - j - k) for i in range(4) for j in range(4 - i) for k in range(4 - i - j)]


def _bernstein_from_samples():
    """(20, 20): values of a cubic at the nodes (i, j, k, l) / 3 -> its Bernstein coefficients."""
    nodes = np.array(_CUBIC) / 3.0
    weights = [6 / np.prod([factorial(n) for n in power]) for power in _CUBIC]
    values = [weight * np.prod(nodes ** np.array(power), axis=1) for weight, power in zip(weights, _CUBIC)]
    return np.linalg.inv(np.array(values).T)


def _shape_derivatives(place):
    """(10, 3) derivatives of the ten shape functions at barycentric `place` by its last three coordinates."""
    full = np.zeros((10, 4))
    for i in range(4):
        full[i, i] = 4 * place[i] - 1
    for k, (i, j) in enumerate(EDGES):
        full[4 + k, i], full[4 + k, j] = 4 * place[j], 4 * place[i]
    return full[:, 1:] - full[:, :1]


def jacobian_coefficients(points, tets):
    """(t, 20) Bernstein coefficients of the Jacobian determinant of 10-node elements.

    The determinant is a cubic; it lies between its smallest and largest coefficient (Johnen, Remacle,
    Geuzaine 2013). 6 * volume everywhere for a straight element.
    """
    tets = np.asarray(tets)
    derivatives = np.stack([_shape_derivatives(np.array(node) / 3.0) for node in _CUBIC])
    to_bernstein = _bernstein_from_samples()
    result = np.empty((len(tets), 20))
    for start in range(0, len(tets), CHUNK):
        nodes = points[tets[start : start + CHUNK]]
        matrices = np.einsum("tnc,snd->tsdc", nodes, derivatives, optimize=True)
        result[start : start + CHUNK] = np.linalg.det(matrices) @ to_bernstein.T
    return result


def summary(points, tets):
    """The report's quality section: worst and mean angles, counts below 5 10 15 20 30 degrees, ratios.

    Nothing is kept for each element, so that it takes less memory than the mesher did.
    """
    if len(tets) == 0:
        return {}
    parts = [tets[start : start + CHUNK] for start in range(0, len(tets), CHUNK)]
    histogram, below = np.zeros(36, np.int64), np.zeros(len(DIHEDRAL_LIMITS), np.int64)
    lows, highs, sums, length_counts = [], [], np.zeros(2), 0
    for part in parts:
        angles = dihedral_angles(points, part)
        smallest = angles.min(axis=1)
        lengths, inside, outside = (f(points, part) for f in (edge_lengths, inradius, circumradius))
        radius_edge = _ratio(outside, lengths.min(axis=1), np.inf)
        aspect = _ratio(lengths.max(axis=1), 2 * np.sqrt(6) * inside, np.inf)
        length_counts += logarithms(lengths)
        histogram += np.histogram(angles, 36, (0, 180))[0]
        below += [(smallest < limit).sum() for limit in DIHEDRAL_LIMITS]
        sums += smallest.sum(), radius_edge.sum()
        lows.append((smallest.min(), (3 * inside / outside).min(), volumes(points, part).min()))
        highs.append((angles.max(), radius_edge.max(), aspect.max()))
    low, high = np.min(lows, axis=0).tolist(), np.max(highs, axis=0).tolist()
    result = {
        "min_dihedral": low[0],
        "max_dihedral": high[0],
        "mean_min_dihedral": float(sums[0] / len(tets)),
        "below": {str(limit): int(count) for limit, count in zip(DIHEDRAL_LIMITS, below)},
        "histogram": {"degrees": list(range(0, 181, 5)), "counts": histogram.tolist()},
        "radius_edge_max": high[1],
        "radius_edge_mean": float(sums[1] / len(tets)),
        "radius_ratio_min": low[1],
        "aspect_max": high[2],
        "min_volume": low[2],
        "median_edge": median(length_counts),
    }
    if np.asarray(tets).shape[1] == 10:
        result["min_scaled_jacobian"] = float(min(scaled_jacobian(points, part).min() for part in parts))
    return result


def logarithms(values):
    """Histogram of the logarithms of positive numbers, for median()."""
    bins = (BINS * (np.log2(values.ravel()) + BINADES)).astype(np.int64)
    return np.bincount(np.clip(bins, 0, 2 * BINADES * BINS - 1), minlength=2 * BINADES * BINS)


def median(counts):
    """Median of numbers of which the sum of logarithms() is given, to 1e-4 of it."""
    middle = np.searchsorted(np.cumsum(counts), counts.sum() / 2)
    return float(2.0 ** ((middle + 0.5) / BINS - BINADES))
