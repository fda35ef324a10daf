import dataclasses
import os
import tracemalloc

import numpy as np
import pytest

from DelaunayMesher import meshfile, quality
from DelaunayMesher.errors import InputError
from DelaunayMesher.options import MeshOptions
from DelaunayMesher.result import Mesh

meshio = pytest.importorskip("meshio")
WITH_DATA = (".vtu", ".vtk", ".xdmf")
WITHOUT_FREECAD = [ending for ending in meshfile.MESH_ENDINGS if ending not in meshfile.BY_FREECAD]
TETS_ONLY = (".inp",)


def two_tets(order):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
    tets = np.array([[0, 1, 2, 3], [1, 4, 2, 3]], np.int32)
    assert (quality.volumes(points, tets) > 0).all()
    triangles = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 4], [1, 4, 3], [2, 3, 4]], np.int32)
    lines = np.array([[0, 1]], np.int32)
    if order == 2:
        middles = {}

        def middle(a, b):
            return middles.setdefault((min(a, b), max(a, b)), 5 + len(middles))

        tets = np.array([[*t, *(middle(t[i], t[j]) for i, j in quality.EDGES)] for t in tets.tolist()])
        triangles = np.array(
            [[a, b, c, middle(a, b), middle(b, c), middle(a, c)] for a, b, c in triangles.tolist()]
        )
        lines = np.array([[0, 1, middle(0, 1)]])
        points = np.concatenate([points, [(points[a] + points[b]) / 2 for a, b in middles]])
    count = len(points)
    return Mesh(
        points=points,
        point_dimension=np.zeros(count, np.int8),
        point_entity=np.arange(count, dtype=np.int32),
        tets=tets,
        tet_solid=np.array([1, 2], np.int32),
        triangles=triangles,
        triangle_face=np.arange(6, dtype=np.int32),
        lines=lines,
        line_edge=np.zeros(1, np.int32),
        straightened=np.zeros(0, np.int32),
        below_target=[],
        options=MeshOptions(order=order),
        element_counts={"Vertex": 20, "Edge": 1, "Face": 6, "Solid": 2},
    )


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("ending", WITHOUT_FREECAD)
def test_formats_read_back(tmp_path, ending, order):
    mesh = two_tets(order)
    path = tmp_path / ("a" + ending)
    if order == 2 and ending == ".mesh":  # Medit's format has no elements of second order
        with pytest.raises(InputError):
            mesh.write(path)
        return
    mesh.write(path)
    assert [item.name for item in tmp_path.iterdir()] == [path.name]
    if order == 2 and ending == ".xdmf":
        assert path.stat().st_size > 0  # Debian's meshio cannot read its own mixed second order XDMF
        return
    back = meshio.read(path)
    assert np.allclose(back.points, mesh.points, atol=1e-6)
    kinds = ["tetra", "triangle"] if order == 1 else ["tetra10", "triangle6"]
    assert [cells.type for cells in back.cells] == (kinds[:1] if ending in TETS_ONLY else kinds)
    assert np.array_equal(back.cells[0].data, mesh.tets)
    if ending not in TETS_ONLY:
        assert np.array_equal(back.cells[1].data, mesh.triangles)
    if ending in WITH_DATA:
        assert [list(map(int, part)) for part in back.cell_data["solid"]] == [[1, 2], [0] * 6]
        assert [list(map(int, part)) for part in back.cell_data["face"]] == [[0, 0], [1, 2, 3, 4, 5, 6]]


def test_inp_files_hold_what_an_analysis_needs(tmp_path):
    """Read here by hand: no number longer than the 20 characters of CalculiX, all names as sets."""
    mesh = two_tets(2)
    mesh.points *= -np.pi / 1e7
    mesh.write(tmp_path / "a.inp")
    blocks, rows = {}, None
    for line in (tmp_path / "a.inp").read_text().splitlines():
        cells = line.replace(" ", "").split(",")
        if line.startswith("*"):
            rows = blocks.setdefault(line, [])
        else:
            assert len(cells) <= 16 and max(map(len, cells)) <= 19
            rows.extend(map(float, cells) if "NODE" in next(reversed(blocks)) else map(int, cells))
    points = np.reshape(blocks["*NODE, NSET=Nall"], (-1, 4))
    assert np.allclose(points[:, 1:], mesh.points, rtol=1e-11, atol=0)
    tets = np.reshape(blocks["*ELEMENT, TYPE=C3D10, ELSET=Eall"], (-1, 11))
    assert np.array_equal(tets, np.column_stack([[0, 1], mesh.tets]) + 1)
    assert blocks["*ELSET, ELSET=Solid1"] == [1] and blocks["*ELSET, ELSET=Solid2"] == [2]
    for name in ("Face1", "Face6", "Edge1"):
        assert blocks["*NSET, NSET=" + name] == (mesh.nodes_of(name) + 1).tolist()
    assert blocks["*NSET, NSET=Vertex3"] == [3]


