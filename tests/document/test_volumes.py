"""The mesh of a solid has the solid's volume, or a warning says that it has not."""

from types import SimpleNamespace

import numpy as np
import Part
import pytest
from FreeCAD import Vector

import DelaunayMesher
from DelaunayMesher.volumes import volume_warnings


def crescent(thickness):
    """What is left of a disc of radius 5, its hole so placed that the wall ends at a point."""
    hole = Part.makeCylinder(5 - thickness / 2, 1, Vector(thickness / 2, 0, 0))
    return Part.makeCylinder(5, 1).cut(hole)


@pytest.mark.parametrize("thickness, warned", [(0.002, True), (2.0, False)])
def test_a_mesh_with_another_volume_than_the_solid_is_told(thickness, warned):
    mesh = DelaunayMesher.mesh(crescent(thickness), max_size=3, elements_across=0)
    assert any("the mesh of Solid1 has" in text for text in mesh.warnings) == warned


def test_coarse_facets_are_not_told():
    mesh = DelaunayMesher.mesh(Part.makeSphere(5), max_size=20, elements_per_circle=4)
    assert not [text for text in mesh.warnings if "the mesh of" in text]


def test_the_solid_has_its_number_in_the_part():
    plc = SimpleNamespace(solid_numbers=np.array([3, 7]), volume=lambda number: 10.0 * number)
    result = {"surface_volumes": np.array([10.0, -5.0]), "tet_volumes": np.array([10.2, 17.0])}
    result["statistics"] = {"boundary_replaced": 4.0}
    (warning,) = volume_warnings(plc, result)
    assert "the mesh of Solid7 has 17 mm3, but the solid 20 mm3" in warning
