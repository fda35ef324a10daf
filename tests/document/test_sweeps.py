"""Families of parts with one dimension running down to nothing, at one element size: none may fail, and the
number of elements may not jump."""

import math

import FreeCAD
import numpy as np
import Part
import pytest

import DelaunayMesher

V = FreeCAD.Vector


def thin_plate(thickness):
    return Part.makeBox(40, 30, thickness)


def filleted_block(radius):
    box = Part.makeBox(40, 30, 20)
    return box.makeFillet(radius, [e for e in box.Edges if abs(e.tangentAt(e.FirstParameter).z) > 0.9])


def cylinders_with_gap(gap):
    """Side by side, on one plate."""
    plate = Part.makeBox(60, 30, 5, V(-15, -15, -5))
    return plate.fuse(Part.makeCylinder(10, 30)).fuse(Part.makeCylinder(10, 30, V(20 + gap, 0, 0)))


def groove(width):
    """A ring-shaped groove in a cylinder."""
    ring = Part.makeCylinder(8, 20, V(0, 0, 10)).cut(Part.makeCylinder(8 - width, 20, V(0, 0, 10)))
    return Part.makeCylinder(12, 30).cut(ring)


def block_with_short_edge(length):
    """The top of its front is divided by an edge of this length."""
    low = [(0, 0, 0), (40, 0, 0), (40, 30, 0), (0, 30, 0)]
    high = [(0, 0, 20), (20, 0, 20), (20 + length, 0, 20), (40, 0, 20), (40, 30, 20), (0, 30, 20)]
    front = [[low[0], (10, 0, 0), high[1], high[0]], [(10, 0, 0), (30, 0, 0), high[2], high[1]]]
    front.append([(30, 0, 0), low[1], high[3], high[2]])
    sides = [[low[1], low[2], high[4], high[3]], [low[2], low[3], high[5], high[4]]]
    sides += [
        [low[3], low[0], high[0], high[5]],
        high,
        [low[0], low[3], low[2], low[1], (30, 0, 0), (10, 0, 0)],
    ]
    faces = [Part.Face(Part.makePolygon([V(*p) for p in loop + loop[:1]])) for loop in front + sides]
    shell = Part.makeShell(faces)
    shell.sewShape()
    return Part.Solid(shell)


def roof_with_flat_ridge(width):
    return Part.makeWedge(0, 0, 0, 0, 20, 40, 20, 30, 30, 20 + width)


def stepped_block(step):
    return Part.makeBox(40, 30, 20).fuse(Part.makeBox(20, 30, step, V(0, 0, 20))).removeSplitter()


def cylinder_let_into_block(depth):
    """What joins them is narrow from one edge to the other."""
    block = Part.makeBox(20, 20, 10)
    return block.fuse(Part.makeCylinder(4, 30, V(10, -5, 14 - depth), V(0, 1, 0)))


def slab_flush_with_one_side(step):
    """A slab on a block that it overhangs a little, its side in one face with that of a wider part: that face
    has a narrow tail."""
    block = Part.makeBox(40, 30, 20, V(step, 0, 0)).fuse(Part.makeBox(40, 8, 20))
    return block.fuse(Part.makeBox(40, 30, step, V(0, 0, 20))).removeSplitter()


SWEEPS = {
    "plate": (thin_plate, [10, 5, 2, 1, 0.5, 0.2, 0.1, 0.05]),
    "fillet": (filleted_block, [5, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01]),
    "gap": (cylinders_with_gap, [1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4]),
    "groove": (groove, [2, 1, 0.5, 0.2, 0.1, 0.05]),
    "edge": (block_with_short_edge, [1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5]),
    "neck": (cylinder_let_into_block, [1, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]),
    "ridge": (roof_with_flat_ridge, [5, 1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5]),
}


def volume(mesh):
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a).sum() / 6


def checked(shape, size=10.0, volume_error=0.03):
    mesh = DelaunayMesher.mesh(shape, max_size=size, threads=1)
    assert math.isclose(volume(mesh), shape.Volume, rel_tol=volume_error)
    return mesh


