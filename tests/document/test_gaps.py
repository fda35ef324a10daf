"""CAD with gaps: faces without a solid, edges that coincide, faces OCC leaves out, open solids."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import Part
import pytest
from FreeCAD import Base, Rotation, Vector
from parts import PARTS

from DelaunayMesher import pipeline
from DelaunayMesher.document import tessellation
from DelaunayMesher.document.cad_elements import CadElements
from DelaunayMesher.document.closed import open_triangles, solid_volumes
from DelaunayMesher.document.filling import fill
from DelaunayMesher.document.plc_from_shape import convert, fault_of, volume_warnings
from DelaunayMesher.document.sewing import with_solids
from DelaunayMesher.document.tessellation import tessellate
from DelaunayMesher.errors import MeshError


def loose(shape):
    """A compound of copies of the faces, as an IGES file holds them."""
    return Part.Compound([face.copy() for face in shape.Faces])


def volume_of(shape):
    """Of the PLCs of a shape, all checked."""
    total = 0.0
    for plc in convert(shape).plcs:
        plc.check()
        sides = plc.face_solids[plc.triangle_face]
        assert not len(open_triangles(plc.triangles, sides, len(plc.points))[0])
        total += solid_volumes(plc.points, plc.triangles, sides, plc.solid_count).sum()
    return total


@pytest.mark.parametrize("name", ["bracket", "cone_frustum", "lofted", "torus"])
def test_loose_faces_are_sewn_to_a_solid(name):
    shape, notes = PARTS[name](), []
    sewn = with_solids(loose(shape), notes)
    assert len(sewn.Solids) == 1 and len(sewn.Faces) == len(shape.Faces)
    assert volume_of(sewn) == pytest.approx(shape.Volume, rel=0.01)
    assert "sewing made 1 solid of its " in notes[0]


def test_a_file_of_faces_is_meshed(tmp_path):
    path = str(tmp_path / "faces.brep")
    loose(Part.makeBox(10, 10, 10)).exportBrep(path)
    mesh = pipeline.run(path, {"max_size": 5.0})
    assert len(mesh.tets) and "sewing" in mesh.warnings[0]


def test_faces_inside_others_are_a_cavity():
    outer, inner = Part.makeBox(10, 10, 10), Part.makeSphere(3, Vector(5, 5, 5))
    beside = Part.makeBox(2, 2, 2, Vector(20, 0, 0))
    shapes = [inner, outer, beside]
    for faces in (loose(Part.Compound(shapes)), Part.Compound([loose(shape) for shape in shapes])):
        sewn = with_solids(faces, [])
        assert len(sewn.Solids) == 2
        assert volume_of(sewn) == pytest.approx(1008 - 36 * math.pi, rel=5e-3)


def test_faces_of_solids_that_touch_are_sewn_group_by_group():
    boxes = [Part.makeBox(10, 10, 10, Vector(x, 0, 0)) for x in (0, 10, 20)]
    half = [Part.Compound(loose(boxes[2]).Faces[:3]), Part.Compound(loose(boxes[2]).Faces[3:])]
    sewn = with_solids(Part.Compound([loose(boxes[0]), loose(boxes[1]), Part.Compound(half)]), [])
    assert [solid.Volume for solid in sewn.Solids] == pytest.approx([1000] * 3)
    assert volume_of(sewn) == pytest.approx(3000)


def test_faces_that_do_not_close_stay_faces():
    box = Part.makeBox(10, 10, 10)
    assert not with_solids(Part.Compound(box.Faces[:5]), []).Solids
    notes = []
    sewn = with_solids(Part.Compound([*Part.makeBox(1, 1, 1, Vector(20, 0, 0)).Faces, *box.Faces[:5]]), notes)
    assert sewn.Volume == pytest.approx(1.0)
    assert "5 faces that did not close" in notes[0]


@pytest.mark.parametrize("gap", [0.0, 5e-4])
def test_closed_edges_that_start_elsewhere_are_stitched(gap):
    can = Part.makeCylinder(5, 20)
    wall, top, bottom = (face.copy() for face in can.Faces)
    top.rotate(Vector(0, 0, 0), Vector(0, 0, 1), 37)
    top.translate(Vector(0, 0, gap))
    sewn = with_solids(Part.Compound([wall, top, bottom]), [])
    assert len(sewn.Solids) == 1
    assert volume_of(sewn) == pytest.approx(can.Volume, rel=0.01)


def test_an_edge_along_several_is_stitched_and_faces_are_turned_to_agree():
    box = Part.makeBox(10, 10, 10)
    halves = [Part.makePlane(10, 5, Vector(0, y, 10)) for y in (0, 5)]
    halves[0].reverse()
    others = [face.copy() for face in box.Faces if face.CenterOfMass.z < 9.9]
    assert volume_of(with_solids(Part.Compound([*others, *halves]), [])) == pytest.approx(1000)


def without(shape, face, rows=slice(None)):
    """(Tessellation, sides) of a shape that lacks triangles of a face."""
    mesh = tessellate(CadElements(shape), 0.1, 0.3)
    missing = np.zeros(len(mesh.triangles), dtype=bool)
    missing[np.flatnonzero(mesh.triangle_face == face)[rows]] = True
    mesh = replace(mesh, triangles=mesh.triangles[~missing], triangle_face=mesh.triangle_face[~missing])
    if missing.sum() > 1:
        mesh.face_nodes[face] = np.zeros((0, 3))
    return mesh, mesh.cad.sides


@pytest.mark.parametrize("name", ["bracket", "cylinder", "cone_frustum", "plate"])
def test_a_face_that_is_missing_is_filled(name):
    shape = PARTS[name]()
    for face in range(min(len(shape.Faces), 8)):
        mesh, sides = without(shape, face)
        assert fault_of(mesh, sides)
        mesh, filled, clean = fill(mesh, sides)
        assert filled == [face] and clean and not fault_of(mesh, sides)
        volume = solid_volumes(mesh.points, mesh.triangles, sides[mesh.triangle_face], 1)[0]
        assert volume == pytest.approx(shape.Volume, rel=0.02)
        assert len(mesh.face_nodes[face])


@pytest.mark.parametrize("name", ["cylinder", "cone_frustum", "bracket"])
def test_neighbours_that_are_missing_are_filled(name):
    """Between them there is no open edge that would tell where one ends."""
    shape = PARTS[name]()
    mesh, sides = without(shape, 0)
    kept = mesh.triangle_face != 1
    mesh = replace(mesh, triangles=mesh.triangles[kept], triangle_face=mesh.triangle_face[kept])
    mesh.face_nodes[1] = np.zeros((0, 3))
    mesh, filled, clean = fill(mesh, sides)
    assert filled == [0, 1] and clean and not fault_of(mesh, sides)
    volume = solid_volumes(mesh.points, mesh.triangles, sides[mesh.triangle_face], 1)[0]
    assert volume == pytest.approx(shape.Volume, rel=0.02)


def test_a_triangle_that_is_missing_is_filled():
    shape = PARTS["lofted"]()
    mesh, sides = without(shape, 0, slice(7, 8))
    mesh, filled, clean = fill(mesh, sides)
    assert filled == [0] and clean and not fault_of(mesh, sides)


def test_a_face_between_two_solids_is_filled_for_both():
    halves = [Part.makeBox(5, 10, 10), Part.makeBox(5, 10, 10, Vector(5, 0, 0))]
    shape = halves[0].generalFuse([halves[1]])[0]
    shared = next(
        n for n, face in enumerate(shape.Faces) if abs(face.CenterOfMass.x - 5) < 1e-9 and face.Area > 99
    )
    mesh, sides = without(shape, shared)
    mesh, filled, _ = fill(mesh, sides)
    assert filled == [shared] and not fault_of(mesh, sides)


def test_nothing_is_filled_where_no_face_is_missing():
    mesh = tessellate(CadElements(Part.Solid(Part.Shell(Part.makeBox(10, 10, 10).Faces[:5]))), 0.1, 0.3)
    assert fill(mesh, mesh.cad.sides)[1] == []


def test_arcs_that_touch_in_a_cusp():
    """OCC cuts the long arc into chords that cross the short one's, beside the point where they touch."""
    boss = Part.makeCylinder(8, 9, Vector(0, 50, -2))
    middle = Rotation(Vector(0, 0, 1), -40).multVec(Vector(0, 50, 0))
    other = Part.makeCylinder(8, 9, Vector(middle.x, middle.y, -2))
    ring = Part.makeCylinder(58, 5).cut(Part.makeCylinder(42, 5))
    sector = Part.makeCylinder(60, 5, Vector(0, 0, 0), Vector(0, 0, 1), 40)
    sector.rotate(Vector(0, 0, 0), Vector(0, 0, 1), 50)
    shape = ring.common(sector).fuse([boss, other]).removeSplitter()
    far = Part.makeBox(1, 1, 1, Vector(2000, 0, 0))
    whole = Part.Compound([*shape.Solids, far])
    assert volume_of(whole) == pytest.approx(whole.Volume, rel=0.02)


