"""The document object: made in two lines, filled by run(), kept on failure, saved, reopened, never meshed by
recomputing; FreeCAD's own refinements and groups work on it.
"""

import json

import Fem
import FreeCAD
import numpy as np
import ObjectsFem
import Part
import pytest
from parts import PARTS

from DelaunayMesher import document
from DelaunayMesher.document import femmesh
from DelaunayMesher.document.mesh_object import fingerprint, is_current, stored_report
from DelaunayMesher.document.size_region import regions_of
from DelaunayMesher.errors import InputError, MeshCancelled, MeshError
from DelaunayMesher.options import OPTIONS, MeshOptions
from DelaunayMesher.quality import edge_lengths
from DelaunayMesher.sizing import Region


@pytest.fixture
def file():
    opened = FreeCAD.newDocument("meshes")
    yield opened
    FreeCAD.closeDocument(opened.Name)


@pytest.fixture
def box(file):
    part = file.addObject("Part::Box", "Box")
    part.Length, part.Width, part.Height = 20, 10, 10
    file.recompute()
    return part


def counts(target):
    mesh = target.FemMesh
    return mesh.NodeCount, mesh.VolumeCount, mesh.FaceCount, mesh.EdgeCount


def test_two_lines_make_a_mesh(box):
    target = document.add_mesh(box, max_size=4.0, order=2)
    mesh = document.run(target)
    assert counts(target)[:2] == (len(mesh.points), len(mesh.tets)) and len(mesh.tets) > 50
    assert target.Proxy.Type == "Fem::FemMeshDelaunay" and target.Shape == box
    assert "%d tetrahedra" % len(mesh.tets) in target.Summary
    assert json.loads(target.Report)["tetrahedra"] == len(mesh.tets)


def test_every_option_is_a_property(box):
    target = document.add_mesh(box, growth=0.3, seed=7, order=2, optimise=False)
    for option in OPTIONS:
        assert option.property_name in target.PropertiesList
        assert target.getDocumentationOfProperty(option.property_name)
    assert (target.Growth, target.Seed, target.ElementOrder, target.Optimise) == (0.3, 7, "2nd", False)


def test_properties_decide(box):
    target = document.add_mesh(box, max_size=8.0)
    coarse = document.run(target)
    target.MaxSize = 3.0
    target.ElementOrder = "2nd"
    fine = document.run(target)
    assert len(fine.tets) > 4 * len(coarse.tets) and fine.order == 2
    assert counts(target)[1] == len(fine.tets)


def test_the_same_seed_gives_the_same_mesh(box):
    first = document.run(document.add_mesh(box, max_size=4.0))
    second = document.run(document.add_mesh(box, max_size=4.0))
    assert np.array_equal(first.points, second.points) and np.array_equal(first.tets, second.tets)


def test_recomputing_does_not_mesh(file, box):
    target = document.add_mesh(box, max_size=4.0)
    file.recompute()
    assert counts(target) == (0, 0, 0, 0)
    document.run(target)
    before = counts(target)
    box.Length = 60
    target.MaxSize = 1.0
    file.recompute()
    assert counts(target) == before


def test_save_and_reopen(file, box, tmp_path):
    target = document.add_mesh(box, max_size=4.0, order=2, sizes={"Face1": 1.5})
    document.run(target)
    before, summary, name = counts(target), target.Summary, target.Name
    path = str(tmp_path / "mesh.FCStd")
    file.saveCopy(path)
    again = FreeCAD.openDocument(path)
    try:
        target = again.getObject(name)
        assert counts(target) == before and target.Summary == summary
        assert type(target.Proxy).__name__ == "MeshDelaunay"
        assert (target.MaxSize.Value, target.ElementOrder, target.Sizes) == (4.0, "2nd", ["Face1=1.5"])
        assert target.FemMesh.GroupCount == 6 + 12 + 1
        document.run(target)
        assert counts(target) == before
    finally:
        FreeCAD.closeDocument(again.Name)


def test_an_old_object_gets_the_options_it_lacks(box):
    target = document.add_mesh(box, max_size=4.0)
    target.removeProperty("TargetAngle")
    target.removeProperty("Sizes")
    target.Proxy.onDocumentRestored(target)
    assert target.TargetAngle.Value == 20.0 and target.Sizes == []
    assert target.MaxSize.Value == 4.0