@pytest.mark.long
@pytest.mark.parametrize("name", SWEEPS)
def test_no_part_of_the_family_fails_and_counts_grow_smoothly(name):
    make, values = SWEEPS[name]
    counts = []
    for value in values:
        mesh = checked(make(value))
        counts.append(len(mesh.tets))
        assert counts[-1] < 300_000, (name, value, counts)
    for before, after in zip(counts, counts[1:]):
        assert after < 12 * before, (name, counts)


@pytest.mark.parametrize("step", [0.1, 0.003, 1e-5])
def test_low_steps_cost_nothing(step):
    """A face that is a step, or that has a tail along one, becomes an edge."""
    for make in (stepped_block, slab_flush_with_one_side):
        mesh = checked(make(step), size=8.0)
        assert mesh.quality["min_dihedral"] > 15
        assert len(mesh.tets) < 4000
        assert any("far smaller than the elements" in warning for warning in mesh.warnings)


@pytest.mark.parametrize("side, size", [(0.1, 2.0), (0.3, 4.0)])
def test_tetrahedra_grade_towards_triangles_smaller_than_the_size(side, size):
    """Round a short CAD edge the surface mesh is finer than the size field knows."""
    corners = [(0, 0), (20, 0), (20, 20), (10 + side, 20), (10, 20 + side), (0, 20), (0, 0)]
    outline = Part.makePolygon([V(x, y, 0) for x, y in corners])
    shape = Part.Face(outline).extrude(V(0, 0, 10))
    mesh = DelaunayMesher.mesh(shape, max_size=size, optimise=False, threads=1)
    assert mesh.quality["min_dihedral"] > 19.9


