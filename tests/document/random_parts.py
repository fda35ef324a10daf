"""Random parts as people draw them: a body, then cuts, fusions, fillets and chamfers at random places.

A part is a function of its number alone, but OpenCASCADE's versions do not all make the same of it. What OCC
refuses to make is left out, so a part may have fewer features than it was to have.
"""

import math
import random

import Part
from FreeCAD import Vector

AXES = (Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1))
OCC_FAILS = (RuntimeError, ValueError, Part.OCCError)


def random_part(number):
    """A valid closed solid, or a compound of some."""
    draw = random.Random(number)
    part = draw.choice(BODIES)(draw)
    for _ in range(draw.randint(1, 5)):
        try:
            changed = draw.choice(FEATURES)(draw, part.copy())
        except OCC_FAILS:
            continue
        if is_sound(changed):
            part = changed
    return part


def is_sound(part):
    """Valid and closed solids."""
    if part is None or part.isNull() or not part.Solids or not part.isValid():
        return False
    return part.Volume > 1e-3 and all(shell.isClosed() for shell in part.Shells)


def outline(draw, size):
    """Corners of a star-shaped polygon round the origin."""
    count = draw.randint(4, 9)
    corners = []
    for step in range(count):
        angle = 2 * math.pi * (step + draw.uniform(-0.25, 0.25)) / count
        radius = size * draw.uniform(0.6, 1)
        corners.append(Vector(radius * math.cos(angle), radius * math.sin(angle), 0))
    return corners


def closed_spline(draw, size):
    curve = Part.BSplineCurve()
    curve.interpolate(outline(draw, size), PeriodicFlag=True)
    return Part.Wire(curve.toShape())


def box(draw):
    return Part.makeBox(draw.uniform(8, 40), draw.uniform(8, 40), draw.uniform(3, 20))


def cylinder(draw):
    return Part.makeCylinder(draw.uniform(4, 15), draw.uniform(5, 40))


def cone(draw):
    return Part.makeCone(draw.uniform(4, 15), draw.choice([0, draw.uniform(1, 10)]), draw.uniform(8, 30))


def torus(draw):
    return Part.makeTorus(draw.uniform(10, 15), draw.uniform(2, 6))


def prism(draw):
    corners = outline(draw, 20)
    return Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(Vector(0, 0, draw.uniform(4, 20)))


def spline_prism(draw):
    return Part.Face(closed_spline(draw, 20)).extrude(Vector(0, 0, draw.uniform(4, 20)))


def turned(draw):
    height, radius = 0.0, draw.uniform(4, 12)
    profile = [Vector(0, 0, 0), Vector(radius, 0, 0)]
    for _ in range(draw.randint(2, 5)):
        height += draw.uniform(2, 6)
        profile.append(Vector(radius, 0, height))
        radius = draw.uniform(4, 14)
        profile.append(Vector(radius, 0, height))
    profile += [Vector(radius, 0, height + 3), Vector(0, 0, height + 3), profile[0]]
    return Part.Face(Part.makePolygon(profile)).revolve(Vector(0, 0, 0), AXES[2], draw.choice([360, 270, 90]))


def loft(draw):
    sections = []
    for level in range(draw.randint(2, 4)):
        section = closed_spline(draw, draw.uniform(7, 13))
        section.translate(Vector(draw.uniform(-2, 2), draw.uniform(-2, 2), 10 * level))
        sections.append(section)
    return Part.makeLoft(sections, True)


def spring(draw):
    radius = draw.uniform(6, 10)
    helix = Part.makeHelix(draw.uniform(4, 6), draw.uniform(6, 15), radius)
    wire = Part.makeCircle(draw.uniform(0.6, 1.3), Vector(radius, 0, 0), AXES[1])
    return Part.Wire(helix.Edges).makePipeShell([Part.Wire([wire])], True, True)


def gear(draw):
    count, corners = draw.randint(8, 20), []
    for tooth in range(count):
        for place, radius in ((0, 12), (0.3, 15), (0.5, 15), (0.8, 12)):
            angle = 2 * math.pi * (tooth + place) / count
            corners.append(Vector(radius * math.cos(angle), radius * math.sin(angle), 0))
    return Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(Vector(0, 0, draw.uniform(3, 10)))


def tool(draw, part):
    """A hole, a ball or a block somewhere in a part."""
    bounds = part.BoundBox
    low, size = bounds.getPoint(0), bounds.DiagonalLength
    place = low + Vector(
        draw.random() * bounds.XLength, draw.random() * bounds.YLength, draw.random() * bounds.ZLength
    )
    kind = draw.randint(0, 2)
    if kind == 0:
        axis = draw.choice(AXES)
        return Part.makeCylinder(size * draw.uniform(0.03, 0.12), 2 * size, place - axis * size, axis)
    if kind == 1:
        return Part.makeSphere(size * draw.uniform(0.07, 0.2), place)
    sides = [size * draw.uniform(0.08, 0.3) for _ in range(3)]
    return Part.makeBox(*sides, place)


def cut(draw, part):
    return part.cut(tool(draw, part))


def fused(draw, part):
    whole = part.fuse(tool(draw, part))
    return whole.removeSplitter() if draw.random() < 0.5 else whole


def with_edges(draw, part, change):
    edges = [edge for edge in part.Edges if not edge.Degenerated and edge.Length > 1]
    chosen = draw.sample(edges, min(len(edges), draw.choice([1, 2, 4])))
    largest = min(0.1 * part.BoundBox.DiagonalLength, *(edge.Length for edge in chosen))
    return change(largest * draw.choice([0.1, 0.2, 0.4]), chosen)


def filleted(draw, part):
    return with_edges(draw, part, part.makeFillet)


def chamfered(draw, part):
    return with_edges(draw, part, part.makeChamfer)


BODIES = (box, cylinder, cone, torus, prism, spline_prism, turned, loft, spring, gear)
FEATURES = (cut, cut, fused, filleted, chamfered)
