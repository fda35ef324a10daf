"""Refinements and constraints refer to the meshed part, to another feature, or to something that is gone."""

import FreeCAD
import numpy as np
import ObjectsFem
import pytest

from DelaunayMesher import document
from DelaunayMesher.document.mesh_object import collect
from DelaunayMesher.errors import InputError
from DelaunayMesher.quality import edge_lengths

MOVED = 50.0  # mm


@pytest.fixture
def file():
    opened = FreeCAD.newDocument("references")
    yield opened
    FreeCAD.closeDocument(opened.Name)


@pytest.fixture
def body(file):
    """A block of 20 x 10 x 10 mm with a hole, moved along x."""
    body = file.addObject("PartDesign::Body", "Body")
    block = body.newObject("PartDesign::AdditiveBox", "Block")
    block.Length, block.Width, block.Height = 20, 10, 10
    hole = body.newObject("PartDesign::SubtractiveCylinder", "Hole")
    hole.Radius, hole.Height = 1.5, 10
    hole.Placement.Base = FreeCAD.Vector(10, 5, 0)
    body.Placement.Base = FreeCAD.Vector(MOVED, 0, 0)
    file.recompute()
    assert body.Tip == hole and body.Shape.BoundBox.XMin == pytest.approx(MOVED)
    return body


def face_at(item, x):
    """Name of the face of an object's shape that lies in the plane x."""
    faces = enumerate(item.Shape.Faces, 1)
    return next("Face%d" % n for n, f in faces if f.BoundBox.XMax < x + 1e-6 and f.BoundBox.XMin > x - 1e-6)


def refine(target, *reference):
    """FreeCAD's refinement to 0.8 mm on (object, element)."""
    refinement = ObjectsFem.makeMeshRegion(target.Document, target, 0.8)
    refinement.References = [reference]
    return refinement


def constrain(target, item, element):
    """A fixed constraint on (object, element) in an analysis with the mesh object."""
    analysis = ObjectsFem.makeAnalysis(target.Document, "Analysis")
    fixed = ObjectsFem.makeConstraintFixed(target.Document, "Fixed")
    fixed.References = [(item, element)]
    analysis.addObject(fixed)
    analysis.addObject(target)


@pytest.mark.parametrize("feature, x", [("Hole", 0.0), ("Block", 0.0), ("Body", MOVED)])
def test_a_refinement_on_a_feature_of_a_body(file, body, feature, x):
    item = file.getObject(feature)
    target = document.add_mesh(body, max_size=4.0)
    refine(target, item, face_at(item, x))
    assert list(collect(target).options.sizes) == [face_at(body, MOVED)]
    mesh = document.run(target)
    ends = [np.abs(mesh.points[mesh.tets[:, 0], 0] - end) < 0.8 for end in (MOVED, MOVED + 20)]
    fine, coarse = (edge_lengths(mesh.points, mesh.tets[end]).mean() for end in ends)
    assert fine < 1.2 and coarse > 2.0


@pytest.mark.parametrize("feature, x", [("Hole", 0.0), ("Block", 0.0), ("Body", MOVED)])
def test_a_constraint_on_a_feature_of_a_body(file, body, feature, x):
    item = file.getObject(feature)
    target = document.add_mesh(body, max_size=4.0)
    constrain(target, item, face_at(item, x))
    assert collect(target).keep == [face_at(body, MOVED)]


def test_a_constraint_on_what_the_part_does_not_have(file, body):
    other = file.addObject("Part::Box", "Other")
    file.recompute()
    target = document.add_mesh(body, max_size=4.0)
    constrain(target, other, "Face1")
    assert collect(target).keep == []


@pytest.mark.parametrize("kind, element", [("Part::Box", "Face99"), ("App::FeaturePython", "")])
def test_a_refinement_on_what_is_not_there(file, body, kind, element):
    other = file.addObject(kind, "Other")
    file.recompute()
    target = document.add_mesh(body, max_size=4.0)
    refine(target, other, element)
    with pytest.raises(InputError, match="Other") as caught:
        document.run(target)
    assert caught.value.code == "unknown_reference"


def test_a_container_with_nothing_visible(file):
    part, box = file.addObject("App::Part", "Assembly"), file.addObject("Part::Box", "Box")
    part.addObject(box)
    file.recompute()
    target = document.add_mesh(part, max_size=4.0)
    box.Visibility = False
    with pytest.raises(InputError, match="no visible shape") as caught:
        document.run(target)
    assert caught.value.code == "no_shape"


def group(target, *reference):
    """Makes a mesh group that refers to an element and runs the mesh object; the nodes in it, (n, 3)."""
    made = ObjectsFem.makeMeshGroup(target.Document, target, name="Chosen")
    made.References = [reference]
    document.run(target)
    mesh = target.FemMesh
    number = next(k for k in mesh.Groups if mesh.getGroupName(k) == made.Name)
    faces = mesh.getGroupElements(number)
    return np.array([mesh.getNodeById(node) for face in faces for node in mesh.getElementNodes(face)])


@pytest.mark.parametrize("element", ["Face9", "Edge99", "Solid2", "Vertex99"])
def test_a_group_of_what_the_part_does_not_have(file, element):
    box = file.addObject("Part::Box", "Box")
    file.recompute()
    with pytest.raises(InputError, match="%s of Box" % element):
        group(document.add_mesh(box, max_size=4.0), box, element)


def test_a_path_into_a_container(file):
    part, boxes = (
        file.addObject("App::Part", "Assembly"),
        [file.addObject("Part::Box", n) for n in ("A", "B")],
    )
    boxes[1].Placement.Base.x = 30
    part.addObjects(boxes)
    file.recompute()
    nodes = group(document.add_mesh(part, max_size=4.0), part, "B.Face1")
    assert len(nodes) > 4 and np.allclose(nodes[:, 0], 30)


def test_a_mesh_is_no_part(file):
    box = file.addObject("Part::Box", "Box")
    file.recompute()
    target = document.add_mesh(box, max_size=4.0)
    with pytest.raises(InputError, match="no shape to mesh"):
        document.add_mesh(target, max_size=4.0)
    other = document.add_mesh(box, max_size=4.0)
    other.Shape = target
    with pytest.raises(InputError, match="no visible shape"):
        document.run(other)
