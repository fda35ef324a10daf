"""The parts that the tests mesh, by name; and where the example part lies."""

import math
import os

import Part
from FreeCAD import Vector

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BRACKET = os.path.join(ROOT, "resources", "examples", "bracket.step")


def lofted():
    """A solid between three closed B-spline sections."""

    def section(z, a, b):
        steps = [2 * math.pi * k / 12 for k in range(12)]
        points = [Vector(a * math.cos(t), b * math.sin(t) * (1 + 0.1 * math.cos(3 * t)), z) for t in steps]
        curve = Part.BSplineCurve()
        curve.interpolate(Points=points, PeriodicFlag=True)
        return Part.Wire(curve.toShape())

    return Part.makeLoft([section(0, 20, 14), section(15, 14, 14), section(35, 18, 10)], True)


def blade(length=60.0, chord=24.0, thickness=7.0, twist=30.0):
    """A twisted blade: B-spline sections with round leading and trailing edges, lofted."""
    sections = []
    for share in (0.0, 0.5, 1.0):
        turn, scale = math.radians(twist * share), 1 - 0.35 * share
        points = []
        for step in range(24):
            angle = 2 * math.pi * step / 24
            x = scale * chord / 2 * math.cos(angle)
            camber = 0.06 * scale * chord * (1 - (2 * x / (scale * chord)) ** 2)
            y = scale * thickness / 2 * math.sin(angle) * (1 + 0.25 * math.cos(angle)) + camber
            points.append(
                Vector(
                    x * math.cos(turn) - y * math.sin(turn),
                    x * math.sin(turn) + y * math.cos(turn),
                    length * share,
                )
            )
        curve = Part.BSplineCurve()
        curve.interpolate(Points=points, PeriodicFlag=True)
        sections.append(Part.Wire(curve.toShape()))
    return Part.makeLoft(sections, True).Solids[0]


def plate_with_holes(count=7):
    """A plate with count * count holes."""
    plate = Part.makeBox(100, 100, 10)
    holes = [
        Part.makeCylinder(3 + 0.1 * i, 10, Vector(8 + 14 * i, 8 + 14 * j, 0))
        for i in range(count)
        for j in range(count)
    ]
    return plate.cut(Part.makeCompound(holes)).removeSplitter().Solids[0]


def bracket():
    return Part.read(BRACKET)


PARTS = {
    "bracket": bracket,
    "box": lambda: Part.makeBox(30, 20, 10),
    "cylinder": lambda: Part.makeCylinder(5, 20),
    "sphere": lambda: Part.makeSphere(10),
    "torus": lambda: Part.makeTorus(20, 6),
    "cone_frustum": lambda: Part.makeCone(10, 5, 15),
    "lofted": lofted,
    "plate": plate_with_holes,
}

# Sizes at which a mesh is made in a second or two.
SIZES = {
    "bracket": 12.0,
    "box": 4.0,
    "cylinder": 2.5,
    "sphere": 4.0,
    "torus": 4.0,
    "cone_frustum": 3.0,
    "lofted": 5.0,
    "plate": 12.0,
}