@pytest.mark.parametrize("size", [None, 0.5, 8.0])
def test_a_size_keeps_what_is_small(size):
    """The face of a low step becomes an edge; a size of its own, even that of the part, keeps all of it."""
    shape = stepped_block(0.05)
    face = next(i for i, f in enumerate(shape.Faces) if f.Area < 2)
    sizes = {"Face%d" % (face + 1): size} if size else {}
    mesh = DelaunayMesher.mesh(shape, max_size=8.0, sizes=sizes, threads=1)
    a, b, c = (mesh.points[mesh.triangles[mesh.triangle_face == face, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert area == pytest.approx(shape.Faces[face].Area if size else 0.0)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_long_narrow_fillets_keep_their_bend(seed):
    """Their tessellation has no point along the fillet: no triangle may span it before there are."""
    box = Part.makeBox(50, 30, 20)
    rounded = box.makeFillet(0.2, [box.Edges[0], box.Edges[1], box.Edges[4]])
    mesh = DelaunayMesher.mesh(rounded, max_size=2.466, seed=seed)
    assert mesh.quality["min_dihedral"] > 20
    assert not mesh.warnings


@pytest.mark.parametrize("half_angle", [60, 30, 20, 17, 16, 15, 14, 13, 12, 10, 8])
def test_cones_are_good_to_their_tip(half_angle):
    """Between 11.5 and 17.5 degrees the surface mesh once folded there."""
    mesh = checked(Part.makeCone(20 * math.tan(math.radians(half_angle)), 0, 20), 4.0, volume_error=0.06)
    assert mesh.quality["min_dihedral"] > 20
    assert not mesh.warnings


def rod(flat, length):
    """Half circles of radius 0.1 at its sides, joined by flats of this width."""
    arcs = [
        Part.Arc(V(x * flat / 2, -x * 0.1, 0), V(x * (flat / 2 + 0.1), 0, 0), V(x * flat / 2, x * 0.1, 0))
        for x in (1, -1)
    ]
    lines = [Part.makeLine(V(x * flat / 2, x * 0.1, 0), V(-x * flat / 2, x * 0.1, 0)) for x in (1, -1)]
    outline = Part.Wire([arcs[0].toShape(), lines[0], arcs[1].toShape(), lines[1]])
    return Part.Face(outline).extrude(V(0, 0, length))


@pytest.mark.parametrize("flat, wide, angle", [(1e-3, 0.02, 32), (1e-3, 0.1, 32), (1e-3, 0.1, 45)])
def test_faces_with_a_strip_and_a_wide_part(flat, wide, angle):
    """As at the bend of a wire whose two halves are not quite as wide."""
    upright, bent = rod(flat, 3), rod(wide, 3)
    upright.translate(V(0, 0, -3))
    bent.rotate(V(0, 0, 0), V(0, 1, 0), angle)
    mesh = DelaunayMesher.mesh(upright.fuse(bent), max_size=0.43)
    assert mesh.quality["min_dihedral"] > 20
    assert len(mesh.tets) < 9000


def test_the_size_floor_is_blamed_where_it_is_at_work():
    """A plate of 0.2 whose elements may not be smaller than 1 cannot have good ones.  Where its thickness is
    not looked at, a smaller size that is given somewhere is no floor.
    """
    plate = Part.makeBox(20, 20, 0.2)
    mesh = DelaunayMesher.mesh(plate, max_size=4, min_size=1, optimise=False)
    assert mesh.below_target and {item["reason"] for item in mesh.below_target} == {"size_floor"}
    ball = [DelaunayMesher.Region.ball((10, 10, 0), 6, 1)]
    mesh = DelaunayMesher.mesh(plate, max_size=4, elements_across=0, optimise=False, regions=ball)
    assert mesh.below_target and {item["reason"] for item in mesh.below_target} == {"fallback"}


def test_elements_at_a_notch_are_not_excused_by_its_angle():
    """The 30 degrees are outside of the solid, which has 330 there."""
    half = 6 * math.tan(math.radians(15))
    outline = [V(5, -1, 4), V(5 - half, -1, 10), V(5 + half, -1, 10), V(5, -1, 4)]
    notched = Part.makeBox(10, 5, 10).cut(Part.Face(Part.makePolygon(outline)).extrude(V(0, 8, 0)))
    bad = []
    for seed in range(8):  # a few bad elements each, some of them at the root
        options = {"max_size": 1.0, "target_angle": 30, "optimise": False, "seed": seed}
        bad += DelaunayMesher.mesh(notched, **options).below_target
    assert any(np.hypot(item["place"][0] - 5, item["place"][2] - 4) < 1 for item in bad)
    assert all(item["reason"] == "fallback" for item in bad)


@pytest.mark.parametrize("radius", [0.02, 0.005])
def test_tiny_fillets_on_all_edges_are_absorbed(radius):
    """With points of the tessellation inside them: the balls at the corners, the rings round the hole."""
    block = Part.makeBox(40, 30, 20).cut(Part.makeCylinder(6, 30, V(16, 14, -5)))
    mesh = DelaunayMesher.mesh(block.makeFillet(radius, block.Edges), max_size=3.0, threads=1)
    assert len(mesh.tets) < 1.3 * len(DelaunayMesher.mesh(block, max_size=3.0, threads=1).tets)
    assert mesh.quality["min_dihedral"] > 25


@pytest.mark.parametrize("gap", [0.01, 5e-4])
@pytest.mark.parametrize("radius", [5, 6, 8])
def test_a_neck_of_a_face_between_two_points_of_its_curves(radius, gap):
    """A boss whose circle comes that near to the edge of the block: the large face is narrow there."""
    part = Part.makeBox(40, 30, 10).fuse(Part.makeCylinder(radius, 8, V(20, radius + gap, 10)))
    mesh = DelaunayMesher.mesh(part, max_size=3.0, threads=1)
    assert mesh.quality["min_dihedral"] > 25


@pytest.mark.parametrize("depth", [1e-2, 1e-3])
def test_a_neck_between_two_edges_gets_small_elements(depth):
    mesh = checked(cylinder_let_into_block(depth), 2.0)
    assert mesh.quality["min_dihedral"] > 25
    assert not mesh.warnings or "constrained" in mesh.warnings[0]
