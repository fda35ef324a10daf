"""A CAD shape's tessellation as numpy arrays: triangles per face, polylines per edge.

OCC meshes every edge once and every face against its edges, so the nodes of two faces agree along a shared
edge to about 1e-12 mm; they are merged with a tolerance here. Cost: OCC's own time and 3 microseconds for
each node and triangle.
"""

import itertools
from dataclasses import dataclass, replace

import MeshPart
import numpy as np
import Part

from .. import extension
from ..errors import MeshError
from ..merge_points import merge_points
from .cad_elements import CadElements
from .closed import open_triangles
from .parametric import covering_facets, is_narrow, strip_facets

COARSE_ANGLE = 0.3  # radians
SMALL = 25  # deflections, half an element: side of the faces that are not looked at
CREASE = np.radians(60.0)  # between facets of a face; the deflection asked for makes 17 degrees
ONE_TURN = 2.02 * np.pi
ROUND = (Part.Cylinder, Part.Cone, Part.Sphere, Part.Toroid, Part.SurfaceOfRevolution)


@dataclass
class Tessellation:
    """Triangles and polylines of the elements of a shape, nodes merged."""

    cad: CadElements
    points: np.ndarray  # (n, 3) float64, mm
    triangles: np.ndarray  # (m, 3) int64, right-hand normal = normal of the oriented face
    triangle_face: np.ndarray  # (m,)
    segments: np.ndarray  # (k, 2)
    segment_edge: np.ndarray  # (k,)
    vertex_point: np.ndarray  # (V,) point of each CAD vertex
    face_nodes: list  # per face (n, 3) unmerged nodes, for checks of its geometry


def tessellate(cad, linear, angular):
    """Tessellation of CadElements with the given linear (mm) and angular (rad) deflection."""
    narrow = {
        number
        for number, (face, surface) in enumerate(zip(cad.faces, cad.surfaces))
        if is_narrow(face, surface)
    }
    wide = cad.shape
    if narrow:
        wide = Part.Compound([face for number, face in enumerate(cad.faces) if number not in narrow])
    MeshPart.meshFromShape(Shape=wide, LinearDeflection=linear, AngularDeflection=angular, Relative=False)
    lines = edge_lines(cad, narrow, linear)
    facets = face_facets(cad, narrow, lines, linear, angular)
    mesh = gathered(cad, lines, facets)
    creased = creased_faces(mesh, (SMALL * linear) ** 2)
    better = {face: covering(mesh, face, lines, facets[face]) for face in creased}
    if any(better.values()):
        mesh = gathered(cad, lines, [better.get(face) or old for face, old in enumerate(facets)])
    return without_laps(mesh)


def covering(mesh, face, lines, facets):
    """Facets of a face of a Tessellation where OCC's do not cover it or cross, or None."""
    cad = mesh.cad
    mine = [lines[edge] for edge in cad.face_edges[face]]
    crossing = laps_itself(mesh.points, mesh.triangles[mesh.triangle_face == face])
    return covering_facets(cad.faces[face], cad.surfaces[face], mine, facets, crossing)


