"""CAD file -> Part shape."""

import os
from contextlib import contextmanager

from ..cadprocess import CAD_ENDINGS, ending_of
from ..errors import InputError
from .find_freecad import find_freecad
from .placement import global_shape

ATTACHMENT = ("Support", "AttachmentSupport")  # up to FreeCAD 0.21, and later


def read_shape(path, warnings=None):
    """Part shape of a .step .stp .iges .igs .brep or .FCStd file; InputError when it cannot be read.

    Of an FCStd file: its only visible solid object, or a compound of several (see solid_objects()). Faces
    without a solid are sewn to solids where they close (sewing.py). warnings: list that takes what was done.
    """
    find_freecad()
    import Part

    from .sewing import with_solids

    path = os.fspath(path)
    if ending_of(path) not in CAD_ENDINGS:
        raise InputError("read", "unknown_format", "%s is no CAD file (%s)" % (path, " ".join(CAD_ENDINGS)))
    if not os.path.isfile(path):
        raise InputError("read", "unreadable", "there is no file %s" % path)
    if ending_of(path) == ".fcstd":
        return shape_of_document(path)
    shape = Part.Shape()
    try:
        shape.read(path)
    except Exception as error:  # FreeCAD raises Part.OCCError, RuntimeError, ... by format
        raise InputError("read", "unreadable", "FreeCAD cannot read %s: %s" % (path, words(error))) from error
    if shape.isNull():
        raise InputError("read", "unreadable", "FreeCAD finds nothing in %s" % path)
    return with_solids(shape, [] if warnings is None else warnings)


def words(error):
    """What an exception says; some of FreeCAD's bring a dict instead of a text."""
    told = error.args[0] if error.args else ""
    return told.get("swhat") or told.get("sErrMsg") if isinstance(told, dict) else str(error)


def shape_of_document(path):
    """The shape of the solids in an FCStd file.  A document that is open already stays open."""
    import FreeCAD

    for document in FreeCAD.listDocuments().values():
        if document.FileName and os.path.realpath(document.FileName) == os.path.realpath(path):
            return shape_of_solids(document)
    with active_document_kept():
        try:
            document = FreeCAD.openDocument(path, True)
        except Exception as error:  # a broken archive raises whatever its first broken part raises
            raise InputError("read", "unreadable", "FreeCAD cannot open %s: %s" % (path, error)) from error
        try:
            return shape_of_solids(document)
        finally:
            FreeCAD.closeDocument(document.Name)


@contextmanager
def active_document_kept():
    """FreeCAD makes a document that it opens the active one, and has none when that is closed."""
    import FreeCAD

    active = FreeCAD.ActiveDocument
    try:
        yield
    finally:
        if active:
            FreeCAD.setActiveDocument(active.Name)


def shape_of_solids(document):
    """A copy of the shape of the document's solid objects; several make a compound."""
    import Part

    objects = solid_objects(document)
    if not objects:
        raise InputError("read", "no_solid", "%s holds no object with a solid" % document.FileName)
    shapes = [global_shape(item).copy() for item in objects]
    return shapes[0] if len(shapes) == 1 else Part.makeCompound(shapes)


def solid_objects(document):
    """Objects with solids that are results: visible, and not used up by another object with a solid."""
    solids = [item for item in document.Objects if has_solid(item)]
    results = [item for item in solids if not any(consumes(user, item) for user in item.InList)]
    visible = [item for item in results if is_shown(item)]
    return visible or results


def has_solid(item):
    """Whether the object has a shape of its own with a solid in it (groups show their members' shapes)."""
    if item.hasExtension("App::GroupExtension") and not item.isDerivedFrom("PartDesign::Body"):
        return False
    shape = getattr(item, "Shape", None)
    return hasattr(shape, "Solids") and not shape.isNull() and bool(shape.Solids)


def is_shown(item):
    """Whether the object and the parts that contain it are visible."""
    parent = item.getParentGeoFeatureGroup()
    return getattr(item, "Visibility", True) and (parent is None or is_shown(parent))


def consumes(user, item):
    """Whether `user` is built from `item`: a cut from its tool, a body from its features, an array of links
    from its elements.  A place (attachment) or a number (expression) that comes from there uses nothing up.
    """
    if user.TypeId == "App::Link":
        return item in user.ElementList
    if user.isDerivedFrom("App::LinkElement") or not has_solid(user):
        return False
    links = (name for name in user.PropertiesList if "Link" in user.getTypeIdOfProperty(name))
    return any(refers(getattr(user, name), item) for name in links if name not in ATTACHMENT)


def refers(value, item):
    """Whether the value of a link property has the object in it."""
    if isinstance(value, (list, tuple)):
        return any(refers(part, item) for part in value)
    return value == item
