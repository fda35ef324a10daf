"""Solids that touch without sharing a face (a plain compound): equal faces become one interface.

Two faces are equal when their triangles are, or when their outlines are and one lies on the other (OCC cuts
the two into triangles differently then).  One of them keeps its triangles, with a solid on each side, and the
other becomes its alias.  Faces that overlap otherwise are conflicts: their solids cannot be in one PLC.
Solids that share nothing are meshed apart, so it does no harm when they touch or overlap; it is reported.
"""

from dataclasses import dataclass

import numpy as np
import Part
from FreeCAD import Vector

from .. import extension
from ..errors import MeshError, entity_name
from .cad_elements import ShapeIndex

SAMPLES = 3  # points of a face that must lie on its twin


@dataclass
class Contacts:
    """How faces of different solids touch: `equal` (first, second, mirrored) faces that can become one,
    `conflicts` (first, second, place) that have some triangles in common, `crossing` (first, second) whose
    triangles overlap or cross, `folded` rows of triangles to leave out."""

    equal: list
    conflicts: list
    crossing: list
    folded: np.ndarray

    def pairs(self):
        """[(face, other face), ...] that cannot be in one PLC, unless their solids share another face."""
        return [*((first, second) for first, second, _ in self.conflicts), *self.crossing]


def find_contacts(mesh, sides):
    """Contacts of a Tessellation with sides (F, 2).  Cost: O(m log m), and a few distances per twin."""
    triangles, owner = mesh.triangles, mesh.triangle_face
    partner = coincident_triangles(triangles)
    doubled = np.flatnonzero(partner > np.arange(len(triangles)))
    size = np.bincount(owner, minlength=len(sides))
    pairs = np.stack([owner[doubled], owner[partner[doubled]]], axis=1)
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    starts = np.flatnonzero(np.diff(pairs[order], axis=0, prepend=-1).any(axis=1))
    twins = find_twins(mesh, sides) if len(mesh.cad.solids) > 1 else {}
    contacts = Contacts([], [], [], np.zeros(len(triangles), dtype=bool))
    for rows in np.split(doubled[order], starts[1:]) if len(starts) else ():
        first, second = int(owner[rows[0]]), int(owner[partner[rows[0]]])
        if not sides[first].any() or not sides[second].any():
            continue  # a face of no solid: it is left out
        if first == second:  # the face folds back onto itself: nothing is inside
            contacts.folded[rows] = contacts.folded[partner[rows]] = True
        elif len(rows) == size[first] == size[second]:
            twins[first, second] = opposite(triangles[rows], triangles[partner[rows]])
        elif (first, second) in twins or (second, first) in twins:
            continue
        elif solid_of(sides[first]) and solid_of(sides[first]) == solid_of(sides[second]):
            contacts.folded[rows] = contacts.folded[partner[rows]] = True  # a sliver without thickness
        else:
            contacts.conflicts.append((first, second, mesh.points[triangles[rows[0]]].mean(axis=0)))
    for (first, second), mirrored in sorted(twins.items()):
        other = sides[second][::-1] if mirrored else sides[second]
        if ((sides[first] != 0) & (other != 0)).any():
            place = mesh.points[triangles[owner == first][0]].mean(axis=0)
            contacts.conflicts.append((first, second, place))
        else:
            contacts.equal.append((first, second, mirrored))
    if len(mesh.cad.solids) > 1:
        contacts.crossing = crossing_faces(mesh, sides, contacts.equal)
    return contacts


def find_twins(mesh, sides):
    """{(first, second): whether their normals are opposite} of faces with equal outlines and surfaces."""
    count = len(mesh.points)
    start = mesh.triangles.reshape(-1)
    end = np.roll(mesh.triangles, -1, axis=1).reshape(-1)
    owner = np.repeat(mesh.triangle_face, 3)
    low, high = np.minimum(start, end), np.maximum(start, end)
    _, inverse, uses = np.unique(
        (owner * count + low) * count + high, return_inverse=True, return_counts=True
    )
    outline = (uses[inverse.reshape(-1)] == 1) & ((sides[owner] == 0).sum(axis=1) == 1)
    owner, key, ahead = owner[outline], (low * count + high)[outline], (start < end)[outline]
    order = np.lexsort((key, owner))
    owner, key, ahead = owner[order], key[order], ahead[order]
    known, twins = {}, {}
    faces, starts = np.unique(owner, return_index=True)
    for face, keys, directions in zip(faces.tolist(), np.split(key, starts[1:]), np.split(ahead, starts[1:])):
        same = known.setdefault(keys.tobytes(), [])
        for other, its_directions in same:
            if lies_on(mesh.cad, face, other, facet_centres(mesh, face)):
                twins[other, face] = bool(directions[0] != its_directions[0])
                break
        same.append((face, directions))
    return twins