def test_a_part_of_two_micrometres():
    shape = PARTS["bracket"]().copy()
    factor = 2e-3 / shape.BoundBox.DiagonalLength
    shape.scale(factor)
    assert volume_of(shape) == pytest.approx(PARTS["bracket"]().Volume * factor**3, rel=0.01)


def test_an_open_solid_beside_others_is_left_out():
    box = Part.makeBox(10, 10, 10)
    broken = Part.Solid(Part.Shell(Part.makeBox(10, 10, 10, Vector(20, 0, 0)).Faces[:5]))
    converted = convert(Part.Compound([broken, box]))
    assert [plc.solid_numbers.tolist() for plc in converted.plcs] == [[2]]
    assert any(text.startswith("Solid1 left out: ") for text in converted.plcs[0].warnings)
    with pytest.raises(MeshError, match="open_shell"):
        convert(broken)


def test_a_solid_without_volume_beside_others_is_left_out():
    face = Part.makePlane(10, 10, Vector(20, 0, 0))
    flat = Part.Solid(Part.Shell([face, face.copy().reversed()]))
    converted = convert(Part.Compound([flat, Part.makeBox(10, 10, 10)]))
    assert [plc.solid_numbers.tolist() for plc in converted.plcs] == [[2]]


def test_a_solid_that_cannot_be_meshed_is_left_out(monkeypatch):
    core = pipeline.extension.load()

    class Core:
        @staticmethod
        def mesh(plc, *rest):
            if np.abs(plc["points"][:, 0]).max() > 15:
                raise MeshError("boundary", "lost", "cannot be done")
            return core.mesh(plc, *rest)

    Core.crossings = staticmethod(core.crossings)
    monkeypatch.setattr(pipeline.extension, "load", Core)
    apart = Part.Compound([Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, Vector(20, 0, 0))])
    mesh = pipeline.run(apart, {"max_size": 5.0})
    assert set(mesh.tet_solid.tolist()) == {1}
    assert any(text.startswith("Solid2 left out: boundary: cannot be done") for text in mesh.warnings)
    with pytest.raises(MeshError, match="cannot be done"):
        pipeline.run(apart.Solids[1], {"max_size": 5.0})


