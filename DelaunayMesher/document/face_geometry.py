"""Exact geometry of CAD faces as records of numbers: plane, cylinder, cone, sphere, torus, or a B-spline.

An analytic record is believed only when most of the face's own tessellation nodes lie on it (those on its
edges may be off by as much as the CAD file is); otherwise (a placement that the attributes do not reflect, an
unknown kind) the face is converted to a B-spline.
"""

import itertools
from typing import NamedTuple

import FreeCAD
import numpy as np
import Part

from .splines import plane_through, surface_record
from .tessellation import ONE_TURN

FACETS, PLANE, CYLINDER, CONE, SPHERE, TORUS, SPLINE = range(7)
PARAMETERS = 8  # origin (3), axis (3), a, b
NOTHING = (0.0,) * PARAMETERS
SAME = 1e-7  # mm
PARALLEL = 1e-9  # cosine


class FaceRecords(NamedTuple):
    """The exact surfaces of F faces; splines are numbered as in `splines`, -1 means none."""

    kinds: np.ndarray  # (F,) int32
    params: np.ndarray  # (F, 8) float64: origin, axis, a, b
    spline: np.ndarray  # (F,) int32
    splines: list  # dicts of splines.surface_record()
    doubtful: list  # faces without an exact surface


def face_records(cad, face_nodes, tolerances):
    """FaceRecords of CadElements.

    face_nodes: per face an (n, 3) array of points on it.  tolerances (F,): how far these may be off, as CAD
    edges are only near the surface.
    """
    count = len(cad.faces)
    kinds, params = analytic_records(cad.surfaces, face_nodes)
    kinds[~confirmed(kinds, params, face_nodes, tolerances)] = FACETS
    spline = np.full(count, -1, dtype=np.int32)
    splines, doubtful = [], []
    for number in np.flatnonzero(kinds == FACETS).tolist():
        face, surface, nodes = cad.faces[number], cad.surfaces[number], face_nodes[number]
        if not len(nodes):
            continue  # it has no triangles either
        kinds[number], numbers, record = freeform_record(face, surface, nodes, tolerances[number])
        params[number] = 0.0 if numbers is None else numbers
        if record is not None:
            spline[number] = len(splines)
            splines.append(record)
        if kinds[number] == FACETS:
            doubtful.append(number)
    return FaceRecords(kinds, params, spline, splines, doubtful)


def freeform_record(face, surface, nodes, tolerance):
    """(kind, params or None, spline dict or None) of one face that is no analytic surface, or none that its
    nodes lie on."""
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


def analytic_records(surfaces, face_nodes):
    """(kind (F,), params (F, 8)) of the analytic ones among the surfaces of faces; FACETS for the others."""
    rows = [analytic_numbers(surface) for surface in surfaces]
    kinds = np.array([kind for kind, _ in rows], dtype=np.int32)
    params = np.array([numbers for _, numbers in rows], dtype=np.float64).reshape(-1, PARAMETERS)
    length = np.linalg.norm(params[:, 3:6], axis=1)
    params[:, 3:6] /= np.where(length > 0.0, length, 1.0)[:, None]
    for number in np.flatnonzero(kinds == CONE).tolist():
        nodes, record = face_nodes[number], params[number]
        if len(nodes) and ((nodes - record[:3]) @ record[3:6]).mean() < 0:
            record[3:6] *= -1.0  # towards the nappe that the face lies on
    return kinds, params


def analytic_numbers(surface):
    """(kind, its eight numbers, the axis of any length) of a surface; FACETS for one that is not analytic."""
    if isinstance(surface, Part.Plane):
        return PLANE, (*surface.Position, *surface.Axis, 0.0, 0.0)
    if isinstance(surface, Part.Cylinder):
        return CYLINDER, (*surface.Center, *surface.Axis, surface.Radius, 0.0)
    if isinstance(surface, Part.Sphere):
        return SPHERE, (*surface.Center, 0.0, 0.0, 1.0, surface.Radius, 0.0)
    if isinstance(surface, Part.Toroid):
        return TORUS, (*surface.Center, *surface.Axis, surface.MajorRadius, surface.MinorRadius)
    if isinstance(surface, Part.Cone):
        return CONE, (*surface.Apex, *surface.Axis, abs(surface.SemiAngle), 0.0)
    if isinstance(surface, Part.SurfaceOfRevolution):
        return revolved_numbers(surface)
    return FACETS, NOTHING


