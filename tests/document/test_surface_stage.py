"""Surface meshes of CAD parts, before any tetrahedron."""

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from DelaunayMesher import extension, pipeline
from DelaunayMesher.document.plc_from_shape import convert
from DelaunayMesher.options import MeshOptions


def surface_mesh(plc, options):
    """(n, 3) points, (m, 3) triangles, (m,) their faces."""
    core_options = pipeline.options_for_core(options, plc)
    mesh = extension.load().surface_mesh(plc.as_dict(), plc.geometry, core_options)
    return tuple(np.asarray(mesh[name]) for name in ("points", "triangles", "triangle_face"))


def smallest_angles(points, triangles):
    """(m,) smallest angle of each triangle in degrees."""
    corners = points[triangles]
    angles = []
    for i in range(3):
        u, v = corners[:, i - 1] - corners[:, i], corners[:, i - 2] - corners[:, i]
        cosine = np.einsum("ij,ij->i", u, v) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        angles.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    return np.min(angles, axis=0)


@pytest.mark.parametrize("size", [0.52, 0.54, 0.57, 0.6])
def test_the_poles_of_a_sphere_leave_no_narrow_triangles(size):
    """The tessellation crowds its points on rings there; too long an edge is better than a short one."""
    options = MeshOptions(max_size=size, threads=1)
    points, triangles, _ = surface_mesh(convert(Part.makeSphere(10), options).plc, options)
    angles = smallest_angles(points, triangles)
    assert angles.min() > 20
    assert (angles < 30).mean() < 0.005


def test_no_triangle_is_left_across_a_bend():
    """CAD kernels now and then lay triangles across a whole fillet; this ring's round face has no others."""
    major, minor, turn = 10.0, 1.0, np.radians(78)
    centre = Vector(major, 0, 0)
    a, b, c = (centre + Vector(minor * np.cos(v), 0, minor * np.sin(v)) for v in (-turn, 0, turn))
    outline = [Part.LineSegment(centre, a), Part.Arc(a, b, c), Part.LineSegment(c, centre)]
    ring = Part.Face(Part.Wire([curve.toShape() for curve in outline])).revolve(
        Vector(), Vector(0, 0, 1), 360
    )
    options = MeshOptions(max_size=1.0, threads=1)
    plc = convert(ring, options).plc

    def round_the_tube(points):
        radius = np.hypot(points[:, 0], points[:, 1]) - major
        return np.arctan2(points[:, 2], radius), np.isclose(np.hypot(points[:, 2], radius), minor)

    angle, on_tube = round_the_tube(plc.points)
    round_face = on_tube[plc.triangles].all(axis=1)
    number = plc.triangle_face[round_face][0]
    low, high = (
        sorted(np.flatnonzero(on_tube & np.isclose(angle, v)), key=lambda p: np.arctan2(*plc.points[p, :2]))
        for v in (-turn, turn)
    )
    assert len(low) == len(high)
    quads = np.stack([low, high, np.roll(high, -1), np.roll(low, -1)], axis=1)
    chords = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    normals = np.cross(*(plc.points[chords[0, i]] - plc.points[chords[0, 0]] for i in (1, 2)))
    first = plc.points[plc.triangles[round_face][0]]
    behind = np.cross(first[1] - first[0], first[2] - first[0]) @ (first[0] * (1, 1, 0)) > 0
    chords = chords if (normals @ (plc.points[low[0]] * (1, 1, 0)) > 0) == behind else chords[:, ::-1]
    plc.triangles = np.concatenate([plc.triangles[~round_face], chords])
    plc.triangle_face = np.append(plc.triangle_face[~round_face], np.full(len(chords), number))

    points, triangles, faces = surface_mesh(plc, options)
    angle, _ = round_the_tube(points)
    assert np.degrees(np.ptp(angle[triangles[faces == number]], axis=1)).max() < 60