def test_the_strip_of_a_thread_keeps_its_triangles():
    """It winds round its cylinder more than once, but beside itself."""
    cylinder = Part.Cylinder()
    cylinder.Radius = 5
    corners = [Base.Vector2d(*place) for place in ((0, 0), (9, 9), (9, 10), (0, 1))]
    sides = zip(corners, corners[1:] + corners[:1])
    edges = [Part.Geom2d.Line2dSegment(a, b).toShape(cylinder) for a, b in sides]
    face = Part.Face(cylinder, Part.Wire(edges))
    face.validate()
    assert tessellation.winds(face, face.Surface)
    mesh = tessellate(CadElements(face), 0.05, 0.3)
    corners = mesh.points[mesh.triangles]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(areas, axis=1).sum() / 2 == pytest.approx(45, rel=0.02)


def test_a_winding_face_that_does_not_meet_its_neighbours_goes(monkeypatch):
    cad = CadElements(Part.makeCylinder(5, 10))
    wall = next(n for n, surface in enumerate(cad.surfaces) if isinstance(surface, Part.Cylinder))
    monkeypatch.setattr(tessellation, "winds", lambda _, surface: isinstance(surface, Part.Cylinder))
    assert (tessellate(cad, 0.05, 0.3).triangle_face == wall).any()
    whole = tessellation.gathered

    def torn(*arguments):
        mesh = whole(*arguments)
        rest = np.arange(len(mesh.triangles)) != np.flatnonzero(mesh.triangle_face == wall)[0]
        return replace(mesh, triangles=mesh.triangles[rest], triangle_face=mesh.triangle_face[rest])

    monkeypatch.setattr(tessellation, "gathered", torn)
    assert not (tessellate(cad, 0.05, 0.3).triangle_face == wall).any()


def test_a_face_that_laps_itself_is_made_from_its_outline(monkeypatch):
    """Its edges lie on the surface's parameters a turn apart; OCC covers it five times then."""
    turned = SimpleNamespace(ParameterRange=(-0.5 * math.pi, 2 * math.pi, 0.0, 1.0))
    assert tessellation.winds(turned, Part.Cylinder())
    assert not any(tessellation.winds(face, face.Surface) for face in PARTS["torus"]().Faces)
    monkeypatch.setattr(tessellation, "laps_itself", lambda *_: True)
    rounded = Part.makeBox(10, 10, 10)
    rounded = rounded.makeFillet(3, [rounded.Edges[0], rounded.Edges[1], rounded.Edges[4]])
    for number, face in enumerate(rounded.Faces):
        monkeypatch.setattr(
            tessellation,
            "winds",
            lambda other, _, c=face.CenterOfMass: other.CenterOfMass.isEqual(c, 1e-6),
        )
        plc = convert(rounded).plc
        plc.check()
        assert plc.warnings == [
            "OpenCASCADE left gaps in the triangles of Face%d; they were filled" % (number + 1)
        ]
        assert volume_of(rounded) == pytest.approx(rounded.Volume, rel=0.02)


def test_a_volume_that_is_not_the_one_of_the_cad_program_is_said():
    box = CadElements(Part.makeBox(10, 10, 10))
    mesh = tessellate(box, 0.1, 0.3)
    assert volume_warnings(mesh, box.sides) == []
    (warning,) = volume_warnings(replace(mesh, points=0.9 * mesh.points), box.sides)
    assert warning.startswith("Solid1: its triangles enclose 729 mm3, but the CAD program says 1000 mm3")
