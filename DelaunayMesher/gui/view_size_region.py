"""How a size region looks: a transparent sphere, box or cylinder in the view.

The class has to stay at the top of this module: saved documents find it by its name.
"""

import FreeCAD
import FreeCADGui

from ..document.stateless import Stateless
from .texts import icon

COLOUR = (1.0, 0.55, 0.0)
TRANSPARENCY = 0.75
MODE = "Shaded"
THINNEST = 1e-6  # mm; the shapes of the view must not be flat


class VPSizeRegion(Stateless):
    """View provider proxy: the shape in the view, a panel on double click."""

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        from pivy import coin

        self.ViewObject, self.Object = view, view.Object
        self.place, self.shapes = coin.SoTransform(), coin.SoSwitch()
        self.sphere, self.box, self.cylinder = coin.SoSphere(), coin.SoCube(), coin.SoCylinder()
        for shape in (self.sphere, self.box, self.cylinder):
            self.shapes.addChild(shape)
        material = coin.SoMaterial()
        material.diffuseColor, material.transparency = COLOUR, TRANSPARENCY
        pick = coin.SoPickStyle()
        pick.style = coin.SoPickStyle.UNPICKABLE  # what is inside can still be selected
        root = coin.SoSeparator()
        for node in (pick, material, self.place, self.shapes):
            root.addChild(node)
        view.addDisplayMode(root, MODE)
        self.draw(view.Object)

    def getDisplayModes(self, view):
        return [MODE]

    def getDefaultDisplayMode(self):
        return MODE

    def setDisplayMode(self, mode):
        return mode

    def getIcon(self):
        return icon("size_region")

    def updateData(self, target, name):
        self.draw(target)

    def onChanged(self, view, name):
        """Nothing follows from view properties."""

    def draw(self, target):
        """Make the view agree with the object's properties."""
        if not hasattr(target, "Transition") or not hasattr(self, "shapes"):
            return  # not complete yet
        start, end = target.Point, target.SecondPoint
        middle, turn = (start + end) * 0.5, FreeCAD.Rotation()
        radius = max(target.Radius.Value, THINNEST)
        if target.Kind == "Sphere":
            middle, self.sphere.radius = start, radius
        elif target.Kind == "Box":
            for name, length in zip(("width", "height", "depth"), end - start):
                getattr(self.box, name).setValue(max(abs(length), THINNEST))
        else:
            turn = FreeCAD.Rotation(FreeCAD.Vector(0, 1, 0), end - start)  # the view's cylinders lie along y
            self.cylinder.radius = radius
            self.cylinder.height = max((end - start).Length, THINNEST)
        self.place.translation.setValue(*middle)
        self.place.rotation.setValue(*turn.Q)
        self.shapes.whichChild = ("Sphere", "Box", "Cylinder").index(target.Kind)

    def setEdit(self, view, mode=0):
        from . import task_size_region

        if mode != 0:
            return None
        FreeCADGui.Control.showDialog(task_size_region.SizeRegionPanel(view.Object))
        return True

    def unsetEdit(self, view, mode=0):
        FreeCADGui.Control.closeDialog()
        return True

    def doubleClicked(self, view):
        from . import start_mesh

        if not start_mesh.panel_is_open():
            FreeCADGui.getDocument(view.Object.Document.Name).setEdit(view.Object.Name)
        return True
