"""The shape of a document object where FreeCAD's FEM module looks for it."""

import numpy as np

from ..surfacefile import Surface

GLOBAL_SINCE = (1, 0)  # FreeCAD 0.20 and 0.21 search the mesh at the object's own placement


def version():
    """(major, minor) of the running FreeCAD."""
    import FreeCAD

    return tuple(int(number) for number in FreeCAD.Version()[:2])


def shape_to_mesh(item):
    """The shape of `item` at the placement at which this FreeCAD's constraints search the mesh."""
    if version() >= GLOBAL_SINCE:
        return global_shape(item)
    shape = own_shape(item)
    if shape is None or not item.isDerivedFrom("App::Part"):
        return shape
    shape = shape.copy()
    shape.Placement = item.Placement.inverse().multiply(shape.Placement)
    return shape


def source_of(item):
    """What is meshed of a document object: the shape of shape_to_mesh(), or the Surface of a mesh of
    triangles; None where there is nothing.
    """
    if is_surface(item):
        return surface_to_mesh(item)
    shape = shape_to_mesh(item)
    return shape if shape is not None and shape.Vertexes else None


def is_surface(item):
    """Whether `item` is a document object with a mesh of triangles, an opened STL file for instance."""
    return hasattr(item, "isDerivedFrom") and item.isDerivedFrom("Mesh::Feature")


def surface_to_mesh(item):
    """The Surface of a mesh of triangles, placed as by shape_to_mesh(); None without triangles."""
    mesh = item.Mesh
    if version() >= GLOBAL_SINCE:
        mesh = mesh.copy()
        mesh.Placement = item.getGlobalPlacement()
    points, triangles = mesh.Topology
    return Surface(np.array([tuple(point) for point in points]), np.array(triangles)) if triangles else None


def mesh_frame(item):
    """The placement from the coordinates of the mesh of `item` to those of the document.

    Before 1.0 FreeCAD searches the mesh at the placement that the parts of a container have in it.
    """
    import FreeCAD

    if version() >= GLOBAL_SINCE:
        return FreeCAD.Placement()
    if item.isDerivedFrom("App::Part"):
        return item.getGlobalPlacement()
    return outer_placement(item) or FreeCAD.Placement()


def own_shape(item):
    """The shape of `item` with its own placement (for a container of parts, of what it contains), or None."""
    import Part

    shape = getattr(item, "Shape", None)
    if shape is None and hasattr(item, "TypeId"):
        found = Part.getShape(item)
        shape = None if found.isNull() else found
    return shape if isinstance(shape, Part.Shape) else None


def global_shape(item):
    """The shape of `item` where it stands in the document (inside parts with placements), or None."""
    shape, outer = own_shape(item), outer_placement(item)
    if shape is None or outer is None or outer.isIdentity():
        return shape
    shape = shape.copy()
    shape.Placement = outer.multiply(shape.Placement)
    return shape


def placement_in_mesh(item, part):
    """The placement that takes the shape of `item` to where it lies in shape_to_mesh(part)."""
    import FreeCAD

    outer = outer_placement(item) or FreeCAD.Placement()
    return mesh_frame(part).inverse().multiply(outer)


def outer_placement(item):
    """What the parts around `item` do to its shape; None where FreeCAD does not know."""
    if hasattr(item, "getGlobalPlacement") and hasattr(item, "Placement"):
        return item.getGlobalPlacement().multiply(item.Placement.inverse())
    group = item.getParentGeoFeatureGroup()  # links have no global placement of their own
    return group.getGlobalPlacement() if group else None