def creased_faces(mesh, small):
    """Numbers, ascending, of the curved faces some of whose triangles meet at an angle that no surface
    triangulated finely has: OCC may have left out a part of such a face, and closed the gap with facets.

    small: area (mm2) of faces that do not matter; the exact area, which comes next, takes OCC 5 ms.
    """
    flat = np.array([isinstance(surface, Part.Plane) for surface in mesh.cad.surfaces])
    curved = ~flat[mesh.triangle_face]
    triangles, owner = mesh.triangles[curved], mesh.triangle_face[curved]
    a, b, c = (mesh.points[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    large = np.bincount(owner, 0.5 * lengths, minlength=len(flat)) > small
    normals /= np.maximum(lengths, 1e-300)[:, None]
    start, end = triangles.reshape(-1), np.roll(triangles, -1, axis=1).reshape(-1)
    row = np.repeat(np.arange(len(triangles)), 3)
    count = len(mesh.points)
    key = (owner[row] * count + np.minimum(start, end)) * count + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    shared = np.flatnonzero(key[order][1:] == key[order][:-1])
    first, second = row[order][shared], row[order][shared + 1]
    creased = (normals[first] * normals[second]).sum(axis=1) < np.cos(CREASE)
    faces = np.unique(owner[first[creased]])
    return faces[large[faces]].tolist()


def gathered(cad, lines, facets):
    """Tessellation of CadElements from edge_lines() and face_facets(), nodes that coincide merged."""
    corners = [vertex.Point for vertex in cad.vertices]
    counts = np.array([len(corners), *map(len, lines), *(len(nodes) for nodes, _ in facets)])
    starts = np.cumsum(counts) - counts
    points = vectors_to_array(itertools.chain(corners, *lines, *(nodes for nodes, _ in facets)), counts.sum())
    root = merge_points(points, max(min(1e-7, 1e-7 * cad.diagonal), 1e-9 * cad.diagonal))  # OCC's is 1e-7
    used = root == np.arange(len(root))
    compact = (np.cumsum(used) - 1)[root]
    segments, segment_edge = gather_segments(
        counts[1 : 1 + len(lines)], compact[len(corners) : len(corners) + sum(map(len, lines))]
    )
    starts = starts[1 + len(lines) :].tolist()
    triangles, triangle_face = gather_triangles([triangles for _, triangles in facets], starts, compact)
    return Tessellation(
        cad=cad,
        points=points[used],
        triangles=triangles,
        triangle_face=triangle_face,
        segments=segments,
        segment_edge=segment_edge,
        vertex_point=compact[: len(corners)],
        face_nodes=[points[start : start + len(nodes)] for start, (nodes, _) in zip(starts, facets)],
    )


def vectors_to_array(vectors, count):
    """(count, 3) float64 from an iterable of FreeCAD vectors."""
    flat = np.fromiter(itertools.chain.from_iterable(vectors), dtype=np.float64, count=3 * count)
    return flat.reshape(-1, 3)


def without_laps(mesh):
    """The Tessellation without the triangles of faces whose edges were put on their surface a turn apart.

    OCC covers such a face several times: its triangles overlap, or do not meet those of its neighbours;
    without triangles it is filled from its outline (filling.py).
    """
    winding = [number for number, pair in enumerate(zip(mesh.cad.faces, mesh.cad.surfaces)) if winds(*pair)]
    if not winding:
        return mesh
    rows, _ = open_triangles(mesh.triangles, mesh.cad.sides[mesh.triangle_face], len(mesh.points))
    ragged = set(mesh.triangle_face[rows].tolist())
    for number in winding:
        mine = mesh.triangle_face == number
        if number in ragged or laps_itself(mesh.points, mesh.triangles[mine]):
            mesh.face_nodes[number] = np.zeros((0, 3))
            mesh = replace(mesh, triangles=mesh.triangles[~mine], triangle_face=mesh.triangle_face[~mine])
    return mesh


def winds(face, surface):
    """Whether a face goes round its surface more than once, as the strip beside a thread does, too."""
    if not isinstance(surface, ROUND):
        return False
    u0, u1, _, _ = face.ParameterRange
    return u1 - u0 > ONE_TURN


def laps_itself(points, triangles):
    """Whether some of the triangles (m, 3) of a face cross or overlap."""
    return len(extension.load().crossings(points, triangles.astype(np.int32))) > 0


def edge_lines(cad, without, linear):
    """Per edge the ordered nodes of its polygon, asked of a face it bounds (that is far cheaper than of the
    whole shape) that OCC has triangulated, or cut up here when there is none.

    without: faces that OCC has not triangulated; linear: deflection (mm) of what is cut up here.
    """
    edges, face_edges = cad.edges, cad.face_edges
    lines = [[] for _ in edges]
    for face_number, (face, mine) in enumerate(zip(cad.faces, face_edges)):
        for position, number in enumerate(mine if face_number not in without else ()):
            if not lines[number] and not edges[number].Degenerated:
                lines[number] = face.getLinesFromSubElement("Edge", position + 1)[0]
    for number in {edge for face in without for edge in face_edges[face]}:
        if not lines[number] and not edges[number].Degenerated:
            lines[number] = edges[number].discretize(Deflection=linear)
    for number in {edge for mine in face_edges for edge in mine}:  # none of its faces has triangles
        if not lines[number] and not edges[number].Degenerated:
            lines[number] = edges[number].discretize(Angular=COARSE_ANGLE, Curvature=linear, Minimum=3)
    return lines


def face_facets(cad, narrow, lines, linear, angular):
    """Per face (list of vectors, list of triangles as tuples of places in it)."""
    facets = []
    for number, (face, surface) in enumerate(zip(cad.faces, cad.surfaces)):
        mine = [lines[edge] for edge in cad.face_edges[number]]
        if number in narrow:
            facets.append(narrow_facets(face, surface, mine, linear, angular))
        else:
            facets.append(face.getFacesFromSubElement("Face", 1))
    return facets


def narrow_facets(face, surface, lines, linear, angular):
    """(nodes, triangles) of a narrow strip: our own, or OCC's where its outline crosses itself in (u, v)."""
    try:
        return strip_facets(face, surface, lines)
    except MeshError:
        MeshPart.meshFromShape(Shape=face, LinearDeflection=linear, AngularDeflection=angular, Relative=False)
        return face.getFacesFromSubElement("Face", 1)


def gather_segments(counts, nodes):
    """Segments (k, 2) and the edge of each, from polylines stored one after the other; none of length 0.

    counts (E,): nodes of each polyline; nodes: all of them.
    """
    owner = np.repeat(np.arange(len(counts)), counts)
    segments = np.stack([nodes[:-1], nodes[1:]], axis=1).reshape(-1, 2)
    real = (owner[:-1] == owner[1:]) & (segments[:, 0] != segments[:, 1])
    return segments[real], owner[:-1][real]


def gather_triangles(facets, starts, compact):
    """Triangles (m, 3) and the face of each, without those that collapsed because nodes merged.

    facets: per face triples of places among its nodes, which begin at starts[face] among all; compact: the
    merged point of each of these.
    """
    counts = np.array([len(corners) for corners in facets], dtype=np.int64)
    every = itertools.chain.from_iterable(facets)
    flat = np.fromiter(itertools.chain.from_iterable(every), dtype=np.int64, count=3 * counts.sum())
    owner = np.repeat(np.arange(len(counts)), counts)
    triangles = compact[flat.reshape(-1, 3) + np.repeat(np.asarray(starts, dtype=np.int64), counts)[:, None]]
    real = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return triangles[real], owner[real]
