"""Faces with a thin solid between them that OCC cuts into the same triangles: each gets points of its own.

Idea: where a solid, like the lens that two balls have in common, is thinner than the deflection, OCC puts no
points inside its faces, and both consist of triangles between the points of their rim. The middles of their
inner edges, put on the exact surface of each face, give the solid its thickness again. Precondition: a closed
Tessellation. Postcondition: it is still closed, and two faces with a solid between them have no triangle in
common, unless their surfaces lie on each other there or the triangle is all there is of a face. Cost: a
projection for each inner edge of such faces.
"""

from dataclasses import replace

import numpy as np

from .patch import FaceShape, inner_edges
from .touching import coincident_triangles

APART = 1e-8  # distance of two surfaces over the diagonal from which on there is a solid between them


def part_sheets(mesh, sides):
    """The Tessellation with the triangles divided that two faces with a solid between them share."""
    for face in sorted(sheets(mesh, sides)):
        mesh = divided(mesh, face)
    return mesh


def sheets(mesh, sides):
    """Numbers of the faces with a triangle that another face on the same solid has as well."""
    owner, partner = mesh.triangle_face, coincident_triangles(mesh.triangles)
    found, surfaces = set(), {}
    for row in np.flatnonzero(partner > np.arange(len(partner))).tolist():
        first, second = int(owner[row]), int(owner[partner[row]])
        common = set(sides[first].tolist()) & set(sides[second].tolist())
        open_both = 0 in sides[first] and 0 in sides[second]  # nothing on the other side: a sliver
        if first != second and common - {0} and not open_both and not {first, second} <= found:
            centre = mesh.points[mesh.triangles[row]].mean(axis=0)
            for face in {first, second} - surfaces.keys():
                surfaces[face] = surface_at(mesh, face)
            if lie_apart(surfaces[first], surfaces[second], centre, APART * mesh.cad.diagonal):
                found |= {first, second}
    return found


def lie_apart(first, second, place, distance):
    """Whether the points of two FaceShapes nearest to a place are farther apart than a distance."""
    ends = first.nearest(place), second.nearest(place)
    if ends[0] is None or ends[1] is None:
        return False
    return np.linalg.norm(ends[1] - ends[0]) > distance


def surface_at(mesh, face):
    """The FaceShape of a face."""
    return FaceShape(mesh.cad.faces[face], mesh.cad.surfaces[face], 1.0)


def divided(mesh, face):
    """The Tessellation with all inner edges of a face halved, their middles on its surface."""
    mine = mesh.triangle_face == face
    triangles = [tuple(corners) for corners in mesh.triangles[mine].tolist()]
    shape = surface_at(mesh, face)
    points, middles = list(mesh.points), {}
    for a, b in sorted(inner_edges(triangles, ())):
        middle = 0.5 * (points[a] + points[b])
        nearest = shape.nearest(middle)
        middles[a, b] = len(points)
        points.append(middle if nearest is None else nearest)
    pieces = [piece for corners in triangles for piece in cut(corners, middles)]
    return replace(
        mesh,
        points=np.array(points),
        triangles=np.concatenate([mesh.triangles[~mine], np.array(pieces)]),
        triangle_face=np.concatenate([mesh.triangle_face[~mine], np.full(len(pieces), face)]),
    )


def cut(corners, middles):
    """Triangles of a triangle some of whose edges {(lower, higher): middle} are halved."""
    loop = []
    for a, b in zip(corners, corners[1:] + corners[:1]):
        loop += [a, middles.get((min(a, b), max(a, b)))]
    cut_off = [k for k in (0, 2, 4) if loop[k - 1] is not None and loop[k + 1] is not None]
    pieces = [(loop[k - 1], loop[k], loop[k + 1]) for k in cut_off]
    rest = [point for k, point in enumerate(loop) if point is not None and k not in cut_off]
    start = next((k for k, point in enumerate(rest) if point not in corners), 0)
    rest = rest[start:] + rest[:start]
    return pieces + [(rest[0], rest[k], rest[k + 1]) for k in range(1, len(rest) - 1)]
