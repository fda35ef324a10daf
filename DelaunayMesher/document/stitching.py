"""Closes a tessellation where CAD edges of one solid coincide without being one edge (unsewn faces).

Idea: free edges that lie on each other get the same nodes, each the other's, by exact distances from the CAD
curves; triangles beside them are divided, nodes within the tolerance become one. Precondition: a tessellation
with gaps. Postcondition: the same faces and no new point; faces of a solid that face opposite ways across an
edge are turned to agree. Cost: the square of the number of free edges. Limit: edges farther apart than the
tolerance.
"""

from dataclasses import replace

import numpy as np
import Part
from FreeCAD import Vector

from .closed import open_triangles, side_triangles

STITCH = 1e-4  # of the diagonal: how far apart edges may be that are taken as one
SHORTEST = 0.2  # no more than this share of a segment beside them
BULGE = 0.5  # of a segment: how far from it its curve may be


def stitch(mesh, sides):
    """(Tessellation, sides (F, 2)) with coincident free edges joined and the faces of each solid agreeing."""
    free = free_segments(mesh, sides)
    if free:
        mesh = join_edges(mesh, free, STITCH * mesh.cad.diagonal)
    return mesh, agreeing(mesh, sides)


def free_segments(mesh, sides):
    """{edge: its segments (k, 2)} of CAD edges at which triangles have no neighbour."""
    _, open_edges = open_triangles(mesh.triangles, sides[mesh.triangle_face], len(mesh.points))
    keys = np.unique(undirected(open_edges, len(mesh.points)))
    live = np.isin(undirected(mesh.segments, len(mesh.points)), keys)
    return {
        int(edge): mesh.segments[live & (mesh.segment_edge == edge)]
        for edge in np.unique(mesh.segment_edge[live])
    }


def undirected(edges, count):
    """(k,) one number for each pair of points, whatever its direction."""
    return edges.min(axis=1) * count + edges.max(axis=1) if len(edges) else np.zeros(0, dtype=np.int64)


def join_edges(mesh, free, tolerance):
    """The Tessellation with the nodes of each free edge put into those it lies on."""
    root = np.arange(len(mesh.points))
    inserted = {}  # (lower point, higher point) -> {point: share of the way from the lower one}
    nodes = np.unique(np.concatenate([*free.values()]))
    for edge, segments in free.items():
        for point, (a, b), share in nodes_on(mesh, edge, segments, nodes, tolerance):
            length = np.linalg.norm(mesh.points[b] - mesh.points[a])
            near = min(tolerance, SHORTEST * length)
            ends = np.linalg.norm(mesh.points[[a, b]] - mesh.points[point], axis=1)
            if ends.min() <= near:
                unite(root, point, (a, b)[int(ends.argmin())])
            else:
                place = inserted.setdefault((min(a, b), max(a, b)), {})
                place[point] = share if a < b else 1.0 - share
    triangles, owner = divided_triangles(mesh, inserted)
    segments, segment_edge = divided_segments(mesh, inserted)
    root = roots(root)
    triangles, segments = root[triangles], root[segments]
    real = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    long = segments[:, 0] != segments[:, 1]
    return replace(
        mesh,
        triangles=triangles[real],
        triangle_face=owner[real],
        segments=segments[long],
        segment_edge=segment_edge[long],
        vertex_point=root[mesh.vertex_point],
    )


def nodes_on(mesh, edge, segments, nodes, tolerance):
    """(point, (a, b) the segment beside it, share of the way) of other edges' nodes on an edge."""
    shape = mesh.cad.edges[edge]
    own = set(segments.reshape(-1).tolist())
    a, b = mesh.points[segments[:, 0]], mesh.points[segments[:, 1]]
    along = b - a
    squared = np.maximum((along**2).sum(axis=1), 1e-300)
    reach = tolerance + BULGE * np.sqrt(squared)
    low, high = np.minimum(a, b).min(axis=0) - reach.max(), np.maximum(a, b).max(axis=0) + reach.max()
    inside = ((mesh.points[nodes] >= low) & (mesh.points[nodes] <= high)).all(axis=1)
    for point in nodes[inside].tolist():
        if point in own:
            continue
        offset = mesh.points[point] - a
        share = np.clip((offset * along).sum(axis=1) / squared, 0.0, 1.0)
        apart = np.linalg.norm(offset - share[:, None] * along, axis=1)
        row = int(apart.argmin())
        if apart[row] > reach[row]:
            continue
        if apart[row] <= tolerance or distance(shape, mesh.points[point]) <= tolerance:
            yield point, tuple(segments[row].tolist()), float(share[row])


def distance(shape, point):
    return shape.distToShape(Part.Vertex(Vector(*point)))[0]


