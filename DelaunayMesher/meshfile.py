"""Write meshes: .vtu and .inp by our own writers, .FCStd, .med and .unv by FreeCAD, all else by meshio."""

import os
import tempfile

import numpy as np

from .cadprocess import ending_of
from .errors import InputError, MeshError, incomplete_file
from .inpfile import write_inp
from .surfacefile import import_meshio
from .vtufile import write_vtu

FREECAD_ENDING = ".fcstd"
BY_FREECAD = (FREECAD_ENDING, ".med", ".unv")
VTU_ENDING = ".vtu"
NASTRAN_ENDINGS = (".bdf", ".nas")
# Formats that hold tetrahedra and, but for .inp, triangles.
MESH_ENDINGS = (".inp", VTU_ENDING, ".vtk", ".msh", ".med", ".unv", ".xdmf", *NASTRAN_ENDINGS, ".mesh")


def write_by_freecad(path, mesh):
    """Write .med or .unv, with a group for each CAD element, as FreeCAD does."""
    from . import document

    document.fem_mesh(mesh).write(path)
    if ending_of(path) == ".med" and not is_whole_hdf5(path):
        raise incomplete_file()


def is_whole_hdf5(path):
    """Whether an HDF5 file ends where its head says.

    The head gets its last form when all else is written; that this fails, FreeCAD does not notice.
    """
    with open(path, "rb") as file:
        head = file.read(52)
    place = {0: 40, 1: 44}.get(head[8], 28)  # of the file's end, by the version of the head
    return int.from_bytes(head[place : place + 8], "little") == os.path.getsize(path)


# All else is meshio's; in its .med files the nodes have VTK's order, there are no groups, and FreeCAD finds
# no nodes.
WRITERS = {VTU_ENDING: write_vtu, ".inp": write_inp, ".med": write_by_freecad, ".unv": write_by_freecad}


def check_output(path):
    """Raise InputError when `path` cannot be written: unknown format, no folder, no permission."""
    place = os.path.abspath(str(path))
    folder = os.path.dirname(place)
    if not os.path.isdir(folder):
        raise _unwritable("%s: there is no folder %s" % (path, folder))
    if not os.access(folder, os.W_OK):  # the writers need a folder of their own beside the file
        raise _unwritable("%s: no permission to write into %s" % (path, folder))
    if os.path.isdir(place):
        raise _unwritable("%s is a folder" % path)
    if os.path.exists(place) and not os.access(place, os.W_OK):
        raise _unwritable("%s: no permission to replace it" % path)
    if ending_of(path) in BY_FREECAD:
        from . import document  # noqa: F401  raises when there is no FreeCAD
    elif ending_of(path) not in MESH_ENDINGS:
        known = ".FCStd " + " ".join(MESH_ENDINGS)
        raise _unwritable(
            "%s: cannot write %r files, only %s" % (path, ending_of(path), known), "unknown_format"
        )
    elif ending_of(path) not in WRITERS:
        import_meshio()


def _unwritable(message, code="unwritable"):
    return InputError("write", code, message)


def to_meshio(mesh):
    """meshio.Mesh: cells tetra | tetra10 and triangle | triangle6, cell data 'solid' and 'face' (1-based, 0
    = none).
    """
    meshio = import_meshio()
    second = mesh.order == 2
    tets, triangles = np.asarray(mesh.tets), np.asarray(mesh.triangles)
    cells = [("tetra10" if second else "tetra", tets), ("triangle6" if second else "triangle", triangles)]
    data = {
        "solid": [np.asarray(mesh.tet_solid, np.int32), np.zeros(len(triangles), np.int32)],
        "face": [np.zeros(len(tets), np.int32), np.asarray(mesh.triangle_face, np.int32) + 1],
    }
    return meshio.Mesh(np.asarray(mesh.points), cells, cell_data=data)


def write_mesh(path, mesh):
    """Write `mesh` by the ending of `path`; raises InputError when that cannot be done."""
    check_output(path)
    ending = ending_of(path)
    if ending == FREECAD_ENDING:
        from . import document

        document.write_fcstd(str(path), mesh, mesh.shape, mesh.options)
        return
    folder = os.path.dirname(os.path.abspath(str(path)))
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".mesh-") as workshop:
            target = os.path.join(workshop, os.path.basename(str(path)))
            if ending in WRITERS:
                WRITERS[ending](target, mesh)
            else:
                write_with_meshio(target, to_meshio(mesh))
            for name in os.listdir(workshop):  # some formats take several files
                os.replace(os.path.join(workshop, name), os.path.join(folder, name))
    except MeshError:
        raise
    except Exception as error:  # FreeCAD and meshio have errors of their own
        raise _unwritable("%s: %s" % (path, str(error) or type(error).__name__)) from error


def write_with_meshio(path, mesh):
    """Write a meshio.Mesh in the variant of each format that other programs read best."""
    meshio = import_meshio()
    ending = ending_of(path)
    if ending == ".msh":
        tags = _tags(mesh)
        mesh.cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}  # meshio cannot read others back
        meshio.write(path, mesh, file_format="gmsh22")  # the variant that every reader knows
    elif ending == ".mesh":
        if mesh.cells[0].type == "tetra10":
            raise _unwritable("Medit's .mesh has no elements of second order", "unknown_format")
        mesh.cell_data = {"medit:ref": _tags(mesh)}
        meshio.write(path, mesh)
    elif ending == ".xdmf":
        meshio.write(path, mesh, data_format="XML")  # one file
    elif ending == ".vtk":  # VTK does not know the vtktypeint32 that meshio would write
        wide = {name: [part.astype(np.int64) for part in parts] for name, parts in mesh.cell_data.items()}
        mesh.cell_data = wide
        meshio.write(path, mesh)
    elif ending in NASTRAN_ENDINGS:
        solids, faces = mesh.cell_data["solid"][0], mesh.cell_data["face"][1]
        mesh.cell_data = {"nastran:ref": [solids, solids.max() + faces]}  # properties share their numbers
        mesh.points = np.array([[_in_sixteen(x) for x in point] for point in mesh.points.tolist()])
        meshio.write(path, mesh)
    else:
        meshio.write(path, mesh)


def _in_sixteen(x):
    """The number nearest to x that fits into the 16 characters of a Nastran field."""
    if abs(x) < 1e-99:
        return 0.0
    return float("%.10e" % x) if 1e-9 <= abs(x) < 9e9 else float("%.9e" % x)


def _tags(mesh):
    """The solid of each tetrahedron and the face of each triangle, for formats with one number per cell."""
    return [
        np.maximum(*pair).astype(np.int32) for pair in zip(mesh.cell_data["solid"], mesh.cell_data["face"])
    ]
