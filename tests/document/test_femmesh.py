"""FreeCAD's FEM mesh is filled in two steps, with the numbers that the groups rely on."""

import Fem
import FreeCAD
import numpy as np
import Part
import pytest

from DelaunayMesher import document
from DelaunayMesher.document import femmesh
from DelaunayMesher.errors import MeshError


@pytest.fixture(scope="module", params=[1, 2])
def mesh(request):
    return document.mesh_shape(
        Part.makeBox(4, 4, 4), document.make_options(max_size=1.5, order=request.param)
    )


def contents(filled):
    """{name: (kind, numbers)} of the groups."""
    return {
        filled.getGroupName(group): (filled.getGroupElementType(group), filled.getGroupElements(group))
        for group in filled.Groups
    }


@pytest.mark.parametrize("part", [1, 7, 10**6])
def test_an_object_gets_all_groups_in_whatever_parts(mesh, part, monkeypatch):
    wanted = [("Press", ["Face1", "Face4"]), ("Corner", ["Vertex1"])]
    complete = document.fem_mesh(mesh, wanted)
    monkeypatch.setattr(femmesh, "SMALLEST_PART", part)
    file = FreeCAD.newDocument("filled")
    try:
        target = file.addObject("Fem::FemMeshObject", "Mesh")
        turns = list(femmesh.put(target, femmesh.fill(mesh, wanted)))
        assert contents(target.FemMesh) == contents(complete)
        assert len(turns) > target.FemMesh.GroupCount
    finally:
        FreeCAD.closeDocument(file.Name)


def test_groups_mean_the_elements_that_the_mesh_says(mesh):
    filled = document.fem_mesh(mesh)
    kind, numbers = contents(filled)["Face3"]
    assert kind == "Face"
    found = {frozenset(filled.getElementNodes(number)) for number in numbers}
    assert found == {frozenset(nodes) for nodes in (mesh.triangles[mesh.triangle_face == 2] + 1).tolist()}
    assert sorted(contents(filled)["Solid1"][1]) == sorted(filled.Volumes)


@pytest.mark.parametrize("ending", [".med", ".unv"])
def test_freecad_reads_its_files_back_with_all_groups(mesh, tmp_path, ending):
    mesh.write(tmp_path / ("a" + ending))
    made, read = document.fem_mesh(mesh), Fem.read(str(tmp_path / ("a" + ending)))
    assert places_of_groups(read) == places_of_groups(made)
    assert len(places_of_groups(read)["Solid1"]) == len(mesh.tets)
    points = np.array([read.Nodes[number] for number in sorted(read.Nodes)])
    assert np.abs(points - mesh.points).max() < 1e-9


def places_of_groups(filled):
    """{name: the elements as the places of their nodes in order} of the groups."""
    places = {number: tuple(np.round(place, 6)) for number, place in filled.Nodes.items()}
    return {
        name: {tuple(places[node] for node in filled.getElementNodes(number)) for number in numbers}
        for name, (_, numbers) in contents(filled).items()
    }


def test_other_numbers_than_expected_are_noticed():
    target = Fem.FemMesh()
    target.addNode(9.0, 9.0, 9.0)
    with pytest.raises(MeshError, match="numbered"):
        femmesh.add(target, "Node", np.zeros((3, 3)), 1)
