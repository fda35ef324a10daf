"""Meshes as FreeCAD documents, for the command line."""

import os
import tempfile
import zipfile

from ..errors import InputError, incomplete_file
from .find_freecad import find_freecad
from .read_shape import words


def write_fcstd(path, mesh, shape=None, options=None):
    """Write an .FCStd with the part (when there is one) and the filled FEM mesh object.

    options: those that the mesh was made with; without them its mesh counts as current whatever is changed.
    The file appears only when it is complete.  Raises InputError when it cannot be written.
    """
    find_freecad()
    import Fem  # noqa: F401  registers the document types
    import FreeCAD

    from .femmesh import fill, put
    from .mesh_object import add_mesh, collect, describe, store_options

    filling = fill(mesh)
    document = FreeCAD.newDocument("Mesh", hidden=True, temp=True)
    try:
        if shape is not None:
            part = document.addObject("Part::Feature", "Part")
            part.Shape = shape
            target = add_mesh(part)
            made_from = None
            if options is not None:
                store_options(target, options)
                made_from = collect(target).made_from
            describe(target, mesh, made_from)
        else:
            target = document.addObject("Fem::FemMeshObject", "FEMMesh")
        for _ in put(target, filling):
            pass
        save(document, path)
    finally:
        FreeCAD.closeDocument(document.Name)


def save(document, path):
    """Save under another name in the same folder, then rename."""
    folder = os.path.dirname(os.path.abspath(path))
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".mesh-") as workshop:
            draft = os.path.join(workshop, "mesh.FCStd")
            document.saveAs(draft)
            if not zipfile.is_zipfile(draft):  # of the last that it writes FreeCAD does not notice a failure
                raise incomplete_file()
            os.replace(draft, path)
    except Exception as error:  # FreeCAD raises errors of its own beside OSError
        reason = getattr(error, "strerror", None) or words(error)
        raise InputError("write", "unwritable", "%s: %s" % (path, reason)) from error
