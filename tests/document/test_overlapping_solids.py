"""Solids that have volume in common are named in a warning, and those that merely touch are not."""

import Part
import pytest
from FreeCAD import Vector

from DelaunayMesher.document.plc_from_shape import convert
from DelaunayMesher.options import MeshOptions


@pytest.mark.parametrize(
    "other, warned",
    [
        (Part.makeBox(10, 10, 10, Vector(5, 5, 5)), True),  # passes only through edges of the triangles
        (Part.makeBox(4, 4, 4, Vector(3, 3, 3)), True),  # inside
        (Part.makeSphere(3, Vector(5, 5, 5)), True),
        (Part.makeBox(10, 10, 10, Vector(9.999, 2, 2)), False),  # no deeper than solids that touch may be
        (Part.makeBox(10, 10, 10, Vector(10.5, 2, 2)), False),
    ],
)
def test_solids_that_lie_in_each_other_are_named(other, warned):
    warnings = convert(Part.makeCompound([Part.makeBox(10, 10, 10), other])).plc.warnings
    assert (
        any("solids lie in each other" in text and "Solid1 and Solid2" in text for text in warnings) == warned
    )


@pytest.mark.parametrize(
    "other, told",
    [
        (Part.makeBox(10, 10, 10), "solids are the same"),
        (Part.makeBox(10, 10, 10, Vector(0, 0, 0.01)), "solids lie in each other"),
        (Part.makeBox(10, 10, 5), "solids lie in each other"),
        (Part.makeBox(10, 10, 10, Vector(5, 0, 0)), "solids lie in each other"),
    ],
)
def test_solids_whose_faces_lie_on_each_other_are_named_once(other, told):
    far = Part.makeBox(1000, 1, 1, Vector(0, 50, 0))  # what counts as deep does not depend on the others
    warnings = convert(Part.makeCompound([far, Part.makeBox(10, 10, 10), other])).plc.warnings
    assert len(warnings) == 1 and told in warnings[0] and "Solid2 and Solid3" in warnings[0]


def in_hole(tool, cut):
    return Part.makeCompound([Part.makeBox(20, 20, 5).cut(cut), tool])


@pytest.mark.parametrize(
    "shape",
    [
        Part.makeCompound([Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, Vector(10, 3, 4))]),
        Part.makeCompound([Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, Vector(10, 0, 0))]),
        in_hole(Part.makeCylinder(3, 9, Vector(10, 10, 0)), Part.makeCylinder(3, 9, Vector(10, 10, 0))),
        in_hole(
            Part.makeCylinder(3, 9, Vector(10, 10, -2), Vector(0, 0, 1), 360).rotated(
                Vector(10, 10, 0), Vector(0, 0, 1), 11
            ),
            Part.makeCylinder(3, 9, Vector(10, 10, 0)),
        ),
        in_hole(Part.makeCylinder(3, 9, Vector(10, 10, 0)), Part.makeBox(6, 6, 9, Vector(7, 7, 0))),
        Part.makeCompound([Part.makeSphere(5), Part.makeSphere(5, Vector(10, 0, 0))]),
        Part.makeCompound(
            [Part.makeBox(20, 20, 5), Part.makeCylinder(3, 9, Vector(10, 10, 8), Vector(1, 0, 0))]
        ),
    ],
    ids=["boxes", "boxes with one face", "bolt", "turned bolt", "square hole", "balls", "roller"],
)
def test_solids_that_merely_touch_do_not_lie_in_each_other(shape):
    for size in (1.0, 5.0):
        warnings = convert(shape, MeshOptions(max_size=size)).plc.warnings
        assert not any("lie in each other" in text or "the same" in text for text in warnings)
