"""FreeCAD's FemMesh -> arrays, whoever made it; and the surface of a part of it."""

import re
from collections import Counter
from dataclasses import dataclass

import numpy as np

TETRAHEDRON_NODES = (4, 10)


@dataclass
class Tetrahedra:
    """points (n, 3) in mm; tets (t, 4) rows of points, corners only, all of positive volume; element (t,)
    FreeCAD's numbers."""

    points: np.ndarray
    tets: np.ndarray
    element: np.ndarray


def tetrahedra(fem_mesh):
    """The Tetrahedra of a FemMesh; other volumes are left out.  About 2 microseconds per element."""
    nodes = fem_mesh.Nodes
    number = np.fromiter(nodes.keys(), dtype=np.int64, count=len(nodes))
    points = np.array([(p.x, p.y, p.z) for p in nodes.values()], dtype=np.float64).reshape(-1, 3)
    element, corners = [], []
    for volume in fem_mesh.Volumes:
        found = fem_mesh.getElementNodes(volume)
        if len(found) in TETRAHEDRON_NODES:
            element.append(volume)
            corners.append((found[1], found[0], found[2], found[3]))  # FreeCAD's are mirrored
    row = np.zeros(number.max() + 1 if len(number) else 0, dtype=np.int64)
    row[number] = np.arange(len(number))
    tets = row[np.array(corners, dtype=np.int64).reshape(-1, 4)]
    return Tetrahedra(points, tets, np.array(element, dtype=np.int64))


def cad_faces(fem_mesh):
    """{FreeCAD's node number: 'Face3'} from the groups FaceN of a FemMesh; one face for nodes on several."""
    found = {}
    for group in fem_mesh.Groups:
        name = fem_mesh.getGroupName(group)
        if re.match(r"Face[0-9]+$", name) and fem_mesh.getGroupElementType(group) == "Face":
            for element in fem_mesh.getGroupElements(group):
                found.update(dict.fromkeys(fem_mesh.getElementNodes(element), name))
    return found


def cad_face_of(fem_mesh, element, faces):
    """The CAD face that most nodes of an element lie on, by cad_faces(); None when it is inside."""
    touched = Counter(faces[node] for node in fem_mesh.getElementNodes(element) if node in faces)
    return touched.most_common(1)[0][0] if touched else None


class FaceTable:
    """The faces of tetrahedra with the tetrahedron on either side: fast surfaces of any part of a mesh."""

    OPPOSITE = (
        (2, 1, 3),
        (0, 2, 3),
        (1, 0, 3),
        (0, 1, 2),
    )  # outward for positive volume, opposite 0, 1, 2, 3

    def __init__(self, tets):
        faces = np.concatenate([tets[:, corners] for corners in self.OPPOSITE])
        owner = np.tile(np.arange(len(tets)), 4)
        ordered = np.sort(faces, axis=1)
        order = np.lexsort(ordered.T)
        same = (ordered[order][1:] == ordered[order][:-1]).all(axis=1)
        other = np.full(len(faces), -1)
        other[order[:-1][same]] = owner[order[1:][same]]
        other[order[1:][same]] = owner[order[:-1][same]]
        self.faces, self.owner, self.other = faces, owner, other

    def surface(self, kept):
        """(faces (f, 3), their tetrahedra (f,)) of the boundary of the tetrahedra where `kept` (t,) holds."""
        neighbour_kept = kept[self.other] & (self.other >= 0)
        shown = kept[self.owner] & ~neighbour_kept
        return self.faces[shown], self.owner[shown]
