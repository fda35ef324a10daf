"""A triangulated surface -> PLCs: its pieces, those that cross each other in different ones.

A piece is what hangs together across edges.  Which of two pieces that cross lies inside the other has no
answer, so they are solids of their own, meshed one after the other like solids of a plain compound.  So are
the bodies of an assembly that lie on each other without having the same triangles there.
Cost: that of cleaning, and a search for crossing triangles, about a microsecond each.
"""

import numpy as np

from . import cells, cleaning, extension
from .errors import MeshError
from .overlaps import find_overlaps
from .plc import Plc


def to_plcs(points, triangles, labels=None, holes=None, nested="cavity"):
    """[Plc, ...] of a closed surface; arguments and errors as Plc.from_triangles().  Faces, edges, vertices
    and solids are counted on from one to the next."""
    surface = cleaning.clean(points, triangles, labels)
    piece = cells.pieces(surface[1])
    try:
        return plcs_of_pieces(*surface, piece, crossing_pieces(*surface[:2], piece), holes, nested)
    except MeshError as error:
        if error.code != "overlap":
            raise
        surface = cleaning.clean(points, triangles, labels, repeated=True)
        piece = bodies_in_order(surface[1])
        if piece is None:
            raise
    apart = touching_pieces(surface[1], piece) | crossing_pieces(*surface[:2], piece)
    return plcs_of_pieces(*surface, piece, apart, holes, nested)


def plcs_of_pieces(points, triangles, labels, warnings, piece, apart, holes, nested):
    """[Plc, ...] of a cleaned surface, each of pieces of which no two are `apart`, (n, n)."""
    group = groups_without(apart)[piece]
    plcs = [
        Plc.from_clean_triangles(
            points, triangles[group == number], labels[group == number], holes=holes, nested=nested
        )
        for number in range(group.max() + 1)
    ]
    if len(plcs) > 1:
        count_on(plcs)
        first = triangles[piece == np.argwhere(apart)[0, 0]]
        warnings = [*warnings, apart_warning(points[first].mean(axis=(0, 1)))]
    plcs[0].warnings[:0] = warnings
    return plcs


def bodies_in_order(triangles):
    """(m,) body of each triangle, when the surface is one closed body after the other, as files of assemblies
    are; None when it is not."""
    body, open_edges, count = [], set(), 0
    for a, b, c in triangles.tolist():
        body.append(count)
        open_edges ^= {(min(a, b), max(a, b)), (min(b, c), max(b, c)), (min(c, a), max(c, a))}
        count += not open_edges
    return np.array(body) if count > 1 and not open_edges else None


def touching_pieces(triangles, piece):
    """(n, n) bool: pieces with a point in common."""
    touch = np.zeros((piece.max() + 1,) * 2, dtype=bool)
    pairs = np.unique(np.stack([triangles.reshape(-1), np.repeat(piece, 3)], axis=1), axis=0)
    for here in np.split(pairs[:, 1], np.flatnonzero(np.diff(pairs[:, 0])) + 1):
        touch[np.ix_(here, here)] = True
    np.fill_diagonal(touch, False)
    return touch


def crossing_pieces(points, triangles, piece):
    """(n, n) bool: pieces that cross."""
    count = piece.max() + 1
    cross = np.zeros((count, count), dtype=bool)
    if count == 1:
        return cross
    first, second = piece[extension.load().crossings(points, triangles.astype(np.int32))].T
    cross[first, second] = cross[second, first] = True
    np.fill_diagonal(cross, False)
    bodies = [points[cells.outward_triangles(points, triangles[piece == k])] for k in range(count)]
    for inner, outer, _, whole in find_overlaps(bodies, cross):
        cross[inner, outer] = cross[outer, inner] = not whole
    return cross


def groups_without(apart):
    """(n,) group of each piece: the first one without a piece that it must be apart from, (n, n)."""
    group = np.zeros(len(apart), dtype=np.int64)
    for number, others in enumerate(apart):
        taken = set(group[:number][others[:number]].tolist())
        group[number] = next(k for k in range(len(apart)) if k not in taken)
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


def apart_warning(place):
    """What to know about pieces of a surface that cross or overlap."""
    return (
        "closed pieces of the surface cross or overlap each other, one round (%.6g, %.6g, %.6g): they are "
        "solids of their own, whose meshes do not fit together there. For one body, unite them where the "
        "surface was made" % tuple(place)
    )