def revolved_numbers(surface):
    """As analytic_numbers(), of a surface of revolution (IGES has no other): that of a line or an arc in a
    plane with the axis."""
    profile, origin, axis = surface.BasisCurve, surface.Location, surface.Direction
    if isinstance(profile, Part.LineSegment):
        return revolved_line(profile.StartPoint - origin, profile.EndPoint - origin, origin, axis)
    if not isinstance(profile, (Part.ArcOfCircle, Part.Circle)):
        return FACETS, NOTHING
    height = (profile.Center - origin).dot(axis)
    centre = origin + axis * height
    outward = profile.Center - centre
    if abs(profile.Axis.dot(axis)) > PARALLEL or abs(profile.Axis.dot(outward)) > SAME:
        return FACETS, NOTHING
    if outward.Length <= SAME:
        return SPHERE, (*centre, 0.0, 0.0, 1.0, profile.Radius, 0.0)
    if outward.Length > profile.Radius:
        return TORUS, (*centre, *axis, outward.Length, profile.Radius)
    return FACETS, NOTHING


def revolved_line(start, end, origin, axis):
    """As analytic_numbers(), of a line, from and to places relative to the origin, about an axis."""
    low, high = start.dot(axis), end.dot(axis)
    first, last = start - axis * low, end - axis * high
    outward = first if first.Length > last.Length else last
    if outward.Length <= SAME or first.cross(last).Length > SAME * outward.Length:
        return FACETS, NOTHING
    radii = [side.dot(outward) / outward.Length for side in (first, last)]
    if abs(radii[1] - radii[0]) <= SAME:
        return CYLINDER, (*origin, *axis, 0.5 * sum(radii), 0.0)
    if abs(high - low) <= SAME:
        return PLANE, (*(origin + axis * (0.5 * (low + high))), *axis, 0.0, 0.0)
    slope = (radii[1] - radii[0]) / (high - low)
    apex = origin + axis * (low - radii[0] / slope)
    return CONE, (*apex, *axis, abs(np.arctan(slope)), 0.0)


def confirmed(kinds, params, face_nodes, tolerances):
    """(F,) bool: whether most nodes of each face lie on its analytic surface; no nodes confirm nothing."""
    counts = np.array([len(nodes) for nodes in face_nodes])
    owner = np.repeat(np.arange(len(kinds)), counts)
    nodes = np.concatenate([np.zeros((0, 3)), *face_nodes])
    near = np.zeros(len(nodes), dtype=bool)
    for kind in (PLANE, CYLINDER, CONE, SPHERE, TORUS):
        mine = np.flatnonzero(kinds[owner] == kind)
        off = distances(kind, params[owner[mine]], nodes[mine])
        near[mine] = np.abs(off) <= np.asarray(tolerances)[owner[mine]]
    return 2 * np.bincount(owner[near], minlength=len(kinds)) > counts


def distances(kind, params, points):
    """(n,) distance (mm, unsigned or signed by the kind's habit) of points from analytic surfaces.

    params (8,), or (n, 8): a record for each point.
    """
    origin, axis, a, b = params[..., :3], params[..., 3:6], params[..., 6], params[..., 7]
    offset = points - origin
    if kind == SPHERE:
        return np.linalg.norm(offset, axis=1) - a
    height = (offset * axis).sum(axis=1)
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


def seam_is_smooth(edge, face, surface, kind):
    """Whether the surface passes through its seam without a kink (analytic surfaces always do)."""
    if kind in (CYLINDER, CONE, SPHERE, TORUS):
        return True
    u0, u1, v0, v1 = face.ParameterRange
    first, last = edge.ParameterRange
    for share in (0.1, 0.5, 0.9):
        u, v = surface.parameter(edge.valueAt(first + share * (last - first)))
        across_u = min(abs(u - u0), abs(u - u1)) / (u1 - u0) < min(abs(v - v0), abs(v - v1)) / (v1 - v0)
        ends = ((u0, v), (u1, v)) if across_u else ((u, v0), (u, v1))
        normals = list(itertools.starmap(face.normalAt, ends))
        if normals[0].dot(normals[1]) < np.cos(np.radians(2.0)):
            return False
    return True
