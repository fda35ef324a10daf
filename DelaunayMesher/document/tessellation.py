"""A CAD shape's tessellation as numpy arrays: triangles per face, polylines per edge, sides per solid.

OCC meshes every edge once and every face against its edges, so the nodes of two faces agree along a shared
edge to about 1e-12 mm; they are merged with a tolerance here.  Faces and edges are recognised by their TShape
and location (hashCode + isSame), never by position.  Indices are 0-based positions in shape.Faces / Edges /
Vertexes / Solids; FreeCAD's names are one higher.
"""

import itertools
from dataclasses import dataclass, field

import MeshPart
import numpy as np
import Part

from .merge_points import merge_points
from .strips import is_narrow, strip_facets

INTERIOR = ("Internal", "External")
COARSE_ANGLE = 0.3  # radians
ONE_TURN = 2.02 * np.pi
ROUND = (Part.Cylinder, Part.Cone, Part.Sphere, Part.Toroid, Part.SurfaceOfRevolution)


def vectors_to_array(vectors):
    """(n, 3) float64 from FreeCAD vectors."""
    flat = np.fromiter(itertools.chain.from_iterable(vectors), dtype=np.float64, count=3 * len(vectors))
    return flat.reshape(-1, 3)


class ShapeIndex:
    """Position of a face or an edge in a list of shapes, whatever its orientation."""

    def __init__(self, shapes):
        self.shapes = shapes
        self.by_hash = {}
        for position, shape in enumerate(shapes):
            self.by_hash.setdefault(shape.hashCode(), []).append(position)

    def find(self, shape):
        """0-based position, or -1."""
        for position in self.by_hash.get(shape.hashCode(), ()):
            if self.shapes[position].isSame(shape):
                return position
        return -1


@dataclass
class Tessellation:
    """Raw triangles and polylines of a shape, nodes merged.  `faces`, `edges` are CAD objects of a copy."""

    shape: object
    faces: list
    edges: list
    points: np.ndarray  # (n, 3)
    triangles: np.ndarray  # (m, 3) int64, right-hand normal = normal of the oriented face
    triangle_face: np.ndarray  # (m,)
    segments: np.ndarray  # (k, 2)
    segment_edge: np.ndarray  # (k,)
    vertex_point: np.ndarray  # (V,) point of each CAD vertex
    face_edges: list  # per face the indices of its edges
    edge_faces: list  # per edge the indices of its faces
    seam_faces: dict  # edge -> face of which it is the seam
    collapsed: int = 0
    face_nodes: list = field(default_factory=list)  # per face the unmerged nodes, for checks of its geometry


def tessellate(shape, linear, angular):
    """Tessellation of a copy of `shape` with the given linear (mm) and angular (rad) deflection."""
    shape = shape.copy()  # the displayed shape keeps its own triangulation
    faces, edges, vertices = shape.Faces, shape.Edges, shape.Vertexes
    face_edges, edge_faces, seam_faces = incidences(faces, edges)
    narrow = {number for number, face in enumerate(faces) if is_narrow(face)}
    wide = Part.Compound([face for number, face in enumerate(faces) if number not in narrow])
    MeshPart.meshFromShape(
        Shape=wide if narrow else shape, LinearDeflection=linear, AngularDeflection=angular, Relative=False
    )
    lines = edge_lines(faces, edges, face_edges, narrow, linear)
    facets = [
        strip_facets(face, [lines[edge] for edge in face_edges[number]])
        if number in narrow
        else ([], [])
        if laps_itself(face)
        else face.getFacesFromSubElement("Face", 1)
        for number, face in enumerate(faces)
    ]

    blocks = [vectors_to_array([vertex.Point for vertex in vertices])]
    blocks += [vectors_to_array(line) for line in lines]
    face_nodes = [vectors_to_array(nodes) for nodes, _ in facets]
    blocks += face_nodes
    points = np.concatenate(blocks)
    starts = np.concatenate([[0], np.cumsum([len(block) for block in blocks])])
    diagonal = shape.BoundBox.DiagonalLength
    tolerance = max(min(1e-7, 1e-7 * diagonal), 1e-9 * diagonal)  # mm; OCC's own is 1e-7
    root = merge_points(points, tolerance)
    used, compact = np.unique(root, return_inverse=True)
    compact = compact.reshape(-1)

    segments, segment_edge = gather_segments(lines, starts[1 : 1 + len(lines)], compact)
    offsets = starts[1 + len(lines) : -1]
    triangles, triangle_face, collapsed = gather_triangles(facets, offsets, compact)
    return Tessellation(
        shape=shape,
        faces=faces,
        edges=edges,
        points=points[used],
        triangles=triangles,
        triangle_face=triangle_face,
        segments=segments,
        segment_edge=segment_edge,
        vertex_point=compact[: len(vertices)],
        face_edges=face_edges,
        edge_faces=edge_faces,
        seam_faces=seam_faces,
        collapsed=collapsed,
        face_nodes=face_nodes,
    )


