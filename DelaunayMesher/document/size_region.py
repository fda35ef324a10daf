"""A size inside a sphere, box or cylinder, as a document object below the mesh object.

FreeCAD's own refinements tie sizes to faces, edges and solids; this one is for places inside a part, or on a
face of which only a piece is to be finer.  Points are in the coordinates of the mesh.
"""

import FreeCAD

from ..errors import InputError
from ..sizing import Region
from .stateless import Stateless

KINDS = {"Sphere": "ball", "Box": "box", "Cylinder": "cylinder"}
PROPERTIES = (  # name, type, help
    ("Kind", "App::PropertyEnumeration", "Where the size holds: inside a sphere, a box or a cylinder"),
    ("Point", "App::PropertyVectorDistance", "Centre of the sphere, corner of the box, start of the axis"),
    ("SecondPoint", "App::PropertyVectorDistance", "Opposite corner of the box, end of the axis"),
    ("Radius", "App::PropertyLength", "Radius of the sphere or cylinder"),
    ("Size", "App::PropertyLength", "Largest edge length of the elements inside"),
    (
        "Transition",
        "App::PropertyLength",
        "Length outside over which the size grows to the one around; 0: by the growth rate of the mesh",
    ),
)
USED = {  # properties that mean something
    "Sphere": ("Point", "Radius"),
    "Box": ("Point", "SecondPoint"),
    "Cylinder": ("Point", "SecondPoint", "Radius"),
}


class SizeRegion(Stateless):
    """Proxy of the document object."""

    Type = "Fem::MeshSizeRegion"

    def __init__(self, target):
        target.Proxy = self
        for name, kind, text in PROPERTIES:
            target.addProperty(kind, name, "Size region", text)
        target.Kind = list(KINDS)

    def onDocumentRestored(self, target):
        """Documents made without a window get the view they lack."""
        if FreeCAD.GuiUp:
            from ..gui import missing_view, view_size_region

            missing_view.complete(target, view_size_region.VPSizeRegion)

    def onChanged(self, target, name):
        """Only what the kind needs is shown."""
        if name == "Kind" and hasattr(target, "Radius"):
            for other in ("Point", "SecondPoint", "Radius"):
                target.setEditorMode(other, 0 if other in USED[target.Kind] else 2)

    def execute(self, target):
        """Nothing is computed: the mesher asks for region_of()."""


def add_size_region(mesh, region, name="SizeRegion"):
    """A new size region (document object) on a mesh object, from a sizing.Region.  Raises InputError."""
    region.check()
    target = mesh.Document.addObject("Fem::FeaturePython", name)
    SizeRegion(target)
    target.Kind = next(kind for kind, name in KINDS.items() if name == region.kind)
    target.Point, target.SecondPoint = FreeCAD.Vector(*region.a), FreeCAD.Vector(*region.b)
    target.Radius, target.Size, target.Transition = region.radius, region.size, region.transition
    if FreeCAD.GuiUp:
        from ..gui import view_size_region

        view_size_region.VPSizeRegion(target.ViewObject)
    mesh.SizeRegionList = [*mesh.SizeRegionList, target]
    return target


def region_of(target):
    """The sizing.Region of a size region; InputError when a number makes no sense."""
    region = Region(
        KINDS[target.Kind],
        tuple(target.Point),
        tuple(target.SecondPoint),
        target.Radius.Value,
        target.Size.Value,
        target.Transition.Value,
    )
    try:
        region.check()
    except InputError as error:
        text = "%s: %s" % (target.Label, error.message)
        raise InputError(error.stage, error.code, text, entity=target.Name) from None
    return region


def regions_of(mesh):
    """The sizing.Regions of a mesh object."""
    return [region_of(item) for item in mesh.SizeRegionList]
