"""What every mesh of a sound part must be, checked on the arrays that a user gets: closed, positive, as
large as the part, with good angles and edges of the wanted length, Delaunay, and the same for the same seed.
"""

import functools
from collections import namedtuple

import numpy as np
import pytest
from parts import PARTS, SIZES
from scipy.spatial import cKDTree

import DelaunayMesher
from DelaunayMesher import document, extension, quality
from DelaunayMesher.pipeline import options_for_core

Accepted = namedtuple("Accepted", "shape plc options mesh")
TARGET = 20.0  # degrees
FINER = 0.4  # the long tests divide the sizes of the quick ones by this

every_part = pytest.mark.parametrize("name", PARTS)
both_sizes = pytest.mark.parametrize(
    "scale", [1.0, pytest.param(FINER, marks=pytest.mark.long)], ids=["coarse", "fine"]
)
optimised_or_not = pytest.mark.parametrize("optimise", [False, True], ids=["delaunay", "optimised"])


@functools.lru_cache(maxsize=None)
def accepted(name, scale=1.0, optimise=False, order=1):
    """A part with its PLC and its mesh; made once for all tests."""
    shape = PARTS[name]()
    options = document.make_options(max_size=scale * SIZES[name], optimise=optimise, order=order, seed=7)
    plc = document.convert(shape, options).plc
    return Accepted(shape, plc, options, DelaunayMesher.mesh(plc, options))


def faces_of(tets):
    """(4 t, 3) faces with sorted corners; row 4 t + k is opposite corner k of tetrahedron t."""
    tets = np.sort(tets[:, :4], axis=1)
    return np.stack([np.delete(tets, k, axis=1) for k in range(4)], axis=1).reshape(-1, 3)


def neighbours(tets):
    """(n, 2) rows 4 t + k of the faces that two tetrahedra share, (b, 3) faces with one tetrahedron."""
    faces = faces_of(tets)
    order = np.lexsort(faces.T[::-1])
    ordered = faces[order]
    same = (ordered[1:] == ordered[:-1]).all(axis=1)
    assert not (same[1:] & same[:-1]).any(), "three tetrahedra share a face"
    single = ~(np.append(same, False) | np.append(False, same))
    return np.stack([order[:-1][same], order[1:][same]], axis=1), ordered[single]


@every_part
@both_sizes
@optimised_or_not
def test_closed_and_positive(name, scale, optimise):
    shape, plc, _, mesh = accepted(name, scale, optimise)
    corners = mesh.points[mesh.tets]
    assert (extension.load().orient3d(corners) > 0).all()  # exact
    assert (quality.volumes(mesh.points, mesh.tets) > 0).all()
    assert np.array_equal(np.unique(mesh.tets), np.arange(len(mesh.points)))

    _, outside = neighbours(mesh.tets)
    given = np.sort(mesh.triangles, axis=1)
    assert np.array_equal(outside, given[np.lexsort(given.T[::-1])])
    edges = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()

    assert np.array_equal(np.unique(mesh.triangle_face), np.arange(len(shape.Faces)))
    on_edges = {tuple(sorted(line)) for line in mesh.lines.tolist()}
    faces_at = {}
    for face, triangle in zip(mesh.triangle_face.tolist(), mesh.triangles.tolist()):
        for k in range(3):
            faces_at.setdefault(tuple(sorted((triangle[k], triangle[k - 1]))), set()).add(face)
    assert {edge for edge, faces in faces_at.items() if len(faces) > 1} <= on_edges <= set(faces_at)


def volume_of(shape):
    """The part's volume and how much it may be wrong, in mm^3.  OCC's own is 0.7 % off for the loft."""
    if all(face.Surface.TypeId != "Part::GeomBSplineSurface" for face in shape.Faces):
        return shape.Volume, 1e-7 * shape.Volume
    deflection = 0.003
    points, triangles = shape.copy().tessellate(deflection)
    a, b, c = np.array([tuple(point) for point in points])[np.array(triangles).T]
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6, deflection * shape.Area


