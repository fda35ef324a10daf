"""Narrow torus faces are filled from their outline."""

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from DelaunayMesher.document.closed import solid_volumes
from DelaunayMesher.document.plc_from_shape import convert
from DelaunayMesher.document.strips import is_narrow


@pytest.mark.parametrize("reversed_strip", [False, True])
def test_a_part_with_a_narrow_torus_face_closes(reversed_strip):
    torus = Part.makeTorus(100, 30, Vector(0, 0, 0), Vector(0, 0, 1), 0, 360, 170)
    slab = Part.makeBox(400, 400, 0.5, Vector(-200, -200, 0))
    part = slab.cut(torus) if reversed_strip else slab.common(torus)
    assert any(is_narrow(face, face.Surface) for face in part.Faces)
    plc = convert(part).plc
    sides = plc.face_solids[plc.triangle_face]
    volumes = solid_volumes(plc.points, plc.triangles, sides, plc.solid_count)
    assert np.abs(volumes).sum() == pytest.approx(part.Volume, rel=0.02)
    for number, face in enumerate(part.Faces):
        if is_narrow(face, face.Surface):
            assert (plc.triangle_face == number).any()
            counted = len(np.unique(plc.triangles[plc.triangle_face == number]))
            assert (plc.triangle_face == number).sum() == counted - 2  # no node inside
