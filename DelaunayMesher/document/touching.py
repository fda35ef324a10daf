"""Solids that touch without sharing a face (a plain compound): coincident faces become one interface.

Where the triangulations of two coincident faces agree, one face keeps the triangles, with a solid on each
side, and the other becomes its alias.  Where they agree only in part the faces overlap, and the shape has to
be cut first.
"""

from dataclasses import dataclass, field

import numpy as np

from ..errors import MeshError, entity_name


@dataclass
class Aliases:
    """CAD elements that were merged into another: {dropped index: kept index}, 0-based."""

    faces: dict = field(default_factory=dict)
    edges: dict = field(default_factory=dict)
    vertices: dict = field(default_factory=dict)


def merge_coincident_faces(triangles, triangle_face, sides, points, aliases):
    """Triangle arrays and sides (F, 2) without duplicates; fills `aliases.faces`.

    Raises MeshError 'overlapping_faces' when two faces share some triangles only, or lie on the same side.
    """
    partner = coincident_triangles(triangles)
    doubled = np.flatnonzero(partner > np.arange(len(triangles)))
    keep = np.ones(len(triangles), dtype=bool)
    sides = sides.copy()
    size = np.bincount(triangle_face, minlength=len(sides))
    pairs = np.stack([triangle_face[doubled], triangle_face[partner[doubled]]], axis=1)
    for first, second in np.unique(pairs, axis=0):
        rows = doubled[(pairs == (first, second)).all(axis=1)]
        place = points[triangles[rows[0]]].mean(axis=0)
        if first == second:
            keep[rows] = keep[partner[rows]] = False  # the face folds back onto itself: nothing is inside
            continue
        if len(rows) != size[first] or len(rows) != size[second]:
            if solid_of(sides[first]) == solid_of(sides[second]):
                keep[rows] = keep[partner[rows]] = False  # a sliver of the solid without thickness
                continue
            raise overlap(first, second, place)
        mirrored = opposite(triangles[rows], triangles[partner[rows]])
        other = sides[second][::-1] if mirrored else sides[second]
        merged = np.where(sides[first] == 0, other, sides[first])
        if ((sides[first] != 0) & (other != 0)).any():
            raise overlap(first, second, place)
        sides[first], sides[second] = merged, 0
        aliases.faces[int(second)] = int(first)
        keep[partner[rows]] = False
    return triangles[keep], triangle_face[keep], sides


def coincident_triangles(triangles):
    """(m,) row of another triangle with the same three points, or -1 (pairs only)."""
    partner = np.full(len(triangles), -1)
    if not len(triangles):
        return partner
    ordered = np.sort(triangles, axis=1)
    order = np.lexsort(ordered.T)
    same = np.flatnonzero((ordered[order][1:] == ordered[order][:-1]).all(axis=1))
    partner[order[same]] = order[same + 1]
    partner[order[same + 1]] = order[same]
    return partner


def opposite(triangles, others):
    """Whether the first two triangles, with equal corners, have opposite orientation."""
    a, b = triangles[0].tolist(), others[0].tolist()
    turn = b.index(a[0])
    return b[turn:] + b[:turn] != a


def solid_of(side):
    """The solid of a face with one side in the open; 0 when it has none or two."""
    return int(side.max()) if side.min() == 0 else 0


def overlap(first, second, place):
    """The error for faces that touch without being equal."""
    names = entity_name(2, int(first)), entity_name(2, int(second))
    return MeshError(
        "plc",
        "overlapping_faces",
        "%s and %s overlap without being one face. Cut the touching solids with Boolean Fragments "
        "(mode CompSolid) and mesh the result" % names,
        place=place,
        entity=names[0],
        other=names[1],
    )


def merge_coincident_segments(segments, segment_edge, aliases):
    """Segments without duplicates; fills `aliases.edges` (a later edge on an earlier one)."""
    ordered = np.sort(segments, axis=1)
    order = np.lexsort((segment_edge, ordered[:, 1], ordered[:, 0]))
    repeated = np.zeros(len(segments), dtype=bool)
    same = np.flatnonzero((ordered[order][1:] == ordered[order][:-1]).all(axis=1))
    repeated[order[same + 1]] = True
    for first, second in zip(segment_edge[order[same]].tolist(), segment_edge[order[same + 1]].tolist()):
        if first != second:
            aliases.edges[second] = aliases.edges.get(first, first)
    return segments[~repeated], segment_edge[~repeated]


def segments_on_triangles(segments, triangles, point_count):
    """(k,) bool: whether each segment is an edge of some triangle."""
    ends = np.sort(np.concatenate([triangles[:, (0, 1)], triangles[:, (1, 2)], triangles[:, (2, 0)]]), axis=1)
    ordered = np.sort(segments, axis=1)
    return np.isin(ordered[:, 0] * point_count + ordered[:, 1], ends[:, 0] * point_count + ends[:, 1])
