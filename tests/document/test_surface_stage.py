"""Surface meshes of CAD parts, before any tetrahedron."""

import numpy as np
import Part
import pytest

from DelaunayMesher import extension, pipeline
from DelaunayMesher.document.plc_from_shape import convert
from DelaunayMesher.options import MeshOptions


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
    plc = convert(Part.makeSphere(10), options).plc
    mesh = extension.load().surface_mesh(plc.as_dict(), plc.geometry, pipeline.options_for_core(options, plc))
    angles = smallest_angles(np.asarray(mesh["points"]), np.asarray(mesh["triangles"]))
    assert angles.min() > 20
    assert (angles < 30).mean() < 0.005