def test_a_failure_keeps_the_old_mesh(file, box):
    target = document.add_mesh(box, max_size=4.0)
    document.run(target)
    before, summary = counts(target), target.Summary
    target.Shape = file.addObject("Part::Plane", "Plane")
    file.recompute()
    with pytest.raises(MeshError, match="without a solid"):
        document.run(target)
    assert (counts(target), target.Summary) == (before, summary)


def test_cancelling_keeps_the_old_mesh(box):
    target = document.add_mesh(box, max_size=4.0)
    document.run(target)
    before = counts(target)
    target.MaxSize = 1.0
    seen = []

    def report(stage, fraction):
        seen.append((stage, fraction))
        return len(seen) < 4

    with pytest.raises(MeshCancelled):
        document.run(target, report)
    assert counts(target) == before
    with pytest.raises(MeshCancelled):
        document.run(target, lambda stage, fraction: False)


def test_wrong_options_create_nothing(file, box):
    objects = len(file.Objects)
    for wrong in ({"max_size": -1.0}, {"max_sise": 1.0}, {"order": 3}, {"sizes": {"Fase1": 1.0}}):
        with pytest.raises(InputError):
            document.add_mesh(box, **wrong)
    assert len(file.Objects) == objects
    target = document.add_mesh(box, sizes={"Face7": 1.0})
    with pytest.raises(InputError, match="Face7"):
        document.run(target)


def test_a_mesh_joins_the_given_analysis(file, box):
    analysis = ObjectsFem.makeAnalysis(file, "Analysis")
    target = document.add_mesh(box, analysis=analysis, max_size=5.0)
    assert target in analysis.Group
    assert document.add_mesh(box) not in analysis.Group


def mean_edge(mesh, name):
    """Mean edge length of the tetrahedra that touch a CAD element."""
    touching = np.isin(mesh.tets[:, :4], mesh.nodes_of(name)).any(axis=1)
    return edge_lengths(mesh.points, mesh.tets[touching]).mean()


def test_freecads_refinements_make_it_finer(file, box):
    target = document.add_mesh(box, max_size=4.0)
    refinement = ObjectsFem.makeMeshRegion(file, target, 0.8)
    refinement.References = [(box, "Face1")]
    mesh = document.run(target)
    assert mean_edge(mesh, "Face1") < 1.2
    assert mean_edge(mesh, "Face2") > 2.0
    empty = ObjectsFem.makeMeshRegion(file, target, 0.0)
    assert any(empty.Label in warning for warning in document.run(target).warnings)


def test_a_reference_to_a_part_of_the_part(file, box):
    """The refinement refers to the box from which the meshed part was cut."""
    hole = file.addObject("Part::Cylinder", "Hole")
    hole.Radius, hole.Placement.Base = 1.5, FreeCAD.Vector(10, 5, 0)
    cut = file.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = box, hole
    file.recompute()
    target = document.add_mesh(cut, max_size=4.0)
    refinement = ObjectsFem.makeMeshRegion(file, target, 0.8)
    refinement.References = [(box, "Face1")]  # x = 0, which the hole does not touch
    mesh = document.run(target)
    left = edge_lengths(mesh.points, mesh.tets[mesh.points[mesh.tets[:, 0], 0] < 0.8]).mean()
    assert left < 1.2
    refinement.References = [(box, "Face6")]  # the cut changed it
    with pytest.raises(InputError, match="not an element of the meshed part"):
        document.run(target)


def test_freecads_mesh_groups(file, box):
    target = document.add_mesh(box, max_size=4.0)
    group = ObjectsFem.makeMeshGroup(file, target, True)
    group.Label = "Loaded faces"
    group.References = [(box, ("Face1", "Face3"))]
    points = ObjectsFem.makeMeshGroup(file, target)
    points.References = [(box, ("Vertex1", "Vertex2"))]
    mesh = document.run(target)
    groups = {target.FemMesh.getGroupName(number): number for number in target.FemMesh.Groups}
    loaded = groups["Loaded faces"]
    assert target.FemMesh.getGroupElementType(loaded) == "Face"
    assert len(target.FemMesh.getGroupElements(loaded)) == np.isin(mesh.triangle_face, (0, 2)).sum()
    assert target.FemMesh.getGroupElementType(groups[points.Name]) == "Node"
    assert len(target.FemMesh.getGroupElements(groups[points.Name])) == 2


