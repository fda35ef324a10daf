"""Triangles of a CAD face in the parameters (u, v) of its surface, from the polylines of its edges.

For the faces that OCC triangulates slowly (a torus strip of 12 m by 0.15 mm: 24 s and tens of thousands of
nodes) or wrongly: of the wall of a spring, once it was cut or has a fillet, whole turns are missing.

Idea: the edges' own curves in (u, v) give the outline; points are added where lines cross that lie as close
as the surface bends; a constrained Delaunay triangulation in the plane where these lines are one apart.
Precondition: the outline does not cross itself in (u, v). Postcondition: the triangles have the nodes of the
edges and those points as corners; at seams and poles nodes come twice and coincide. Cost: some 50
microseconds for each node.
"""

import numpy as np
import Part

from ..errors import MeshError
from ..polygons import plane_triangles
from .cad_elements import INTERIOR

NARROW = 1e-2  # width over length
BEND = 0.3  # radians between two lines, about
COVERED, ALMOST = 0.02, 0.05  # of a face's area: how far triangles may be off, OCC's and those made here
MOST = 50_000  # crossings of lines: half a second
SAMPLES = 400  # along each of a few lines, to see how they bend
SHARES = (0.1, 0.3, 0.5, 0.7, 0.9)  # of the range: where these lines lie
CLEAR = 0.35  # of the distance of two lines: how far points inside keep from the outline
STEPS = 16  # samples between two nodes of an edge


def is_narrow(face, surface):
    """Whether a face is a strip of a torus with one outline, known in (u, v), that does not go round it."""
    if not isinstance(surface, Part.Toroid) or len(face.Wires) != 1:
        return False
    u0, u1, v0, v1 = face.ParameterRange
    if max(u1 - u0, v1 - v0) > 1.9 * np.pi:
        return False
    lengths = torus_lengths(face, surface)
    return min(lengths) < NARROW * max(lengths) and all(map(face.curveOnSurface, face.Edges))


def torus_lengths(face, surface):
    """Lengths (mm) of a torus face along both parameters, about."""
    u0, u1, v0, v1 = face.ParameterRange
    return (u1 - u0) * (surface.MajorRadius + surface.MinorRadius), (v1 - v0) * surface.MinorRadius


def covering_facets(face, surface, lines, facets, crossing):
    """Facets with the area of the face where OCC's have another or cross; None if these have not, either.

    lines: as for parametric_facets(); facets: OCC's (nodes, triangles); crossing: whether they cross.
    """
    area = face.Area
    off = abs(area_of(facets) - area)
    if off <= COVERED * area and not crossing:
        return None
    try:
        better = parametric_facets(face, surface, lines, *bending_lines(face, surface))
    except MeshError:  # the outline crosses itself
        return None
    except (RuntimeError, TypeError, ValueError, AttributeError):  # an edge without a curve in (u, v), a kind
        return None  # of surface that FreeCAD has no class for
    left = abs(area_of(better) - area)
    return better if left <= COVERED * area or left < min(0.5 * off, ALMOST * area) else None


def strip_facets(face, surface, lines):
    """parametric_facets() of a narrow strip of a torus: lines only across it, so none cross inside."""
    u0, u1, v0, v1 = face.ParameterRange
    lengths = torus_lengths(face, surface)
    across_u, across_v = (int(np.ceil(length / min(lengths))) for length in lengths)
    return parametric_facets(
        face, surface, lines, np.linspace(u0, u1, across_u + 1), np.linspace(v0, v1, across_v + 1)
    )


