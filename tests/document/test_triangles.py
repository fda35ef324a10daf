"""A mesh of triangles in a document, such as an opened STL file, is meshed as a solid is."""

import FreeCAD
import Mesh
import numpy as np
import ObjectsFem
import pytest

from DelaunayMesher import document
from DelaunayMesher.document.mesh_object import collect, is_current
from DelaunayMesher.document.placement import GLOBAL_SINCE, version
from DelaunayMesher.document.preview import preview
from DelaunayMesher.errors import InputError, MeshError
from DelaunayMesher.quality import volumes


@pytest.fixture
def file():
    opened = FreeCAD.newDocument("triangles")
    yield opened
    FreeCAD.closeDocument(opened.Name)


@pytest.fixture
def cube(file):
    item = file.addObject("Mesh::Feature", "Cube")
    item.Mesh = Mesh.createBox(10, 10, 10)  # round the origin
    return item


def test_it_is_filled_and_has_groups(cube):
    target = document.add_mesh(cube, max_size=3.0, order=2, sizes={"Face1": 1.0})
    mesh = document.run(target)
    assert volumes(mesh.points, mesh.tets).sum() == pytest.approx(1000)
    assert target.FemMesh.VolumeCount == len(mesh.tets) and target.Shape == cube
    names = {target.FemMesh.getGroupName(group) for group in target.FemMesh.Groups}
    assert {"Face1", "Face6", "Edge12", "Solid1"} <= names


def test_its_mesh_is_current_until_triangles_or_options_change(file, cube, tmp_path):
    target = document.add_mesh(cube, max_size=3.0)
    document.run(target)
    assert is_current(target)
    path = str(tmp_path / "cube.FCStd")
    file.saveCopy(path)
    again = FreeCAD.openDocument(path)
    assert is_current(again.getObject(target.Name))
    FreeCAD.closeDocument(again.Name)
    target.Growth = 0.3
    assert not is_current(target)
    target.Growth = 0.35
    assert is_current(target)
    cube.Mesh = Mesh.createBox(10, 10, 11)
    assert not is_current(target)


def test_the_mesh_is_where_the_triangles_are(file, cube):
    container = file.addObject("App::Part", "Container")
    container.addObject(cube)
    container.Placement.Base = FreeCAD.Vector(0, 100, 0)
    cube.Placement.Base = FreeCAD.Vector(50, 0, 0)
    file.recompute()
    mesh = document.run(document.add_mesh(cube, max_size=5.0))
    outer = 100 if version() >= GLOBAL_SINCE else 0  # as for a solid
    assert np.allclose(
        [mesh.points.min(axis=0), mesh.points.max(axis=0)], [[45, outer - 5, -5], [55, outer + 5, 5]]
    )


def test_the_preview_predicts_its_elements(cube):
    target = document.add_mesh(cube, max_size=1.0)
    task = collect(target)
    expected = preview(task.shape, task.options, task.keep).count
    assert expected == pytest.approx(len(document.run(target).tets), rel=0.15)


def test_what_cannot_be_meshed_is_said(file, cube):
    with pytest.raises(InputError, match="Nothing has no visible shape"):
        document.run(document.add_mesh(file.addObject("Mesh::Feature", "Nothing")))
    target = document.add_mesh(cube, max_size=3.0)
    refinement = ObjectsFem.makeMeshRegion(file, target, 0.8)
    refinement.References = [(cube, "Face1")]  # FreeCAD's references need a shape
    with pytest.raises(InputError, match="Face1 of Cube is not an element"):
        document.run(target)
    file.removeObject(refinement.Name)
    open_mesh = cube.Mesh.copy()
    open_mesh.removeFacets([0])
    cube.Mesh = open_mesh
    with pytest.raises(MeshError, match="not closed: 3 open edges"):
        document.run(target)