def test_a_seam_that_a_constraint_refers_to_has_nodes(file):
    cylinder = file.addObject("Part::Cylinder", "Cylinder")
    cylinder.Radius = 5
    file.recompute()
    seam = next(
        "Edge%d" % (number + 1)
        for number, edge in enumerate(cylinder.Shape.Edges)
        if edge.isSeam(cylinder.Shape.Faces[0])
    )
    analysis = ObjectsFem.makeAnalysis(file, "Analysis")
    target = document.add_mesh(cylinder, analysis=analysis, max_size=3.0)
    assert len(document.run(target).nodes_of(seam)) == 0
    fixed = ObjectsFem.makeConstraintFixed(file, "Fixed")
    fixed.References = [(cylinder, seam)]
    analysis.addObject(fixed)
    mesh = document.run(target)
    found = target.FemMesh.getNodesByEdge(cylinder.Shape.getElement(seam))
    assert sorted(found) == (mesh.nodes_of(seam) + 1).tolist() and len(found) > 3


def test_write_fcstd(box, tmp_path):
    shape = box.Shape.copy()
    ball = Region.ball((4, 5, 5), 2.0, 1.5)
    options = document.make_options(max_size=4.0, order=2, sizes={"Face2": 2.0}, regions=[ball])
    mesh = document.mesh_shape(shape, options)
    path = tmp_path / "out.FCStd"
    document.write_fcstd(str(path), mesh, shape, mesh.options)
    assert [item.name for item in tmp_path.iterdir()] == ["out.FCStd"]
    again = FreeCAD.openDocument(str(path))
    try:
        target = next(item for item in again.Objects if item.isDerivedFrom("Fem::FemMeshObject"))
        assert target.FemMesh.VolumeCount == len(mesh.tets)
        assert target.Shape.Shape.Volume == pytest.approx(2000)
        assert target.Sizes == ["Face2=2"] and regions_of(target) == [ball]
        assert len(document.run(target).tets) == len(mesh.tets)
    finally:
        FreeCAD.closeDocument(again.Name)
    with pytest.raises(InputError, match="No such"):
        document.write_fcstd(str(tmp_path / "none" / "out.FCStd"), mesh, shape)


@pytest.mark.parametrize("name", ["bracket", "lofted", "torus"])
def test_a_mesh_of_the_command_line_is_current_until_an_option_changes(name, tmp_path):
    shape = PARTS[name]()
    shape.Placement = FreeCAD.Placement(FreeCAD.Vector(1, 2, 3), FreeCAD.Rotation(10, 20, 30))
    ball = Region.ball((1 / 3, 5, 5), 2.0, shape.BoundBox.DiagonalLength / 30)
    options = document.make_options(sizes={"Face1": shape.BoundBox.DiagonalLength / 25}, regions=[ball])
    path = str(tmp_path / "out.FCStd")
    document.mesh_shape(shape, options).write(path)
    again = FreeCAD.openDocument(path)
    try:
        target = next(item for item in again.Objects if item.isDerivedFrom("Fem::FemMeshObject"))
        assert is_current(target)
        for name, value in (("Growth", 0.3), ("Sizes", [])):
            old = getattr(target, name)
            setattr(target, name, value)
            assert not is_current(target), name
            setattr(target, name, old)
            assert is_current(target), name
    finally:
        FreeCAD.closeDocument(again.Name)


def inner_edge(mesh, centre, radius):
    """Mean edge length of the tetrahedra with a corner in a ball."""
    inside = np.linalg.norm(mesh.points - centre, axis=1) < radius
    return edge_lengths(mesh.points, mesh.tets[inside[mesh.tets[:, :4]].any(axis=1)]).mean()


