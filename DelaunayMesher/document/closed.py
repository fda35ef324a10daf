"""Whether triangles enclose each solid: every directed edge is matched by its reverse."""

import numpy as np


def side_triangles(triangles, sides):
    """Triangles as each solid sees them, normals outward: (q, 3) corners, (q,) solid, (q,) row of triangles.

    sides: (m, 2) {solid behind, solid in front} per triangle.  A triangle with one solid on both sides bounds
    nothing and is left out.
    """
    rows = np.arange(len(triangles))
    real = sides[:, 0] != sides[:, 1]
    behind, front = real & (sides[:, 0] > 0), real & (sides[:, 1] > 0)
    corners = np.concatenate([triangles[behind], triangles[front][:, ::-1]])
    solid = np.concatenate([sides[behind, 0], sides[front, 1]])
    return corners, solid, np.concatenate([rows[behind], rows[front]])


def open_triangles(triangles, sides, point_count):
    """(rows, edges): triangles with an edge that is not matched in their solid, and the ends of that edge."""
    corners, solid, row = side_triangles(triangles, sides)
    start = corners.reshape(-1)
    end = np.roll(corners, -1, axis=1).reshape(-1)
    owner = np.repeat(solid, 3)
    low, high = np.minimum(start, end), np.maximum(start, end)
    key = (owner * point_count + low) * point_count + high
    sign = np.where(start < end, 1, -1)
    _, inverse = np.unique(key, return_inverse=True)
    inverse = inverse.reshape(-1)
    unmatched = np.bincount(inverse, weights=sign) != 0
    bad = np.flatnonzero(unmatched[inverse])
    return np.repeat(row, 3)[bad], np.stack([start[bad], end[bad]], axis=1)


def solid_volumes(points, triangles, sides, solid_count):
    """(S,) signed volume that the triangles enclose, per solid."""
    corners, solid, _ = side_triangles(triangles, sides)
    origin = points.mean(axis=0) if len(points) else np.zeros(3)
    a, b, c = (points[corners[:, k]] - origin for k in range(3))
    six = np.einsum("ij,ij->i", a, np.cross(b, c))
    return np.bincount(solid - 1, weights=six / 6.0, minlength=solid_count)[:solid_count]