def area_of(facets):
    """Area of (nodes, triangles) (mm2)."""
    nodes, triangles = facets
    if not triangles:
        return 0.0
    points = np.array([(*node,) for node in nodes])
    a, b, c = (points[corners] for corners in np.array(triangles).T)
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def parametric_facets(face, surface, lines, across_u, across_v):
    """(nodes, triangles) of a face as getFacesFromSubElement gives them.

    lines: the polyline of each edge of face.Edges, nodes from end to end; across_u, across_v: ascending
    parameters from one end of the face's range to the other, where the lines lie whose crossings become
    nodes. Raises MeshError when the outline crosses itself in (u, v), TypeError when an edge has no curve
    there.
    """
    nodes, places, loops = outline(face, lines)
    apart = np.column_stack([evenly(places[:, 0], across_u), evenly(places[:, 1], across_v)])
    inner = points_inside(apart, loops, len(across_u), len(across_v))
    nodes += [surface.value(across_u[i], across_v[j]) for i, j in inner.tolist()]
    flat = np.concatenate([apart, inner])
    single = [[number] for number in range(len(apart), len(flat))]
    # The sweep of plane_triangles() goes along x: along the longer direction it leaves less to flip.
    long, short = flat.T if len(across_u) > len(across_v) else flat.T[::-1]
    triangles = plane_triangles(np.column_stack([long, short, np.zeros(len(flat))]), loops + single)
    if triangles is None:
        raise MeshError("plc", "bad_facet", "the outline of a face crosses itself in (u, v)")
    if signed_area(flat, triangles) * normal_sign(face, surface, across_u, across_v) < 0.0:
        triangles = triangles[:, ::-1]
    return nodes, [tuple(corners) for corners in triangles.tolist()]


def signed_area(flat, triangles):
    """Area of triangles in the plane, positive when they turn to the left."""
    a, b, c = (flat[triangles[:, k]] for k in range(3))
    (bu, bv), (cu, cv) = (b - a).T, (c - a).T
    return 0.5 * float((bu * cv - bv * cu).sum())


def normal_sign(face, surface, across_u, across_v):
    """1.0 when the face's normal is that of the parameters' right hand, -1.0 otherwise."""
    for share in SHARES:
        u = across_u[0] + share * (across_u[-1] - across_u[0])
        v = across_v[0] + share * (across_v[-1] - across_v[0])
        normal = surface.getDN(u, v, 1, 0).cross(surface.getDN(u, v, 0, 1))
        if normal.Length > 0.0:
            return 1.0 if normal.dot(face.normalAt(u, v)) > 0.0 else -1.0
    return 1.0


def outline(face, lines):
    """(nodes, their (u, v) as (n, 2), loops of places in both) of the outline of a face."""
    edges, nodes, places, loops = face.Edges, [], [], []
    for wire in face.Wires:
        first = len(nodes)
        pieces = []
        for edge in edges_round(wire):
            own = next(number for number, other in enumerate(edges) if other.isSame(edge))
            pieces.append(edge_piece(face, edge, lines[own]))
        for line, run in end_to_end(pieces):
            nodes += line[:-1]
            places += run[:-1].tolist()
        if pieces:
            loops.append(list(range(first, len(nodes))))
    return nodes, np.array(places), loops


def edges_round(wire):
    """The edges of a wire as they run round the face: a seam twice, if the wire has it twice; without those
    that bound nothing.

    Raises MeshError when OCC does not find its way along the wire.
    """
    # wire.Edges has each edge once, and so has childShapes() from FreeCAD 1.0 on.
    ordered = [edge for edge in wire.OrderedEdges if edge.Orientation not in INTERIOR]
    bounding = [edge for edge in wire.Edges if edge.Orientation not in INTERIOR]
    if not all(any(edge.isSame(other) for other in ordered) for edge in bounding):
        raise MeshError("plc", "bad_facet", "the outline of a face is not one closed line")
    return ordered


def edge_piece(face, edge, line):
    """(nodes, their (u, v) as (n, 2)) of an edge as it runs round the face."""
    curve, start, end = face.curveOnSurface(edge)
    if edge.Degenerated:
        line, shares = [edge.Vertexes[0].Point] * 2, np.array([0.0, 1.0])
    else:
        line, shares = along(edge, line)
    run = [curve.value(start + share * (end - start)) for share in shares]
    run = np.array([(place.x, place.y) for place in run])
    return (line[::-1], run[::-1]) if edge.Orientation == "Reversed" else (line, run)


def end_to_end(pieces):
    """Pieces of a closed outline in an order in which each starts where the one before ends in (u, v)."""
    if not pieces:
        return []
    extent = np.ptp(np.concatenate([run for _, run in pieces]), axis=0)
    ordered, left = [pieces[0]], list(pieces[1:])
    while left:
        gaps = [np.linalg.norm((run[0] - ordered[-1][1][-1]) / extent) for _, run in left]
        ordered.append(left.pop(int(np.argmin(gaps))))
    return ordered


