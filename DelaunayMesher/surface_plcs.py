"""A triangulated surface -> PLCs: its pieces, those that cross each other in different ones.

A piece is what hangs together across edges.  Which of two pieces that cross lies inside the other has no
answer, so they are solids of their own, meshed one after the other like solids of a plain compound.
Cost: that of cleaning, and a search for crossing triangles, about a microsecond each.
"""

import numpy as np

from . import cells, cleaning, extension
from .overlaps import find_overlaps
from .plc import Plc


def to_plcs(points, triangles, labels=None, holes=None, nested="cavity"):
    """[Plc, ...] of a closed surface; arguments and errors as Plc.from_triangles().  Faces, edges, vertices
    and solids are counted on from one to the next."""
    points, triangles, labels, warnings = cleaning.clean(points, triangles, labels)
    piece = cells.pieces(triangles)
    crossing = crossing_pieces(points, triangles, piece)
    group = groups_without(crossing, piece.max() + 1)[piece]
    plcs = [
        Plc.from_clean_triangles(
            points, triangles[group == number], labels[group == number], holes=holes, nested=nested
        )
        for number in range(group.max() + 1)
    ]
    if len(plcs) > 1:
        count_on(plcs)
        warnings = [*warnings, crossing_warning(points[triangles[piece == crossing[0, 0]]].mean(axis=(0, 1)))]
    plcs[0].warnings[:0] = warnings
    return plcs


def crossing_pieces(points, triangles, piece):
    """(k, 2) pieces that cross."""
    if piece.max() == 0:
        return np.zeros((0, 2), dtype=np.int64)
    count = piece.max() + 1
    first, second = piece[extension.load().crossings(points, triangles.astype(np.int32))].T
    cross = np.zeros((count, count), dtype=bool)
    cross[first, second] = cross[second, first] = first != second
    bodies = [points[triangles[piece == number]] for number in range(count)]
    for inner, outer, _, whole in find_overlaps(bodies, cross):
        cross[inner, outer] = cross[outer, inner] = not whole
    return np.argwhere(cross)


def groups_without(crossing, count):
    """Group of each of `count` pieces: the first one without a piece that it crosses."""
    group = np.zeros(count, dtype=np.int64)
    for number in range(count):
        others = np.concatenate(
            [crossing[crossing[:, 0] == number, 1], crossing[crossing[:, 1] == number, 0]]
        )
        taken = set(group[others[others < number]].tolist())
        group[number] = next(k for k in range(count) if k not in taken)
    return group


def count_on(plcs):
    """Numbers the elements of several PLCs as those of one part."""
    faces = edges = vertices = solids = 0
    for plc in plcs:
        plc.triangle_face += faces
        plc.segment_edge += edges
        plc.corner_vertex += vertices
        plc.face_solids = np.concatenate([np.zeros((faces, 2), np.int32), plc.face_solids])
        plc.edge_count += edges
        plc.vertex_count += vertices
        plc.solid_numbers = solids + 1 + np.arange(plc.solid_count)
        faces, edges, vertices = len(plc.face_solids), plc.edge_count, plc.vertex_count
        solids += plc.solid_count
    for plc in plcs:
        plc.cad_solid_count = solids


def crossing_warning(place):
    """What to know about pieces of a surface that cross."""
    return (
        "closed pieces of the surface cross each other, one round (%.6g, %.6g, %.6g): they are meshed as "
        "solids of their own, which lie over each other there. For one body, unite them where the surface "
        "was made" % tuple(place)
    )