@every_part
@both_sizes
@optimised_or_not
def test_volume_is_right_but_for_the_facets(name, scale, optimise):
    shape, plc, _, mesh = accepted(name, scale, optimise)
    corners = mesh.points[mesh.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    bound = 0.0
    for face in range(len(shape.Faces)):
        chosen = mesh.triangle_face == face
        middles = [corners[chosen].mean(axis=1)]
        middles += [(corners[chosen, k] + corners[chosen, k - 1]) / 2 for k in range(3)]
        tabled = plc.as_dict(), plc.geometry, 2, face
        away = [np.linalg.norm(extension.load().project(*tabled, m) - m, axis=1) for m in middles]
        bound += (areas[chosen] * np.max(away, axis=0)).sum()
    volume, doubt = volume_of(shape)
    assert abs(volume - quality.volumes(mesh.points, mesh.tets).sum()) <= bound + doubt
    assert bound < 0.1 * volume  # with 12 edges round a circle


@every_part
@both_sizes
@optimised_or_not
def test_no_angle_under_the_target(name, scale, optimise):
    _, _, _, mesh = accepted(name, scale, optimise)
    angles = quality.dihedral_angles(mesh.points, mesh.tets)
    assert angles.min() > TARGET - 1e-9
    assert mesh.status == "ok" and not mesh.below_target


@every_part
@both_sizes
@optimised_or_not
def test_edges_have_the_wanted_length(name, scale, optimise):
    _, plc, options, mesh = accepted(name, scale, optimise)
    pairs = mesh.tets[:, [0, 1, 1, 2, 2, 0, 0, 3, 1, 3, 2, 3]].reshape(-1, 2)
    ends = mesh.points[np.unique(np.sort(pairs, axis=1), axis=0)]
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    tabled = plc.as_dict(), plc.geometry, options_for_core(options, plc)
    wanted, _ = extension.load().sizes(*tabled, np.ascontiguousarray(ends.mean(axis=1)))
    ratio = lengths / wanted
    assert 0.85 < np.median(ratio) < 1.1
    assert (ratio < 2).mean() > 0.999


@every_part
@both_sizes
def test_delaunay_when_not_optimised(name, scale):
    mesh = accepted(name, scale).mesh
    points, tets = mesh.points, mesh.tets
    pairs, _ = neighbours(tets)
    ordered = np.sort(tets, axis=1)
    opposite = ordered[pairs[:, 1] // 4, pairs[:, 1] % 4]
    five = np.concatenate([points[tets[pairs[:, 0] // 4]], points[opposite][:, None]], axis=1)
    assert (extension.load().insphere(np.ascontiguousarray(five)) <= 0).all()  # exact

    # Not only neighbours: no point at all lies inside a circumscribed sphere.
    a, edges = points[tets[:, 0]], points[tets[:, 1:]] - points[tets[:, :1]]
    centres = a + np.linalg.solve(2 * edges, (edges**2).sum(axis=2)[..., None])[..., 0]
    radii = np.linalg.norm(centres - a, axis=1)
    nearest = cKDTree(points).query(centres)[0]
    assert (nearest > radii * (1 - 1e-9)).all()


@every_part
@optimised_or_not
def test_same_seed_same_bytes(name, optimise):
    _, plc, options, mesh = accepted(name, 1.0, optimise)
    for threads in (1, 3):
        again = DelaunayMesher.mesh(plc, options, threads=threads)
        for array in ("points", "tets", "triangles", "triangle_face", "lines", "point_entity"):
            assert getattr(again, array).tobytes() == getattr(mesh, array).tobytes()
    other = DelaunayMesher.mesh(plc, options, seed=8)
    assert other.points.tobytes() != mesh.points.tobytes()


@every_part
@both_sizes
def test_second_order_is_proven_valid(name, scale):
    _, plc, _, mesh = accepted(name, scale, True, 2)
    assert quality.jacobian_coefficients(mesh.points, mesh.tets).min() > 0
    for face in np.unique(mesh.triangle_face):
        nodes = mesh.points[np.unique(mesh.triangles[mesh.triangle_face == face])]
        projected = extension.load().project(plc.as_dict(), plc.geometry, 2, int(face), nodes)
        assert np.linalg.norm(projected - nodes, axis=1).max() < 1e-7
