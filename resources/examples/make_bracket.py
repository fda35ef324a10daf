"""Builds the example part, a mounting bracket, and saves it as bracket.FCStd, bracket.step and bracket.stl
beside this file.

    freecadcmd resources/examples/make_bracket.py

A base plate with four bolt holes, an upright plate with a bearing bore in a boss, a rib between them, and
fillets where they meet: 110 x 70 x 87 mm, no dihedral angle under 60 degrees.
"""

import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(os.path.dirname(HERE)))

from DelaunayMesher.document import find_freecad  # noqa: E402

find_freecad()
import FreeCAD  # noqa: E402
import MeshPart  # noqa: E402
import Part  # noqa: E402
from FreeCAD import Vector  # noqa: E402

LENGTH, WIDTH, BASE, WALL = 110.0, 70.0, 12.0, 14.0
BORE, BOSS, BOSS_LENGTH, BORE_HEIGHT = 13.0, 22.0, 22.0, 52.0
RIB, TOE, FILLET, ROUND = 14.0, 90.0, 4.0, 12.0


def box(x, y, z, corner):
    return Part.makeBox(x, y, z, Vector(*corner))


def base_plate():
    """Lies in z = 0 .. BASE, its free corners rounded, four through holes in it."""
    plate = box(LENGTH, WIDTH, BASE, (0, 0, 0))
    plate = plate.makeFillet(ROUND, edges_along(plate, Vector(0, 0, 1), lambda p: p.x > LENGTH - 1))
    for x in (38.0, LENGTH - 14.0):
        for y in (14.0, WIDTH - 14.0):
            plate = plate.cut(Part.makeCylinder(4.5, BASE, Vector(x, y, 0)))
    return plate


def upright():
    """Stands in x = 0 .. WALL, its top an arc round the bore, which has a boss on the rib's side."""
    centre = Vector(0, WIDTH / 2, BORE_HEIGHT)
    plate = box(WALL, WIDTH, BORE_HEIGHT, (0, 0, 0)).fuse(
        Part.makeCylinder(WIDTH / 2, WALL, centre, Vector(1, 0, 0))
    )
    boss = Part.makeCylinder(BOSS, BOSS_LENGTH, centre, Vector(1, 0, 0))
    return plate.fuse(boss).cut(Part.makeCylinder(BORE, BOSS_LENGTH, centre, Vector(1, 0, 0)))


def rib():
    """Slopes from the boss down to a rounded toe on the base plate."""
    corners = [(WALL - 2, BASE - 2), (TOE, BASE - 2), (TOE, BASE + 8), (WALL - 2, BASE + 25)]
    points = [Vector(x, (WIDTH - RIB) / 2, z) for x, z in corners]
    plate = Part.Face(Part.makePolygon([*points, points[0]])).extrude(Vector(0, RIB, 0))
    return plate.makeFillet(RIB / 2 - 2, edges_along(plate, Vector(0, 0, 1), lambda p: p.x > TOE - 1))


def rib_foot(part):
    """The edges where the rib stands on the base plate, round its toe."""
    foot = []
    for edge in part.Edges:
        bounds = edge.BoundBox
        level = abs(bounds.ZMin - BASE) < 1e-6 and abs(bounds.ZMax - BASE) < 1e-6
        near = abs(bounds.Center.y - WIDTH / 2) < RIB / 2 + 1e-6 and bounds.YLength < RIB + 1e-6
        if level and near and WALL - 1e-6 < bounds.XMin and bounds.XMax < TOE + 1e-6 and bounds.XLength > 1:
            foot.append(edge)
    return foot


def edges_along(shape, direction, where):
    """Straight edges parallel to a direction whose middle satisfies `where`."""
    found = []
    for edge in shape.Edges:
        start, end = edge.Vertexes[0].Point, edge.Vertexes[-1].Point
        if (
            isinstance(edge.Curve, Part.Line)
            and (end - start).cross(direction).Length < 1e-6
            and where((start + end) / 2)
        ):
            found.append(edge)
    return found


def bracket():
    """The whole part as one solid."""
    part = base_plate().fuse([upright(), rib()]).removeSplitter()
    inner = edges_along(part, Vector(0, 1, 0), lambda p: abs(p.x - WALL) < 1e-6 and abs(p.z - BASE) < 1e-6)
    part = part.makeFillet(FILLET, inner + rib_foot(part))
    solid = part.Solids[0]
    if len(part.Solids) != 1 or not solid.isValid():
        raise RuntimeError("the bracket is not one valid solid")
    return solid


def sharpest_edge(solid):
    """Smallest angle inside the material between two faces, in degrees."""
    return min(angle_at(solid, edge) for edge in solid.Edges if not edge.Degenerated)


def angle_at(solid, edge):
    faces = [face for face in solid.Faces if any(edge.isSame(other) for other in face.Edges)]
    if len(faces) != 2:
        return 180.0
    middle = edge.valueAt(sum(edge.ParameterRange) / 2)
    normals = [face.normalAt(*face.Surface.parameter(middle)) for face in faces]
    between = math.degrees(math.acos(max(-1.0, min(1.0, normals[0].dot(normals[1])))))
    inside = (
        solid.isInside(middle - (normals[0] + normals[1]).multiply(1e-3), 1e-7, False)
        if between < 179
        else True
    )
    return 180.0 - between if inside else 180.0 + between


def main():
    solid = bracket()
    document = FreeCAD.newDocument("bracket")
    part = document.addObject("Part::Feature", "Bracket")
    part.Shape = solid
    document.recompute()
    document.saveAs(os.path.join(HERE, "bracket.FCStd"))
    step = os.path.join(HERE, "bracket.step")
    solid.exportStep(step)
    if not Part.read(step).isValid():
        raise RuntimeError("the bracket does not survive STEP")
    surface = MeshPart.meshFromShape(Shape=solid.copy(), LinearDeflection=0.1, AngularDeflection=0.3)
    surface.write(os.path.join(HERE, "bracket.stl"))
    print(
        "bracket: %d faces, %.0f mm3, sharpest edge %.0f degrees"
        % (len(solid.Faces), solid.Volume, sharpest_edge(solid))
    )


main()