def facet_centres(mesh, face):
    """A few centres of the face's triangles."""
    rows = np.flatnonzero(mesh.triangle_face == face)
    rows = rows[:: max(1, len(rows) // SAMPLES)][:SAMPLES]
    return mesh.points[mesh.triangles[rows]].mean(axis=1)


def lies_on(cad, face, other, places):
    """Whether the points of a face nearest to some places lie on the other face, within their tolerances."""
    face, other, surface = cad.faces[face], cad.faces[other], cad.surfaces[face]
    if surface is None:
        return False
    tolerance = 2.0 * max(face.Tolerance, other.Tolerance, *(edge.Tolerance for edge in other.Edges))
    try:
        for place in places.tolist():
            point = surface.value(*surface.parameter(Vector(*place)))
            if other.distToShape(Part.Vertex(point))[0] > tolerance:
                return False
    except (RuntimeError, TypeError, ValueError):  # OCC finds no nearest point
        return False
    return True


def merge_equal_faces(equal, sides):
    """(faces to keep (F,) bool, sides, {dropped face: kept face}): the second of an equal pair goes."""
    sides, aliases = sides.copy(), {}
    dropped = np.zeros(len(sides), dtype=bool)
    for first, second, mirrored in equal:
        other = sides[second][::-1] if mirrored else sides[second]
        if not sides[first].any() or not other.any() or ((sides[first] != 0) & (other != 0)).any():
            continue
        sides[first], sides[second] = np.where(sides[first] == 0, other, sides[first]), 0
        aliases[int(second)] = int(first)
        dropped[second] = True
    return ~dropped, sides, aliases


def groups_of_solids(cad, sides, contacts):
    """Lists of solids (1-based) that are meshed together: those that share a face, a vertex or equal faces.

    Solids with a face in common are always together, the others as long as no two of a group are in conflict.
    Raises MeshError when solids that share a face overlap elsewhere.
    """
    count = len(cad.solids)
    group = np.arange(count + 1)
    for a, b in sides[(sides > 0).all(axis=1)].tolist():
        group[group == group[b]] = group[a]
    for first, second, place in contacts.conflicts:
        if any(group[a] == group[b] for a, b in solid_pairs(sides, first, second)):
            raise overlap(first, second, place)
    if count == 1:
        return [[1]]
    enemies = np.zeros((count + 1, count + 1), dtype=bool)
    for first, second in contacts.pairs():
        for a, b in solid_pairs(sides, first, second):
            enemies[a, b] = enemies[b, a] = group[a] != group[b]
    equal = [(sides[first].max(), sides[second].max()) for first, second, _ in contacts.equal]
    for a, b in [*equal, *solids_with_common_vertices(cad)]:
        if group[a] != group[b] and not enemies[np.ix_(group == group[a], group == group[b])].any():
            group[group == group[b]] = group[a]
    return [(np.flatnonzero(group[1:] == number) + 1).tolist() for number in np.unique(group[1:])]


def solid_pairs(sides, first, second):
    """[(solid, solid), ...] of the solids on both sides of two faces."""
    return [(a, b) for a in sides[first].tolist() for b in sides[second].tolist() if a > 0 and b > 0]


def solids_with_common_vertices(cad):
    """[(solid, other solid), ...] (1-based) that a vertex of the shape connects."""
    vertices = ShapeIndex(cad.vertices)
    pairs, first = [], {}
    for number, solid in enumerate(cad.solids, 1):
        for vertex in solid.Vertexes:
            other = first.setdefault(vertices.find(vertex), number)
            if other != number:
                pairs.append((other, number))
    return pairs


def crossing_faces(mesh, sides, equal):
    """[(face, other face), ...] of different solids whose triangles cross or overlap, but equal ones."""
    live = np.flatnonzero(sides[mesh.triangle_face].any(axis=1))
    found = extension.load().crossings(mesh.points, mesh.triangles[live].astype(np.int32))
    pairs = np.unique(np.sort(mesh.triangle_face[live[found]], axis=1), axis=0)
    a, b = sides[pairs[:, 0]], sides[pairs[:, 1]]
    common = ((a[:, :, None] == b[:, None, :]) & (a[:, :, None] != 0)).any(axis=(1, 2))
    known = {tuple(sorted(pair[:2])) for pair in equal}
    return [pair for pair in map(tuple, pairs[~common].tolist()) if pair not in known]


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
        "%s and %s overlap without being one face, and their solids share another. Cut the solids with "
        "Boolean Fragments (mode CompSolid) and mesh the result" % names,
        place=place,
        entity=names[0],
        other=names[1],
    )


def merge_coincident_segments(segments, segment_edge):
    """(segments, their edges, {dropped edge: kept edge}): of several in one place the first edge's stay."""
    aliases = {}
    ordered = np.sort(segments, axis=1)
    order = np.lexsort((segment_edge, ordered[:, 1], ordered[:, 0]))
    repeated = np.zeros(len(segments), dtype=bool)
    same = np.flatnonzero((ordered[order][1:] == ordered[order][:-1]).all(axis=1))
    repeated[order[same + 1]] = True
    for first, second in zip(segment_edge[order[same]].tolist(), segment_edge[order[same + 1]].tolist()):
        if first != second:
            aliases[second] = aliases.get(first, first)
    return segments[~repeated], segment_edge[~repeated], aliases


def segments_on_triangles(segments, triangles, point_count):
    """(k,) bool: whether each segment is an edge of some triangle."""
    ends = np.sort(np.concatenate([triangles[:, (0, 1)], triangles[:, (1, 2)], triangles[:, (2, 0)]]), axis=1)
    ordered = np.sort(segments, axis=1)
    return np.isin(ordered[:, 0] * point_count + ordered[:, 1], ends[:, 0] * point_count + ends[:, 1])