def unite(root, point, other):
    """Make two points one (the lower number leads)."""
    a, b = leader(root, point), leader(root, other)
    root[max(a, b)] = min(a, b)


def leader(root, point):
    while root[point] != point:
        point = root[point]
    return int(point)


def roots(root):
    """(n,) the leader of each point."""
    while (root[root] != root).any():
        root = root[root]
    return root


def points_between(inserted, a, b):
    """Points put into the edge from a to b, in order."""
    between = inserted.get((min(a, b), max(a, b)), {})
    return sorted(between, key=between.get, reverse=a > b)


def divided_triangles(mesh, inserted):
    """(triangles, their faces) with those beside divided segments divided."""
    touched = np.zeros(len(mesh.triangles), dtype=bool)
    keys = undirected(np.array([*inserted]).reshape(-1, 2), len(mesh.points))
    for k in range(3):
        sides = np.stack([mesh.triangles[:, k], mesh.triangles[:, (k + 1) % 3]], axis=1)
        touched |= np.isin(undirected(sides, len(mesh.points)), keys)
    result, owner = [], []
    for corners, face in zip(mesh.triangles[touched].tolist(), mesh.triangle_face[touched].tolist()):
        pieces = divide(corners, inserted)
        result += pieces
        owner += [face] * len(pieces)
    return (
        np.concatenate([mesh.triangles[~touched], np.array(result, dtype=np.int64).reshape(-1, 3)]),
        np.concatenate([mesh.triangle_face[~touched], np.array(owner, dtype=np.int64)]),
    )


def divide(corners, inserted):
    """Triangles of one triangle with points put into its sides."""
    for k in range(3):
        a, b, c = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
        chain = [a, *points_between(inserted, a, b), b]
        if len(chain) > 2:
            pieces = [(p, q, c) for p, q in zip(chain, chain[1:])]
            return [
                smaller
                for piece in pieces
                for smaller in divide(
                    piece, {key: inserted[key] for key in ends(c, piece) if key in inserted}
                )
            ]
    return [tuple(corners)]


def ends(corner, piece):
    """The two sides of a triangle at a corner, as (lower point, higher point)."""
    return [(min(corner, other), max(corner, other)) for other in piece if other != corner]


def divided_segments(mesh, inserted):
    """(segments, their edges) with points put in."""
    result, owner = [], []
    for (a, b), edge in zip(mesh.segments.tolist(), mesh.segment_edge.tolist()):
        chain = [a, *points_between(inserted, a, b), b]
        result += zip(chain, chain[1:])
        owner += [edge] * (len(chain) - 1)
    return np.array(result, dtype=np.int64).reshape(-1, 2), np.array(owner, dtype=np.int64)


def agreeing(mesh, sides):
    """Sides with faces turned, as few as possible, so that neighbours agree what is inside."""
    sides = sides.copy()
    corners, solid, row = side_triangles(mesh.triangles, sides[mesh.triangle_face])
    rows, _ = open_triangles(mesh.triangles, sides[mesh.triangle_face], len(mesh.points))
    for number in np.unique(sides[mesh.triangle_face[rows]]):
        if number > 0:
            mine = solid == number
            for face in faces_to_turn(corners[mine], mesh.triangle_face[row[mine]], len(mesh.points)):
                if sides[face].min() == 0:
                    sides[face] = sides[face, ::-1].copy()
    return sides


def faces_to_turn(corners, faces, count):
    """Faces to turn among the triangles of one solid."""
    edges = np.stack([corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)], axis=1)
    owner, ahead = np.repeat(faces, 3), edges[:, 0] < edges[:, 1]
    order = np.argsort(undirected(edges, count), kind="stable")
    key = undirected(edges, count)[order]
    starts = np.flatnonzero(np.diff(key, prepend=-1))
    pairs = starts[np.diff(np.append(starts, len(key))) == 2]
    first, second = order[pairs], order[pairs + 1]
    links = {}
    for a, b, agree in zip(owner[first], owner[second], ahead[first] != ahead[second]):
        if a != b:
            for key in ((int(a), int(b)), (int(b), int(a))):
                links[key] = links.get(key, 0) + (1 if agree else -1)
    neighbours = {}
    for (a, b), weight in links.items():
        neighbours.setdefault(a, []).append((b, weight > 0))
    turned, result = {}, []
    for start in np.unique(faces).tolist():
        if start in turned:
            continue
        turned[start], group = False, [start]
        for face in group:
            for other, agree in neighbours.get(face, ()):
                if other not in turned:
                    turned[other] = turned[face] if agree else not turned[face]
                    group.append(other)
        wrong = [face for face in group if turned[face]]
        result += wrong if 2 * len(wrong) <= len(group) else [face for face in group if not turned[face]]
    return result
