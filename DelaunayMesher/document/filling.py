"""Fills what OCC left out of a tessellation: faces without triangles, tips of faces, crossing outlines.

Idea: a face without triangles gets them from its outline (patch.py). Then the triangle edges of a solid
without a neighbour make closed loops; beside a loop's segments lies the CAD face that misses there, whose
triangles are made from the loop in the same way. Precondition: a
tessellation with gaps, sides of the faces. Postcondition: every filled loop is closed. Cost: O(n^3) for a
loop of n points, vectorised. Limit: a loop along one face's free edge stays open, because nothing says what
is missing there.
"""

from collections import Counter
from dataclasses import replace

import numpy as np
import Part

from ..polygons import plane_triangles
from .closed import side_triangles
from .patch import FaceShape, bridged, least_cost, onto_surface

LONGEST = 500  # points of all loops of a face that is not a plane with simple outlines


def fill(mesh, sides):
    """(Tessellation with its gaps filled as far as possible, 0-based numbers of the faces filled, clean).

    clean: whether no filled plane face has outlines that cross each other.
    """
    filled, clean, beside = set(), True, faces_of_segments(mesh)
    present = np.bincount(mesh.triangle_face, minlength=len(mesh.cad.faces)) > 0
    for face in np.flatnonzero(~present & sides.any(axis=1)).tolist():
        loops = outline(mesh, face)
        if loops:
            count = len(mesh.triangles)
            mesh, flawless = with_face(mesh, face, loops, 1.0)
            clean &= flawless
            filled |= {face} if len(mesh.triangles) > count else set()
    for solid in range(1, len(mesh.cad.solids) + 1):
        loops = labelled_loops(mesh, sides, solid, beside)
        for face in sorted(loops):
            inward = sides[face, 1] == solid and sides[face, 0] != solid
            count = len(mesh.triangles)
            mesh, flawless = with_face(mesh, face, loops[face], -1.0 if inward else 1.0)
            clean &= flawless
            filled |= {face} if len(mesh.triangles) > count else set()
    return mesh, sorted(filled), clean


def with_face(mesh, face, loops, sign):
    """(Tessellation with triangles of a face inside loops, whether no outlines cross); see fill_face()."""
    points, triangles, flawless = fill_face(mesh, face, loops, sign)
    if not len(mesh.face_nodes[face]):
        mesh.face_nodes[face] = mesh.points[np.unique(np.concatenate(loops))]
    mesh = replace(
        mesh,
        points=points,
        triangles=np.concatenate([mesh.triangles, triangles if sign > 0 else triangles[:, ::-1]]),
        triangle_face=np.concatenate([mesh.triangle_face, np.full(len(triangles), face)]),
    )
    return mesh, flawless


def outline(mesh, face):
    """The loops of points round a CAD face as its edges run; [] where these do not close."""
    following, cad = {}, mesh.cad
    for edge, shape in zip(cad.face_edges[face], cad.faces[face].Edges):
        if cad.seam_faces.get(edge) == face:
            continue
        for a, b in mesh.segments[mesh.segment_edge == edge].tolist():
            a, b = (b, a) if shape.Orientation == "Reversed" else (a, b)
            following.setdefault(a, []).append((b, {face}))
    starts = Counter({a: len(ends) for a, ends in following.items()})
    if starts != Counter(b for ends in following.values() for b, _ in ends):
        return []
    loops = []
    while following:
        loops.append(next_loop(following)[0])
    return loops if all(len(loop) >= 3 for loop in loops) else []


def faces_of_segments(mesh):
    """{(lower point, higher point): CAD faces that meet there}"""
    result = {}
    for (a, b), edge in zip(mesh.segments.tolist(), mesh.segment_edge.tolist()):
        result.setdefault((min(a, b), max(a, b)), []).extend(mesh.cad.edge_faces[edge])
    return result


def labelled_loops(mesh, sides, solid, beside):
    """{face: closed loops of points, as the missing triangles run} of one solid."""
    following = {}
    for (a, b), owner in missing_edges(mesh, sides, solid):
        faces = beside.get((min(a, b), max(a, b)))
        known = {face for face in faces or () if face != owner and solid in sides[face]}
        following.setdefault(a, []).append((b, {owner} if faces is None else known))
    result = {}
    while following:
        loop, labels = next_loop(following)
        votes = Counter(face for known in labels for face in sorted(known))
        if len(loop) >= 3 and votes:
            result.setdefault(votes.most_common(1)[0][0], []).append(loop)
    return result


def missing_edges(mesh, sides, solid):
    """[((start, end), face of the triangle on the other side)] of the triangles that a solid lacks."""
    corners, number, row = side_triangles(mesh.triangles, sides[mesh.triangle_face])
    mine = number == solid
    corners, faces = corners[mine], np.repeat(mesh.triangle_face[row[mine]], 3)
    start, end = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    low, high = np.minimum(start, end), np.maximum(start, end)
    _, first, inverse = np.unique(low * len(mesh.points) + high, return_index=True, return_inverse=True)
    flow = np.bincount(inverse.reshape(-1), weights=np.where(start < end, 1, -1)).astype(int)
    result = []
    for place in np.flatnonzero(flow).tolist():
        a, b = int(low[first[place]]), int(high[first[place]])
        edge = (b, a) if flow[place] > 0 else (a, b)
        result += [(edge, int(faces[first[place]]))] * abs(int(flow[place]))
    return result


def next_loop(following):
    """(points, faces beside the edges) of a closed walk, taken out of `following`; it keeps to one face."""
    start = next(iter(following))
    walk, labels, seen = [start], [], {start: 0}
    label = following[start][-1][1]
    while True:
        here = walk[-1]
        choices = following[here]
        pick = max(range(len(choices)), key=lambda k: (len(choices[k][1] & label), k))
        there, label = choices.pop(pick)
        if not choices:
            del following[here]
        labels.append(label)
        if there in seen:
            first = seen[there]
            for a, b, old in zip(walk[:first], walk[1 : first + 1], labels[:first]):
                following.setdefault(a, []).append((b, old))  # the way to the loop belongs to another one
            return walk[first:], labels[first:]
        seen[there] = len(walk)
        walk.append(there)


def fill_face(mesh, face, loops, sign):
    """(points, (t, 3) triangles whose outline are the loops, in their direction, whether no outlines cross).

    sign: whether the triangles go with (1.0) or against (-1.0) the normal of the face.
    """
    surface = mesh.cad.surfaces[face]
    plane = isinstance(surface, Part.Plane)
    if plane:
        triangles = plane_triangles(mesh.points, loops)
        if triangles is not None:
            return mesh.points, triangles, True
    if sum(map(len, loops)) + 2 * (len(loops) - 1) > LONGEST:  # with bridges
        return mesh.points, np.zeros((0, 3), dtype=np.int64), False
    loop = bridged(mesh.points, loops)
    shape = FaceShape(mesh.cad.faces[face], surface, sign)
    triangles = least_cost(mesh.points[loop], np.array([shape.normal(mesh.points[point]) for point in loop]))
    triangles = np.array(loop)[triangles]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    if plane:
        return mesh.points, triangles, False
    outline = {(min(e), max(e)) for loop in loops for e in zip(loop, [*loop[1:], loop[0]])}
    return (*onto_surface(mesh.points, triangles, shape, outline), True)
