"""Exact geometry of CAD edges as records of numbers: line, circle, or a B-spline curve."""

from typing import NamedTuple

import numpy as np
import Part

from .face_geometry import parameters
from .splines import curve_record, line_through

POLYLINE, LINE, CIRCLE, SPLINE = range(4)
PARAMETERS = 7  # origin (3), axis (3), a


class EdgeRecords(NamedTuple):
    """The exact curves of E edges; splines are numbered as in `splines`, -1 means none."""

    kinds: np.ndarray  # (E,) int32
    params: np.ndarray  # (E, 7) float64: origin, axis, a
    spline: np.ndarray  # (E,) int32
    splines: list  # dicts of splines.curve_record()


def edge_records(edges, wanted):
    """EdgeRecords of a list of edges.

    wanted: (E,) bool; other edges (degenerate ones, seams that are dropped) stay polylines.
    """
    kinds = np.zeros(len(edges), dtype=np.int32)
    params = np.zeros((len(edges), PARAMETERS))
    spline = np.full(len(edges), -1, dtype=np.int32)
    splines, straight, ends = [], [], []
    for number in np.flatnonzero(wanted).tolist():
        edge, curve = edges[number], curve_of(edges[number])
        if isinstance(curve, (Part.Line, Part.LineSegment)):
            straight.append(number)
            ends += [(*edge.valueAt(end),) for end in edge.ParameterRange]
            continue
        kinds[number], numbers, record = curved_record(edge, curve)
        if numbers is not None:
            params[number] = numbers[:PARAMETERS]
        if record is not None:
            spline[number] = len(splines)
            splines.append(record)
    ends = np.array(ends).reshape(-1, 2, 3)
    along = ends[:, 1] - ends[:, 0]
    kinds[straight] = LINE
    params[straight, :3] = ends[:, 0]
    params[straight, 3:6] = along / np.linalg.norm(along, axis=1)[:, None]
    return EdgeRecords(kinds, params, spline, splines)


def curve_of(edge):
    """The Part curve of an edge, or None if FreeCAD has no class for its kind."""
    try:
        return edge.Curve
    except (RuntimeError, TypeError, ValueError):
        return None


def curved_record(edge, curve):
    """(kind, params or None, spline dict or None) of one edge; each is tried against points of the edge."""
    first, last = edge.ParameterRange
    scale = max(abs(edge.BoundBox.DiagonalLength), 1e-3)
    samples = [edge.valueAt(first + share * (last - first)) for share in (0.0, 0.3, 0.7, 1.0)]
    if isinstance(curve, Part.Circle):
        record = parameters(curve.Center, curve.Axis, curve.Radius)
        points = np.array([tuple(point) for point in samples])
        if np.abs(circle_distances(record, points)).max() <= 1e-9 * scale:
            return CIRCLE, record, None
    for candidate, start, end in spline_candidates(edge, curve, first, last):
        record = curve_record(candidate, start, end)
        ends = [candidate.value(start), candidate.value(end)]
        off = max((ends[0] - samples[0]).Length, (ends[1] - samples[-1]).Length)
        if record is None or off > 1e-6 * scale:
            continue
        straight = line_through(record["poles"], 1e-10 * scale)
        if straight is not None:
            return LINE, parameters(*straight), None
        return SPLINE, None, record
    return POLYLINE, None, None


def circle_distances(params, points):
    """(n,) distance of points from a circle record."""
    offset = points - params[:3]
    height = offset @ params[3:6]
    radius = np.linalg.norm(offset - height[:, None] * params[3:6], axis=1)
    return np.hypot(radius - params[6], height)


def spline_candidates(edge, curve, first, last):
    """(B-spline curve, start, end) triples to try: as it is, then through toNurbs()."""
    if isinstance(curve, Part.BSplineCurve):
        yield curve, first, last
    elif isinstance(curve, Part.BezierCurve):
        yield curve.toBSpline(), first, last
    try:
        converted = edge.toNurbs().Edges[0]
        curve = converted.Curve
    except (RuntimeError, IndexError, TypeError, ValueError):  # no 3D curve, or OCC gives up
        return
    if isinstance(curve, Part.BezierCurve):
        curve = curve.toBSpline()
    if isinstance(curve, Part.BSplineCurve):
        start, end = converted.ParameterRange
        yield curve, start, end
