"""Exact geometry of CAD faces as records of numbers: plane, cylinder, cone, sphere, torus, or a B-spline.

An analytic record is believed only when most of the face's own tessellation nodes lie on it (those on its
edges may be off by as much as the CAD file is); otherwise (a placement that the attributes do not reflect, an
unknown kind) the face is converted to a B-spline.
"""

import itertools

import FreeCAD
import numpy as np
import Part

from .splines import plane_through, surface_record
from .tessellation import ONE_TURN

FACETS, PLANE, CYLINDER, CONE, SPHERE, TORUS, SPLINE = range(7)
PARAMETERS = 8  # origin (3), axis (3), a, b


def face_records(faces, face_nodes, tolerances):
    """Arrays (kind (F,), params (F, 8), spline (F,)), the list of spline dicts, and notes about doubtful
    faces.

    face_nodes: per face an (n, 3) array of points on it.  tolerances: per face how far these may be off, as
    CAD edges are only near the surface.
    """
    kinds = np.zeros(len(faces), dtype=np.int32)
    params = np.zeros((len(faces), PARAMETERS))
    spline = np.full(len(faces), -1, dtype=np.int32)
    splines, doubtful = [], []
    for number, (face, nodes, tolerance) in enumerate(zip(faces, face_nodes, tolerances)):
        kind, numbers, record = face_record(face, nodes, tolerance)
        kinds[number] = kind
        if numbers is not None:
            params[number] = numbers
        if record is not None:
            spline[number] = len(splines)
            splines.append(record)
        if kind == FACETS:
            doubtful.append(number)
    return kinds, params, spline, splines, doubtful


def face_record(face, nodes, tolerance):
    """(kind, params or None, spline dict or None) of one face."""
    try:
        surface = face.Surface
    except (RuntimeError, TypeError, ValueError):  # a kind FreeCAD has no class for
        surface = None
    analytic = analytic_record(surface, nodes)
    if analytic and len(nodes) and np.median(np.abs(distances(*analytic, nodes))) <= tolerance:
        return analytic[0], analytic[1], None
    for candidate, ranges, same_parameters in spline_candidates(face, surface):
        fits = agrees(candidate, face) if same_parameters else passes_through(candidate, nodes, tolerance)
        if fits:
            record = surface_record(candidate, ranges)
            flat = plane_through(
                record["poles"], 1e-9 * max(np.abs(np.ptp(nodes, axis=0)).max(initial=0.0), 1e-3)
            )
            if flat is not None:
                return PLANE, parameters(*flat), None
            return SPLINE, None, record
    return FACETS, None, None


def parameters(origin, axis, a=0.0, b=0.0):
    """The eight numbers of a record; the axis is made a unit vector."""
    axis = np.asarray(tuple(axis), dtype=np.float64)
    return np.concatenate([tuple(origin), axis / np.linalg.norm(axis), [a, b]])


def analytic_record(surface, nodes):
    """(kind, params) of an analytic surface, or None."""
    if isinstance(surface, Part.Plane):
        return PLANE, parameters(surface.Position, surface.Axis)
    if isinstance(surface, Part.Cylinder):
        return CYLINDER, parameters(surface.Center, surface.Axis, surface.Radius)
    if isinstance(surface, Part.Sphere):
        return SPHERE, parameters(surface.Center, (0.0, 0.0, 1.0), surface.Radius)
    if isinstance(surface, Part.Toroid):
        return TORUS, parameters(surface.Center, surface.Axis, surface.MajorRadius, surface.MinorRadius)
    if isinstance(surface, Part.Cone):
        record = parameters(surface.Apex, surface.Axis, abs(surface.SemiAngle))
        if len(nodes) and ((nodes - record[:3]) @ record[3:6]).mean() < 0:
            record[3:6] *= -1.0  # towards the nappe that the face lies on
        return CONE, record
    return None


def distances(kind, params, points):
    """(n,) distance (mm, unsigned or signed by the kind's habit) of points from an analytic surface."""
    origin, axis, a, b = params[:3], params[3:6], params[6], params[7]
    offset = points - origin
    if kind == SPHERE:
        return np.linalg.norm(offset, axis=1) - a
    height = offset @ axis
    if kind == PLANE:
        return height
    radius = np.linalg.norm(offset - height[:, None] * axis, axis=1)
    if kind == CYLINDER:
        return radius - a
    if kind == CONE:
        return radius * np.cos(a) - np.abs(height) * np.sin(a)
    near = np.hypot(radius - a, height) - b
    far = np.hypot(radius + a, height) - b  # the sheet beyond the axis of a spindle torus
    return np.where(np.abs(near) < np.abs(far), near, far)


def spline_candidates(face, surface):
    """(surface, range, whether its parameters are the face's) to try: as it is, then by toNurbs()."""
    if isinstance(surface, Part.BSplineSurface):
        yield surface, face.ParameterRange, True
    elif isinstance(surface, Part.BezierSurface):
        yield surface.toBSpline(), face.ParameterRange, True
    try:
        converted = one_turn(face, surface).toNurbs().Faces[0]
        surface = converted.Surface
    except (RuntimeError, IndexError, TypeError, ValueError):  # OCC gives up on this face
        return
    if isinstance(surface, Part.BezierSurface):
        surface = surface.toBSpline()
    if isinstance(surface, Part.BSplineSurface):
        yield surface, converted.ParameterRange, False


def one_turn(face, surface):
    """The face, or the part of its surface of revolution that goes round once if the face laps itself."""
    u0, u1, v0, v1 = face.ParameterRange
    if isinstance(surface, Part.SurfaceOfRevolution) and u1 - u0 > ONE_TURN:
        return surface.toShape(u0, u0 + 2.0 * np.pi, v0, v1)
    return face


def agrees(surface, face):
    """Whether surface and face give the same points for the same (u, v)."""
    u0, u1, v0, v1 = face.ParameterRange
    for share in (0.2, 0.5, 0.7):
        u, v = u0 + share * (u1 - u0), v0 + 0.9 * share * (v1 - v0)
        here = face.valueAt(u, v)
        if (surface.value(u, v) - here).Length > 1e-9 * (1.0 + here.Length):
            return False
    return True


def passes_through(surface, nodes, tolerance, samples=5):
    """Whether most of a few nodes lie on the surface (each takes a global projection: 0.5 to 5 ms)."""
    step = max(1, len(nodes) // samples)
    near = []
    for point in nodes[step // 2 :: step][:samples]:
        point = FreeCAD.Vector(*point)
        near.append((surface.value(*surface.parameter(point)) - point).Length <= tolerance)
    return 2 * sum(near) > len(near)


def seam_is_smooth(edge, face, kind):
    """Whether the surface passes through its seam without a kink (analytic surfaces always do)."""
    if kind in (CYLINDER, CONE, SPHERE, TORUS):
        return True
    u0, u1, v0, v1 = face.ParameterRange
    first, last = edge.ParameterRange
    for share in (0.1, 0.5, 0.9):
        u, v = face.Surface.parameter(edge.valueAt(first + share * (last - first)))
        across_u = min(abs(u - u0), abs(u - u1)) / (u1 - u0) < min(abs(v - v0), abs(v - v1)) / (v1 - v0)
        ends = ((u0, v), (u1, v)) if across_u else ((u, v0), (u, v1))
        normals = list(itertools.starmap(face.normalAt, ends))
        if normals[0].dot(normals[1]) < np.cos(np.radians(2.0)):
            return False
    return True
