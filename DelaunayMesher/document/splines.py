"""B-spline surfaces and curves of FreeCAD as the dicts of arrays that the core takes.

Always non-periodic, with flat knots (every knot repeated by its multiplicity); weights None = polynomial.
"""

import itertools

import numpy as np

from .tessellation import vectors_to_array

WHOLE = 1e-9  # of a period
SAME = 1e-9  # of the distance from the origin
SAMPLES = 24


def flat_knots(knots, multiplicities):
    """Knots repeated by their multiplicities."""
    return np.repeat(np.asarray(knots, dtype=np.float64), np.asarray(multiplicities, dtype=np.int64))


def surface_record(surface, ranges):
    """dict of a Part.BSplineSurface; `ranges` (u0, u1, v0, v1) is the part of it that the face uses."""
    ranges = list(ranges)
    surface = surface.copy()
    for first, periodic, make in (
        (0, "isUPeriodic", "setUNotPeriodic"),
        (2, "isVPeriodic", "setVNotPeriodic"),
    ):
        if getattr(surface, periodic)():
            getattr(surface, make)()
            ranges[first : first + 2] = surface.bounds()[first : first + 2]  # the face may straddle the seam
    poles = surface.getPoles()
    nu, nv = len(poles), len(poles[0])
    rational = surface.isURational() or surface.isVRational()
    bounds = surface.bounds()
    for first in (0, 2):
        low, high = bounds[first : first + 2]
        beyond = max(low - ranges[first], ranges[first + 1] - high)
        if beyond > WHOLE * (high - low):  # a closed surface, and the face straddles its ends
            ranges[first : first + 2] = low, high
        ranges[first] = max(ranges[first], low)
        ranges[first + 1] = min(ranges[first + 1], high)
    return {
        "degree_u": surface.UDegree,
        "degree_v": surface.VDegree,
        "poles": vectors_to_array(itertools.chain.from_iterable(poles), nu * nv).reshape(nu, nv, 3),
        "weights": np.array(surface.getWeights(), dtype=np.float64) if rational else None,
        "knots_u": flat_knots(surface.getUKnots(), surface.getUMultiplicities()),
        "knots_v": flat_knots(surface.getVKnots(), surface.getVMultiplicities()),
        "range": tuple(float(x) for x in ranges),
    }


def curve_record(curve, first, last):
    """dict of the part [first, last] of a Part.BSplineCurve, or None if OCC cannot cut it out."""
    given, curve = curve, curve.copy()
    if curve.isPeriodic():
        start, end = curve.FirstParameter, curve.LastParameter
        if last - first > (1.0 - WHOLE) * (end - start):
            first, last = start, end  # asked for a hair less than the period, OCC gives a wrong curve
        curve.segment(first, last)
        first, last = curve.FirstParameter, curve.LastParameter
        if not same_points(given, curve):
            return None
    return {
        "degree": curve.Degree,
        "poles": vectors_to_array(curve.getPoles(), curve.NbPoles),
        "weights": np.array(curve.getWeights(), dtype=np.float64) if curve.isRational() else None,
        "knots": flat_knots(curve.getKnots(), curve.getMultiplicities()),
        "range": (float(max(first, curve.FirstParameter)), float(min(last, curve.LastParameter))),
    }


def same_points(curve, other):
    """Whether two Part curves are the same within the range of the other, as far as some points tell."""
    first, last = other.FirstParameter, other.LastParameter
    for share in np.linspace(0.0, 1.0, SAMPLES).tolist():
        parameter = first + share * (last - first)
        point = curve.value(parameter)
        if (point - other.value(parameter)).Length > SAME * (1.0 + point.Length):
            return False
    return True


def plane_through(poles, tolerance):
    """(origin, normal) when all poles (..., 3) lie in one plane within `tolerance`, else None."""
    points = poles.reshape(-1, 3)
    origin = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - origin, full_matrices=False)
    if len(axes) < 3 or np.abs((points - origin) @ axes[2]).max() > tolerance:
        return None
    return origin, axes[2]


def line_through(poles, tolerance):
    """(origin, direction) when all poles (n, 3) lie on one line within `tolerance`, else None."""
    along = poles[-1] - poles[0]
    length = np.linalg.norm(along)
    if length <= tolerance:
        return None
    along = along / length
    offsets = poles - poles[0]
    offsets = offsets - np.outer(offsets @ along, along)
    return (poles[0], along) if np.abs(offsets).max() <= tolerance else None
