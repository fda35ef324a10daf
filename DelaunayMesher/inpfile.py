"""Meshes in the input format of Abaqus, as CalculiX and FreeCAD read it.

Tetrahedra alone (C3D4, C3D10), so that the file can be included in an analysis: the boundary is there as sets
of nodes.  ELSET SolidN; NSET FaceN, EdgeN, VertexN; all nodes Nall, all elements Eall.  A number has at most
19 characters, as CalculiX reads 20.
"""

import numpy as np

AT_ONCE = 16  # numbers in a row of a set


def write_inp(path, mesh):
    """Write a Mesh to the path; raises OSError."""
    with open(path, "w") as file:
        file.write("*NODE, NSET=Nall\n")
        rows = zip(range(1, len(mesh.points) + 1), *np.asarray(mesh.points, float).T.tolist())
        file.writelines("%d, %.12e, %.12e, %.12e\n" % row for row in rows)
        file.write("*ELEMENT, TYPE=C3D%d, ELSET=Eall\n" % mesh.tets.shape[1])
        numbered = np.column_stack([np.arange(len(mesh.tets)), mesh.tets]) + 1
        file.writelines(", ".join(map(str, row)) + "\n" for row in numbered.tolist())
        for solid, tets in members(mesh.tet_solid):
            write_set(file, "*ELSET, ELSET=Solid%d" % solid, tets)
        for kind, cells, owner in (
            ("Face", mesh.triangles, mesh.triangle_face),
            ("Edge", mesh.lines, mesh.line_edge),
        ):
            for index, rows in members(owner):
                write_set(file, "*NSET, NSET=%s%d" % (kind, index + 1), np.unique(cells[rows]))
        for point in np.flatnonzero(mesh.point_dimension == 0).tolist():
            write_set(file, "*NSET, NSET=Vertex%d" % (mesh.point_entity[point] + 1), np.array([point]))


def members(owner):
    """(owner, rows that it owns) for each owner that is no placeholder (-1)."""
    order = np.argsort(owner, kind="stable")
    owners, starts = np.unique(owner[order], return_index=True)
    parts = zip(owners.tolist(), np.split(order, starts[1:]))
    return [(index, rows) for index, rows in parts if index >= 0]


def write_set(file, head, rows):
    """A set of things by their numbers from 0; Abaqus counts from 1."""
    numbers = [str(row + 1) for row in rows.tolist()]
    file.write(head + "\n")
    file.writelines(", ".join(numbers[k : k + AT_ONCE]) + "\n" for k in range(0, len(numbers), AT_ONCE))