def test_vtk_files_have_types_that_vtk_knows(tmp_path):
    two_tets(1).write(tmp_path / "a.vtk")
    written = (tmp_path / "a.vtk").read_bytes()
    assert b"face 1 8 vtktypeint64" in written and b"vtktypeint32" not in written


def test_msh_files_of_any_size_read_back(tmp_path):
    """meshio 5.0 cuts other data than Gmsh's tags at two values."""
    two = two_tets(1)
    three = np.concatenate([two.tets, two.tets[:1]])
    mesh = dataclasses.replace(two, tets=three, tet_solid=np.array([1, 2, 3], np.int32))
    mesh.write(tmp_path / "a.msh")
    back = meshio.read(tmp_path / "a.msh")
    assert [list(part) for part in back.cell_data["gmsh:physical"]] == [[1, 2, 3], [1, 2, 3, 4, 5, 6]]


@pytest.mark.parametrize("ending", meshfile.NASTRAN_ENDINGS)
def test_any_coordinate_fits_into_a_nastran_file(tmp_path, ending):
    """A field has 16 characters, and meshio stops at longer ones."""
    mesh = two_tets(1)
    mesh.points[:] = np.pi * np.array(
        [[-1e-18, 1e-18, -1], [-1e-310, 1e5, -1e5], [1, 1, 1], [-1e-9, 1, 0], [1e11, -1e11, 1e-9]]
    )
    mesh.write(tmp_path / ("a" + ending))
    back = meshio.read(tmp_path / ("a" + ending))
    assert np.allclose(back.points, mesh.points, rtol=1e-9, atol=1e-99)
    assert [list(part) for part in back.cell_data["nastran:ref"]] == [[1, 2], [3, 4, 5, 6, 7, 8]]


def test_what_cannot_be_written(tmp_path):
    mesh = two_tets(1)
    for name in ("a.stl", "a.xyz", "a", "missing/a.vtu"):
        with pytest.raises(InputError):
            mesh.write(tmp_path / name)
    with pytest.raises(InputError):
        two_tets(2).write(tmp_path / "a.mesh")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ending", [".vtu", ".inp", ".FCStd"])
def test_permissions_are_asked_for_before_meshing(tmp_path, monkeypatch, ending):
    path = tmp_path / ("a" + ending)
    path.write_text("an old mesh")
    meshfile.check_output(path)
    locked = []
    real = os.access
    monkeypatch.setattr(os, "access", lambda place, mode: str(place) not in locked and real(place, mode))
    for place, words in ((tmp_path, "permission to write into"), (path, "permission to replace")):
        locked[:] = [str(place)]
        with pytest.raises(InputError, match=words):
            meshfile.check_output(path)
    (tmp_path / "folder.vtu").mkdir()
    with pytest.raises(InputError, match="is a folder"):
        meshfile.check_output(tmp_path / "folder.vtu")


def test_a_vertex_of_solids_meshed_apart_keeps_all_its_points():
    mesh = two_tets(1)
    mesh.point_dimension[[0, 3]], mesh.point_entity[[0, 3]] = 0, 7
    assert mesh.vertex_points()["Vertex8"].tolist() == mesh.nodes_of("Vertex8").tolist() == [0, 3]


def test_nodes_of_elements():
    mesh = two_tets(2)
    assert mesh.nodes_of("Edge1").tolist() == sorted(mesh.lines[0])
    assert mesh.nodes_of("Face1").tolist() == sorted(mesh.triangles[0])
    assert mesh.nodes_of("Solid2").tolist() == sorted(mesh.tets[1])
    assert mesh.nodes_of("Vertex3").tolist() == [2]
    assert len(mesh.nodes_of("Vertex20")) == 0  # absorbed, say
    for name, words in (
        ("Nose1", "no name of a CAD element"),
        ("Face7", "Face1 to Face6"),
        ("Edge2", "only Edge1"),
        ("Solid3", "Solid1 to Solid2"),
    ):
        with pytest.raises(InputError, match=words) as caught:
            mesh.nodes_of(name)
        assert name in str(caught.value)


def test_vtu_is_written_in_pieces(tmp_path):
    """A large mesh is not copied as a whole, and its pieces join up."""
    mesh, copies = two_tets(1), 150000
    for name in ("tets", "tet_solid", "triangles", "triangle_face"):
        array = getattr(mesh, name)
        setattr(mesh, name, np.tile(array, (copies, 1) if array.ndim == 2 else copies))
    tracemalloc.start()
    mesh.write(tmp_path / "a.vtu")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 0.5 * mesh.tets.nbytes
    back = meshio.read(tmp_path / "a.vtu")
    assert np.array_equal(back.cells[0].data, mesh.tets)
    assert np.array_equal(back.cells[1].data, mesh.triangles)
    assert np.array_equal(back.cell_data["solid"][0], mesh.tet_solid)
    assert np.array_equal(back.cell_data["face"][1], mesh.triangle_face + 1)
