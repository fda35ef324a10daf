"""The recipes of docs/fem.md run as they stand there; the input for Z88 and Elmer is what it should be."""

import re
import shutil
from pathlib import Path

import FreeCAD
import numpy as np
import pytest

RECIPES = re.findall(
    r"^### (.*?)$.*?^```python\n(.*?)^```$",
    (Path(__file__).parents[2] / "docs" / "fem.md").read_text(encoding="utf-8"),
    re.M | re.S,
)


@pytest.fixture(scope="module")
def recipes(tmp_path_factory):
    """(folder, names that the recipes define) after all of them ran there, one after the other."""
    if not shutil.which("ccx"):
        pytest.skip("CalculiX (ccx) is not installed")
    folder, names = tmp_path_factory.mktemp("recipes"), {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for title, code in RECIPES:
            exec(compile(code, "docs/fem.md: " + title, "exec"), names)
    yield folder, names
    FreeCAD.closeDocument(names["doc"].Name)


def test_calculix(recipes):
    folder, names = recipes
    beam = 1000 * 100.0**3 / (3 * 210000 * 10.0**4 / 12)
    assert max(names["result"].DisplacementLengths) == pytest.approx(beam, rel=0.02)
    assert (folder / "beam.FCStd").exists()


def test_z88(recipes):
    folder, names = recipes
    mesh = names["mesh"].FemMesh
    rows = [line.split() for line in (folder / "z88i1.txt").read_text().splitlines() if line.strip()]
    nodes, elements = mesh.NodeCount, mesh.VolumeCount
    assert [int(number) for number in rows[0][:3]] == [3, nodes, elements]
    places = np.array(rows[1 : 1 + nodes], dtype=float)[:, 2:5]
    assert {row[1] for row in rows[1 + nodes :: 2][:elements]} == {"16"}  # ten-node tetrahedra
    corners = np.array(rows[2 + nodes :: 2], dtype=int)
    a, b, c, d = (places[corners[:, k] - 1] for k in range(4))
    volume = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    assert len(set(np.sign(volume))) == 1
    assert np.abs(volume).sum() == pytest.approx(100 * 10 * 10)
    conditions = [line.split() for line in (folder / "z88i2.txt").read_text().splitlines()[1:]]
    assert abs(sum(float(value) for *_, kind, value in conditions if kind == "1")) == pytest.approx(1000)
    held = {int(node) for node, _, kind, _ in conditions if kind == "2"}
    assert held == set(mesh.getNodesByFace(names["beam"].Shape.Faces[0]))


def test_elmer(recipes):
    import Fem

    folder, names = recipes
    mesh, again = names["mesh"].FemMesh, Fem.FemMesh()
    again.read(str(folder / "mesh.unv"))
    assert (again.NodeCount, again.VolumeCount) == (mesh.NodeCount, mesh.VolumeCount)
    sizes = [
        {item.getGroupName(group): len(item.getGroupElements(group)) for group in item.Groups}
        for item in (mesh, again)
    ]
    case = (folder / "case.sif").read_text()
    named = set(re.findall(r'"?((?:Solid|Face)\d+)"?', case))
    assert named == {"Solid1", "Face1", "Face2"}
    assert all(sizes[0][name] == sizes[1][name] > 0 for name in named)