def along(edge, line):
    """(nodes of an edge's polyline as its parameter runs, share of the range of each, ascending)."""
    first, last = edge.ParameterRange
    shares = np.linspace(0.0, 1.0, STEPS * len(line) + 1)
    samples = np.array([(*edge.valueAt(first + share * (last - first)),) for share in shares])
    way = run_lengths(samples)
    tries = []
    for nodes in (line, line[::-1]):
        points = np.array([(*node,) for node in nodes])
        even = np.interp(run_lengths(points), way, shares)
        about = np.rint(even * (len(shares) - 1)).astype(int)
        near = np.clip(about[:, None] + np.arange(-2 * STEPS, 2 * STEPS + 1), 0, len(shares) - 1)
        apart = np.linalg.norm(samples[near] - points[:, None], axis=2)
        found = shares[near[np.arange(len(near)), apart.argmin(axis=1)]]
        found[0], found[-1] = 0.0, 1.0
        tries.append((apart.min(axis=1).max(), nodes, found if (np.diff(found) > 0.0).all() else even))
    _, nodes, found = min(tries, key=lambda attempt: attempt[0])
    return nodes, found


def run_lengths(points):
    """(n,) length from the first of some points to each, over the whole."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    run = np.concatenate([[0.0], np.cumsum(steps)])
    return run / max(run[-1], 1e-300)


def bending_lines(face, surface):
    """Ascending parameters (u, v) from end to end of a face's range, between which the surface turns by about
    BEND along the other parameter's lines, by more where there would be too many."""
    u0, u1, v0, v1 = face.ParameterRange
    along_u = [[(u, v0 + share * (v1 - v0)) for u in np.linspace(u0, u1, SAMPLES)] for share in SHARES]
    along_v = [[(u0 + share * (u1 - u0), v) for v in np.linspace(v0, v1, SAMPLES)] for share in SHARES]
    turns_u, turns_v = turns(surface, along_u), turns(surface, along_v)
    bend = max(BEND, np.sqrt(turns_u[-1] * turns_v[-1] / MOST))
    return spread(turns_u, bend, u0, u1), spread(turns_v, bend, v0, v1)


def turns(surface, walks):
    """(SAMPLES,) by how much (rad) the walk that turns most at each place has turned up to there."""
    turn = np.zeros(SAMPLES)
    for walk in walks:
        points = np.array([(*surface.value(float(u), float(v)),) for u, v in walk])
        steps = np.diff(points, axis=0)
        steps /= np.maximum(np.linalg.norm(steps, axis=1), 1e-300)[:, None]
        cosines = np.clip((steps[:-1] * steps[1:]).sum(axis=1), -1.0, 1.0)
        turn[1:-1] = np.maximum(turn[1:-1], np.arccos(cosines))
    return np.cumsum(turn)


def spread(turned, bend, low, high):
    """Ascending parameters from low to high, a turn of `bend` apart; see turns()."""
    run = turned + 1e-6 * (turned[-1] + bend) * np.arange(SAMPLES)  # strictly ascending
    wanted = np.linspace(run[0], run[-1], int(turned[-1] / bend) + 2)
    return np.interp(wanted, run, np.linspace(low, high, SAMPLES))


def evenly(values, lines):
    """Parameters as numbers of lines, between which they are interpolated."""
    return np.interp(values, lines, np.arange(len(lines)))


def points_inside(apart, loops, count_u, count_v):
    """(k, 2) int crossings of lines that lie inside closed loops of points and clear of them."""
    i, j = np.meshgrid(np.arange(1, count_u - 1), np.arange(1, count_v - 1), indexing="ij")
    crossings = np.column_stack([i.ravel(), j.ravel()])
    start = np.concatenate([apart[loop] for loop in loops])
    end = np.concatenate([np.roll(apart[loop], -1, axis=0) for loop in loops])
    inside = [crossing for crossing in crossings if is_inside(crossing, start, end)]
    return np.array(inside, dtype=np.int64).reshape(-1, 2)


def is_inside(place, start, end):
    """Whether a place lies inside the segments of closed polygons and CLEAR of all."""
    way = end - start
    share = ((place - start) * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-300)
    foot = start + np.clip(share, 0.0, 1.0)[:, None] * way
    if np.linalg.norm(place - foot, axis=1).min() < CLEAR:
        return False
    straddles = (start[:, 1] > place[1]) != (end[:, 1] > place[1])
    below, above = start[straddles], end[straddles]
    level = below[:, 0] + (place[1] - below[:, 1]) / (above[:, 1] - below[:, 1]) * (above - below)[:, 0]
    return bool((level > place[0]).sum() % 2)
