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
        cells = {"Edge": mesh.lines, "Face": mesh.triangles}
        for name, (kind, rows) in mesh.element_rows().items():
            if kind == "Volume":
                write_set(file, "*ELSET, ELSET=" + name, rows)
            else:
                write_set(file, "*NSET, NSET=" + name, np.unique(cells[kind][rows]))
        for name, points in mesh.vertex_points().items():
            write_set(file, "*NSET, NSET=" + name, points)


def write_set(file, head, rows):
    """A set of things by their numbers from 0; Abaqus counts from 1."""
    numbers = [str(row + 1) for row in rows.tolist()]
    file.write(head + "\n")
    file.writelines(", ".join(numbers[k : k + AT_ONCE]) + "\n" for k in range(0, len(numbers), AT_ONCE))
