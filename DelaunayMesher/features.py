"""Faces, edges and corners of a triangulated surface without CAD: where it turns by more than the crease
angle.

A face is a connected set of triangles between features; a feature segment lies where the surface turns
sharply, where labels or solids change, or where other than two triangles meet. Feature segments form edges,
which end at corners: points where other than two segments meet or an edge turns sharply. A closed edge
without a corner gets one.
"""

from typing import Any, NamedTuple

import numpy as np

from .cells import connected, half_edges


class Features(NamedTuple):
    """triangle_face (m,), segments (k, 2), segment_edge (k,), corners (c,), face_solids, edge_count."""

    triangle_face: Any
    segments: Any
    segment_edge: Any
    corners: Any
    face_solids: Any
    edge_count: int


def find_features(points, triangles, labels, sides, crease_angle):
    """Features of a surface whose triangles have the solids `sides` (m, 2) behind and in front of them."""
    edges, owner, direction, _, starts, sizes = half_edges(triangles)
    smooth = sizes == 2
    first, second = owner[starts], owner[starts + smooth]
    smooth &= direction[starts] != direction[starts + smooth]
    smooth &= labels[first] == labels[second]
    smooth &= (sides[first] == sides[second]).all(axis=1)
    smooth[smooth] = ~_sharp(points, triangles, first[smooth], second[smooth], crease_angle)
    face_count, triangle_face = connected(first[smooth], second[smooth], len(triangles))
    face_solids = np.zeros((face_count, 2), np.int64)
    face_solids[triangle_face] = sides
    segments = edges[starts[~smooth]]
    corners = _corners(points, segments, crease_angle)
    edge_count, segment_edge, corners = _edges(points, segments, corners)
    return Features(triangle_face, segments, segment_edge, corners, face_solids, edge_count)


def _sharp(points, triangles, first, second, crease_angle):
    """Does the surface turn by more than the crease angle between each pair of triangles?"""
    normal = _normals(points, triangles, first, second)
    cosine = np.einsum("ij,ij->i", normal[first], normal[second])
    return cosine < np.cos(np.radians(crease_angle))


def _normals(points, triangles, first, second):
    """Unit normals (m, 3); a flat triangle takes that of its neighbour across its longest edge."""
    corners = points[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    sides = np.stack([np.linalg.norm(corners[:, i] - corners[:, i - 1], axis=1) for i in range(3)])
    flat = length <= 1e-9 * sides.max(axis=0) ** 2
    normal[~flat] /= length[~flat, None]
    while flat.any():
        a, b = np.concatenate([first, second]), np.concatenate([second, first])
        ready = flat[a] & ~flat[b]
        if not ready.any():
            break
        a, b = a[ready], b[ready]
        shared = _shared_length(points, triangles[a], triangles[b])
        order = np.argsort(shared, kind="stable")  # the longest comes last and stays
        normal[a[order]] = normal[b[order]]
        flat[a] = False
    return normal


def _shared_length(points, one, two):
    """Length of the edge that each pair of triangles shares."""
    common = (one[:, :, None] == two[:, None, :]).any(axis=2)
    third = np.argmin(common, axis=1)
    rows = np.arange(len(one))
    return np.linalg.norm(points[one[rows, (third + 1) % 3]] - points[one[rows, (third + 2) % 3]], axis=1)


def _corners(points, segments, crease_angle):
    """(c,) points where other than two segments meet, or where two meet at a sharp turn."""
    ends = segments.reshape(-1)
    other = segments[:, ::-1].reshape(-1)
    order = np.argsort(ends, kind="stable")
    numbers, starts, counts = np.unique(ends[order], return_index=True, return_counts=True)
    through = counts == 2
    middle = numbers[through]
    a = points[other[order[starts[through]]]] - points[middle]
    b = points[other[order[starts[through] + 1]]] - points[middle]
    length = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    turns = np.einsum("ij,ij->i", a, -b) < np.cos(np.radians(crease_angle)) * length
    return np.sort(np.concatenate([numbers[~through], middle[turns]]))


def _edges(points, segments, corners):
    """Number of edges, the edge of each segment, and the corners with one more for each closed edge."""
    if len(segments) == 0:
        return 0, np.zeros(0, np.int64), corners
    ends = segments.reshape(-1)
    owner = np.repeat(np.arange(len(segments)), 2)
    inner = ~np.isin(ends, corners)
    order = np.argsort(ends[inner], kind="stable")
    pairs = owner[inner][order].reshape(-1, 2)  # a point that is no corner has exactly two segments
    count, segment_edge = connected(pairs[:, 0], pairs[:, 1], len(segments))
    has_corner = np.zeros(count, bool)
    has_corner[segment_edge[owner[~inner]]] = True
    extra = [segments[segment_edge == edge].min() for edge in np.flatnonzero(~has_corner)]
    return count, segment_edge, np.sort(np.concatenate([corners, np.array(extra, np.int64)]))
