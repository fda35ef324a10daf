"""CAD file -> Part shape."""

import os

from ..errors import InputError
from .find_freecad import find_freecad
from .placement import global_shape

CAD_SUFFIXES = (".step", ".stp", ".iges", ".igs", ".brep", ".brp", ".fcstd")


def read_shape(path):
    """Part shape of a .step .stp .iges .igs .brep or .FCStd file; InputError when it cannot be read.

    Of an FCStd file: its only visible solid object, or a compound of several (see solid_objects()).
    """
    find_freecad()
    import Part

    path = os.fspath(path)
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in CAD_SUFFIXES:
        raise InputError("plc", "unknown_format", "%s is no CAD file (%s)" % (path, " ".join(CAD_SUFFIXES)))
    if not os.path.isfile(path):
        raise InputError("plc", "unreadable", "there is no file %s" % path)
    if suffix == ".fcstd":
        return shape_of_document(path)
    shape = Part.Shape()
    try:
        shape.read(path)
    except Exception as error:  # FreeCAD raises Part.OCCError, RuntimeError, ... by format
        raise InputError("plc", "unreadable", "FreeCAD cannot read %s: %s" % (path, error)) from error
    if shape.isNull():
        raise InputError("plc", "unreadable", "FreeCAD finds nothing in %s" % path)
    return shape


def shape_of_document(path):
    """The shape of the solids in an FCStd file; the document is closed again."""
    import FreeCAD
    import Part

    try:
        document = FreeCAD.openDocument(path, True)
    except Exception as error:  # a broken archive raises whatever its first broken part raises
        raise InputError("plc", "unreadable", "FreeCAD cannot open %s: %s" % (path, error)) from error
    try:
        objects = solid_objects(document)
        if not objects:
            raise InputError("plc", "no_solid", "%s holds no object with a solid" % path)
        shapes = [global_shape(item) for item in objects]
        return shapes[0].copy() if len(shapes) == 1 else Part.makeCompound([shape.copy() for shape in shapes])
    finally:
        FreeCAD.closeDocument(document.Name)


def solid_objects(document):
    """Objects with solids that are results: visible, and not used up by another object with a solid."""
    solids = [item for item in document.Objects if has_solid(item)]
    results = [item for item in solids if not any(consumes(user, item) for user in item.InList)]
    visible = [item for item in results if getattr(item, "Visibility", True)]
    return visible or results


def has_solid(item):
    """Whether the object has a shape of its own with a solid in it (groups show their members' shapes)."""
    if item.hasExtension("App::GroupExtension") and not item.isDerivedFrom("PartDesign::Body"):
        return False
    shape = getattr(item, "Shape", None)
    return hasattr(shape, "Solids") and not shape.isNull() and bool(shape.Solids)


def consumes(user, item):
    """Whether `user` is built from `item`: a cut from its tool, a body from its features."""
    if user.isDerivedFrom("App::LinkElement") or user.TypeId == "App::Link":
        return False
    return has_solid(user)
