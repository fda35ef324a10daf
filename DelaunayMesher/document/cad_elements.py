"""The faces, edges, vertices and solids of a CAD shape, and which bounds which.

They are recognised by their TShape and location (hashCode + isSame), never by position. Indices are 0-based
places in shape.Faces / Edges / Vertexes / Solids; FreeCAD's names are one higher. Cost: 10 microseconds for
each edge of each face, once for all tessellations of a shape.
"""

import numpy as np

INTERIOR = ("Internal", "External")


class ShapeIndex:
    """Position of a face, an edge or a vertex in a list of shapes, whatever its orientation."""

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


class CadElements:
    """Elements of a copy of a shape, without triangles of its own; the geometry is that of the original.

    shape: the copy; diagonal: of its bounding box (mm); faces, edges, vertices, solids: lists of Part shapes;
    surfaces: per face its Part surface, or None for a kind FreeCAD has no class for; face_edges: per face the
    indices of its edges, in the order of face.Edges; edge_faces: per edge the indices of its faces;
    seam_faces: {seam edge: its face}; sides (F, 2) int64: see face_sides().
    """

    def __init__(self, shape):
        self.shape = shape.copy(False)  # the displayed shape keeps its own triangulation
        bounds = self.shape.BoundBox
        self.diagonal = bounds.DiagonalLength if bounds.isValid() else np.inf
        self.faces, self.edges = self.shape.Faces, self.shape.Edges
        self.vertices, self.solids = self.shape.Vertexes, self.shape.Solids
        self.surfaces = [surface_of(face) for face in self.faces]
        self.face_edges, self.edge_faces, self.seam_faces = incidences(self.faces, self.edges)
        self.sides = face_sides(self.faces, self.solids)


def surface_of(face):
    """The Part surface of a face, or None if FreeCAD has no class for its kind."""
    try:
        return face.Surface
    except (RuntimeError, TypeError, ValueError):
        return None


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