def laps_itself(face):
    """Whether a face goes round its surface more than once: its edges were put on it a turn apart.

    OCC's triangles of such a face lie on each other; without any it is filled from its outline (filling.py).
    """
    u0, u1, _, _ = face.ParameterRange
    return u1 - u0 > ONE_TURN and isinstance(face.Surface, ROUND)


def incidences(faces, edges):
    """Per face its edges (in the order of face.Edges); per edge its faces; {seam edge: its face}."""
    index = ShapeIndex(edges)
    edge_faces = [[] for _ in edges]
    face_edges, seam_faces = [], {}
    for face_number, face in enumerate(faces):
        mine = []
        for edge in face.Edges:
            number = index.find(edge)
            mine.append(number)
            edge_faces[number].append(face_number)
            if not edges[number].Degenerated and edge.isSeam(face):
                seam_faces[number] = face_number
        face_edges.append(mine)
    return face_edges, edge_faces, seam_faces


def edge_lines(faces, edges, face_edges, without, linear):
    """Per edge the ordered nodes of its polygon, asked of a face it bounds (that is far cheaper than of the
    whole shape) that OCC has triangulated, or cut up here when there is none."""
    lines = [[] for _ in edges]
    for face_number, (face, mine) in enumerate(zip(faces, face_edges)):
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


def gather_segments(lines, starts, compact):
    """Segments (k, 2) and the edge of each, from polylines stored one after the other; none of length 0."""
    pairs, owners = [], []
    for number, (line, start) in enumerate(zip(lines, starts)):
        if len(line) > 1:
            nodes = compact[start : start + len(line)]
            pairs.append(np.stack([nodes[:-1], nodes[1:]], axis=1))
            owners.append(np.full(len(line) - 1, number))
    if not pairs:
        return np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=np.int64)
    segments, owner = np.concatenate(pairs), np.concatenate(owners)
    real = segments[:, 0] != segments[:, 1]
    return segments[real], owner[real]


def gather_triangles(facets, offsets, compact):
    """Triangles (m, 3), the face of each, and how many collapsed because nodes merged (dropped)."""
    blocks, owners = [], []
    for number, ((_, corners), offset) in enumerate(zip(facets, offsets)):
        if corners:
            flat = np.fromiter(itertools.chain.from_iterable(corners), dtype=np.int64, count=3 * len(corners))
            blocks.append(flat.reshape(-1, 3) + offset)
            owners.append(np.full(len(corners), number))
    if not blocks:
        return np.zeros((0, 3), dtype=np.int64), np.zeros(0, dtype=np.int64), 0
    triangles, owner = compact[np.concatenate(blocks)], np.concatenate(owners)
    real = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return triangles[real], owner[real], int(len(real) - real.sum())


def face_sides(faces, solids):
    """(F, 2) int64 {solid behind, solid in front} of each face's normal; 1-based, 0 = outside.

    A face that a solid lists as interior, or twice with both orientations, has that solid on both sides.
    """
    index = ShapeIndex(faces)
    sides = np.zeros((len(faces), 2), dtype=np.int64)
    for number, solid in enumerate(solids, 1):
        for shell in solid.SubShapes:
            for face in shell.SubShapes if shell.ShapeType == "Shell" else ():
                position = index.find(face)
                if position < 0:
                    continue
                if face.Orientation in INTERIOR:
                    sides[position] = number
                else:
                    sides[position, int(face.Orientation != faces[position].Orientation)] = number
    return sides
