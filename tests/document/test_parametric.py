"""Faces triangulated in the parameters of their surface: narrow torus strips, walls of springs."""

import MeshPart
import numpy as np
import Part
import pytest
from FreeCAD import Vector

from DelaunayMesher import pipeline
from DelaunayMesher.document import parametric
from DelaunayMesher.document.closed import solid_volumes
from DelaunayMesher.document.parametric import area_of, bending_lines, is_narrow, parametric_facets
from DelaunayMesher.document.plc_from_shape import convert
from DelaunayMesher.errors import MeshError


@pytest.mark.parametrize("reversed_strip", [False, True])
def test_a_part_with_a_narrow_torus_face_closes(reversed_strip):
    torus = Part.makeTorus(100, 30, Vector(0, 0, 0), Vector(0, 0, 1), 0, 360, 170)
    slab = Part.makeBox(400, 400, 0.5, Vector(-200, -200, 0))
    part = slab.cut(torus) if reversed_strip else slab.common(torus)
    assert any(is_narrow(face, face.Surface) for face in part.Faces)
    plc = convert(part).plc
    sides = plc.face_solids[plc.triangle_face]
    volumes = solid_volumes(plc.points, plc.triangles, sides, plc.solid_count)
    assert np.abs(volumes).sum() == pytest.approx(part.Volume, rel=0.02)
    for number, face in enumerate(part.Faces):
        if is_narrow(face, face.Surface):
            assert (plc.triangle_face == number).any()
            counted = len(np.unique(plc.triangles[plc.triangle_face == number]))
            assert (plc.triangle_face == number).sum() == counted - 2  # no node inside


def spring(turns, pitch=4):
    """A wire of radius 1 round a cylinder of radius 8, one turn every 4 mm."""
    helix = Part.makeHelix(pitch, pitch * turns, 8)
    section = Part.Wire([Part.makeCircle(1, Vector(8, 0, 0), Vector(0, 1, 0))])
    return Part.Wire(helix.Edges).makePipeShell([section], True, True)


SPRINGS = {
    "fillet": lambda: with_round_end(spring(2)),
    "chamfer": lambda: with_sharp_end(spring(3)),
    "cut": lambda: spring(1.5).cut(Part.makeSphere(1.3, Vector(8, 0, 4))),
    "fused": lambda: spring(2).fuse(Part.makeSphere(1.5, Vector(8, 0, 0))),
}


def with_round_end(wire):
    return wire.makeFillet(0.2, [wire.Faces[1].Edges[0]])


def with_sharp_end(wire):
    return wire.makeChamfer(0.1, [wire.Faces[1].Edges[0]])


@pytest.mark.parametrize("name", sorted(SPRINGS))
def test_springs_keep_their_turns(name):
    """OCC 7.6 and 7.8 leave out most of the wall: the triangles of a face do not have its area."""
    part = SPRINGS[name]()
    found, volume = np.zeros(len(part.Faces)), 0.0
    for plc in convert(part).plcs:  # the cut one falls into two
        a, b, c = (plc.points[plc.triangles[:, k]] for k in range(3))
        areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        found += np.bincount(plc.triangle_face, areas, minlength=len(part.Faces))
        sides = plc.face_solids[plc.triangle_face]
        volume += solid_volumes(plc.points, plc.triangles, sides, plc.solid_count).sum()
    assert found == pytest.approx(np.array([face.Area for face in part.Faces]), rel=0.02)
    assert volume == pytest.approx(part.Volume, rel=0.06)  # facets lie inside the round wire


def test_a_spring_with_a_fillet_meshes_well():
    mesh = pipeline.run(SPRINGS["fillet"](), {"max_size": 1.5})
    assert mesh.report()["quality"]["min_dihedral"] > 25


@pytest.mark.parametrize("gap", [0.1, 0.02])
def test_coils_that_nearly_touch_are_kept_apart(gap):
    """Both sides of the gap are one face, nearer to each other than the triangles are to the surface."""
    mesh = pipeline.run(spring(3, 2 + gap), {"max_size": 1.5})
    report = mesh.report()
    assert not [w for w in report["warnings"] if "replaced" in w]
    assert report["quality"]["min_dihedral"] > 25


