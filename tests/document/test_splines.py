"""Splines of FreeCAD as records: the same points, however OCC writes their ends."""

import math

import numpy as np
import Part
import pytest
from FreeCAD import Vector
from scipy.interpolate import BSpline

from DelaunayMesher.document.splines import curve_record, surface_record


def test_a_face_that_straddles_the_ends_of_a_closed_surface_gets_all_of_it():
    """Fillets make such faces, on surfaces that close but are not periodic."""
    surface = Part.makeCylinder(5, 10).toNurbs().Faces[0].Surface
    surface.setUNotPeriodic()
    u0, u1, v0, v1 = surface.bounds()
    turn = u1 - u0
    assert surface_record(surface, (u0 - 0.1 * turn, u0 + 0.2 * turn, v0, v1))["range"][:2] == (u0, u1)
    inside = (u0 + 0.1 * turn, u0 + 0.2 * turn)
    assert surface_record(surface, (*inside, v0, v1))["range"][:2] == inside


@pytest.mark.parametrize("short", [0.0, 1e-15, 3e-16, 1e-12])
def test_a_closed_spline_edge_that_ends_a_hair_before_the_period(short):
    """OCC's segment() gives another curve then; files round the ends of edges."""
    points = [Vector(9 * math.cos(t), 6 * math.sin(2 * t) + t, 0) for t in (0, 1, 2, 2.7, 4, 5, 5.5)]
    curve = Part.BSplineCurve()
    curve.interpolate(Points=points, PeriodicFlag=True)
    start, end = curve.FirstParameter, curve.LastParameter
    record = curve_record(curve, start, end - short * (end - start))
    spline = BSpline(record["knots"], record["poles"], record["degree"])
    for place in np.linspace(start, end, 60):
        assert (curve.value(place) - Vector(*spline(place))).Length < 1e-9
