"""The shape of a document object where FreeCAD's FEM module looks for it."""

GLOBAL_SINCE = (1, 0)  # FreeCAD 0.20 and 0.21 search the mesh at the object's own placement


def version():
    """(major, minor) of the running FreeCAD."""
    import FreeCAD

    return tuple(int(number) for number in FreeCAD.Version()[:2])


def shape_to_mesh(item):
    """The shape of `item` at the placement at which this FreeCAD's constraints search the mesh."""
    return global_shape(item) if version() >= GLOBAL_SINCE else item.Shape


def global_shape(item):
    """The shape of `item` where it stands in the document (inside parts with placements)."""
    if not hasattr(item, "getGlobalPlacement") or not hasattr(item, "Placement"):
        return item.Shape
    outer = item.getGlobalPlacement().multiply(item.Placement.inverse())
    if outer.isIdentity():
        return item.Shape
    shape = item.Shape.copy()
    shape.Placement = outer.multiply(shape.Placement)
    return shape