QUARTER = Part.makeBox(200, 200, 40, Vector(0, -200, -20))


@pytest.mark.parametrize("angle, keep_quarter", [(10, True), (-20, False)])
def test_the_narrow_fillet_of_a_disc_that_was_cut(angle, keep_quarter):
    disc = Part.makeCylinder(120, 5)
    rounded = disc.makeFillet(1, [disc.Edges[0]])
    tool = QUARTER.copy()
    tool.rotate(Vector(0, 0, 0), Vector(0.1, 0.2, 1), angle)
    part = rounded.common(tool) if keep_quarter else rounded.cut(tool)
    mesh = pipeline.run(part, {"max_size": 5.0})
    assert mesh.report()["quality"]["min_dihedral"] > 20
    plc = convert(part).plc
    for number, face in enumerate(part.Faces):
        if is_narrow(face, face.Surface):
            mine = plc.points, plc.triangles[plc.triangle_face == number].tolist()
            assert 0.89 * face.Area < area_of(mine) < face.Area  # chords of a quarter circle: 0.90


def test_a_narrow_strip_without_an_outline_in_its_parameters_keeps_the_triangles_of_occ(monkeypatch):
    def crossing(*_):
        raise MeshError("plc", "bad_facet", "the outline of a face crosses itself")

    monkeypatch.setattr(parametric, "parametric_facets", crossing)
    disc = Part.makeCylinder(120, 5)
    part = disc.makeFillet(1, [disc.Edges[0]]).cut(QUARTER)
    plc = convert(part).plc
    strip = next(number for number, face in enumerate(part.Faces) if is_narrow(face, face.Surface))
    assert (plc.triangle_face == strip).any()


ROUND_FACES = {
    "cylinder": lambda: Part.makeCylinder(5, 20),
    "part of a cylinder": lambda: Part.makeCylinder(5, 20, Vector(0, 0, 0), Vector(0, 0, 1), 200),
    "sphere": lambda: Part.makeSphere(5),
    "cone with its tip": lambda: Part.makeCone(5, 0, 10),
    "torus": lambda: Part.makeTorus(10, 3),
    "cylinder with a hole": lambda: Part.makeCylinder(5, 20).cut(
        Part.makeCylinder(2, 20, Vector(0, 0, 10), Vector(1, 0, 0))
    ),
    "cylinder with an edge inside": lambda: Part.makeCylinder(5, 20).generalFuse(
        [Part.makeLine(Vector(0, 5, 5), Vector(0, 5, 15))], 1e-5
    )[0],
    # The seam of the whole bounds them, and is a seam for OCC still, though they have it once.
    "three quarters of a torus": lambda: Part.makeTorus(10, 3).cut(QUARTER),
    "a quarter of a cylinder": lambda: Part.makeCylinder(5, 20).common(QUARTER),
    "reversed": lambda: Part.makeBox(20, 20, 20).cut(Part.makeSphere(6, Vector(10, 10, 10))),
}


@pytest.mark.parametrize("name", sorted(ROUND_FACES))
def test_facets_have_the_area_and_the_direction_of_the_face(name):
    """With seams, poles, holes, and a normal against that of the parameters."""
    part = ROUND_FACES[name]()
    MeshPart.meshFromShape(Shape=part, LinearDeflection=0.02, AngularDeflection=0.2)
    curved = [face for face in part.Faces if not isinstance(face.Surface, Part.Plane)]
    for face in curved:
        lines = [
            [] if edge.Degenerated else face.getLinesFromSubElement("Edge", number)[0]
            for number, edge in enumerate(face.Edges, 1)
        ]
        nodes, triangles = parametric_facets(face, face.Surface, lines, *bending_lines(face, face.Surface))
        assert area_of((nodes, triangles)) == pytest.approx(face.Area, rel=0.02)
        for corners in triangles:
            a, b, c = (nodes[corner] for corner in corners)
            normal, middle = (b - a).cross(c - a), (a + b + c) / 3
            if normal.Length > 1e-6:
                assert normal.dot(face.normalAt(*face.Surface.parameter(middle))) > 0