def test_size_regions_make_it_finer(file, box, tmp_path):
    target = document.add_mesh(box, max_size=4.0, regions=[Region.ball((4, 5, 5), 2.0, 0.7)])
    region = target.SizeRegionList[0]
    assert (region.Kind, region.Radius.Value, region.Size.Value) == ("Sphere", 2.0, 0.7)
    mesh = document.run(target)
    assert inner_edge(mesh, (4, 5, 5), 1.5) < 1.0 and inner_edge(mesh, (18, 5, 5), 3.0) > 2.0
    path = str(tmp_path / "region.FCStd")
    file.saveCopy(path)
    again = FreeCAD.openDocument(path)
    try:
        target = again.getObject(target.Name)
        assert type(target.SizeRegionList[0].Proxy).__name__ == "SizeRegion"
        assert len(document.run(target).tets) == len(mesh.tets)
    finally:
        FreeCAD.closeDocument(again.Name)


def test_size_regions_of_all_kinds(box):
    target = document.add_mesh(box, max_size=4.0)
    before = len(document.run(target).tets)
    region = document.add_size_region(target, Region.box((0, 0, 0), (3, 10, 10), 1.0))
    assert len(document.run(target).tets) > 2 * before
    region.Kind = "Cylinder"
    region.Point, region.SecondPoint = FreeCAD.Vector(0, 5, 5), FreeCAD.Vector(20, 5, 5)
    with pytest.raises(InputError, match=region.Label):
        document.run(target)
    region.Radius = 1.0
    assert len(document.run(target).tets) > 2 * before


def test_an_error_of_freecad_keeps_the_old_mesh(box, monkeypatch):
    target = document.add_mesh(box, max_size=4.0)
    document.run(target)
    before, summary, report = counts(target), target.Summary, target.Report

    def put_half(target, filling):
        target.FemMesh = filling.elements
        yield
        raise RuntimeError("no groups today")

    monkeypatch.setattr(femmesh, "put", put_half)
    target.MaxSize = 2.0
    with pytest.raises(RuntimeError, match="no groups today"):
        document.run(target)
    assert (counts(target), target.Summary, target.Report) == (before, summary, report)
    assert target.FemMesh.GroupCount == 6 + 12 + 1


def test_a_mesh_is_current_until_part_or_options_change(file, box):
    target = document.add_mesh(box, max_size=4.0)
    assert not is_current(target)
    document.run(target)
    target.Threads, target.MaxElements = 1, 10**6
    assert is_current(target)
    for item, name, value, old in (
        (target, "Growth", 0.3, 0.35),
        (target, "ElementOrder", "2nd", "1st"),
        (target, "Sizes", ["Face1=1"], []),
        (box, "Length", 20.01, 20),
    ):
        setattr(item, name, value)
        file.recompute()
        assert not is_current(target), name
        setattr(item, name, old)
        file.recompute()
        assert is_current(target), name
    target.FemMesh = Fem.FemMesh()
    assert not is_current(target) and stored_report(target) == {}


def test_drawing_or_storing_a_part_leaves_its_mesh_current(file):
    part = file.addObject("Part::Torus", "Ring")
    file.recompute()
    target = document.add_mesh(part, max_size=4.0)
    document.run(target)
    part.Shape.tessellate(2.0)  # what a window does; it changes the bounding box
    assert is_current(target)
    stored = Part.Shape()
    stored.importBrepFromString(part.Shape.exportBrepToString())
    assert fingerprint(stored, MeshOptions()) == fingerprint(part.Shape, MeshOptions())


def test_one_pole_of_a_spline_makes_another_part():
    def prism(bulge):
        places = [(0, 0, 0), (1, 0, 0), (2, bulge, 0), *((x, 3, 0) for x in range(3, 20)), (20, 0, 0)]
        places = [FreeCAD.Vector(place) for place in places]
        curve = Part.BSplineCurve()
        curve.buildFromPoles(places)
        outline = Part.Wire([curve.toShape(), Part.makeLine(places[-1], places[0])])
        return Part.Face(outline).extrude(FreeCAD.Vector(0, 0, 1))

    prints = {fingerprint(prism(bulge), MeshOptions()) for bulge in (1, 1.01, 1.1)}
    assert len(prints) == 3


def test_an_empty_shape_is_said(file):
    part = file.addObject("Part::Feature", "Nothing")
    for shape in (Part.Shape(), Part.Compound([])):
        part.Shape = shape
        with pytest.raises(InputError, match="Nothing has no visible shape"):
            document.run(document.add_mesh(part))
