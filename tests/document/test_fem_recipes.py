"""The recipes of docs/fem.md run as they stand there; the input for Z88 and Elmer is what it should be."""

import re
import shutil
import subprocess
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
    places, corners, conditions = read_z88(folder)
    assert (len(places), len(corners)) == (mesh.NodeCount, mesh.VolumeCount)
    a, b, c, d = (places[corners[:, k] - 1] for k in range(4))
    volume = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    assert len(set(np.sign(volume))) == 1
    assert np.abs(volume).sum() == pytest.approx(100 * 10 * 10)
    assert abs(sum(float(value) for *_, kind, value in conditions if kind == "1")) == pytest.approx(1000)
    held = {int(node) for node, _, kind, _ in conditions if kind == "2"}
    assert held == set(mesh.getNodesByFace(names["beam"].Shape.Faces[0]))


def read_z88(folder):
    """(nodes (n, 3), elements (m, 10) from 1, constraints (node, direction, kind, value)) of the input."""
    rows = [line.split() for line in (folder / "z88i1.txt").read_text().splitlines() if line.strip()]
    dimension, nodes, elements = map(int, rows[0][:3])
    assert dimension == 3 and {row[1] for row in rows[1 + nodes :: 2]} == {"16"}  # ten-node tetrahedra
    places = np.array(rows[1 : 1 + nodes], dtype=float)[:, 2:5]
    corners = np.array(rows[2 + nodes :: 2], dtype=int)
    assert corners.shape == (elements, 10)
    return places, corners, [line.split() for line in (folder / "z88i2.txt").read_text().splitlines()[1:]]


@pytest.mark.long
@pytest.mark.skipif(
    not shutil.which("z88f"),
    reason="optional: z88f, the solver of Z88, is not installed (Debian 12 has it in z88, later ones do not)",
)
def test_z88_solves(recipes, tmp_path):
    """What Z88 finds on the recipe's mesh, constraints and forces is what CalculiX finds.

    z88f is version 13, FreeCAD writes for 14: the first line is another one, and the material stands in the
    same file.  Nodes are numbered along the beam, or the solver would need minutes.
    """
    folder, names = recipes
    places, corners, conditions = read_z88(folder)
    order = np.argsort(places[:, 0], kind="stable")
    new = np.empty(len(order), dtype=int)
    new[order] = np.arange(1, len(order) + 1)
    lines = ["3 %d %d %d 1 0 0 0 0" % (len(places), len(corners), 3 * len(places))]
    lines += ["%d 3 %.9g %.9g %.9g" % (number, *places[old]) for number, old in enumerate(order, 1)]
    for number, nodes in enumerate(new[corners - 1].tolist(), 1):
        lines += ["%d 16" % number, " ".join(map(str, nodes))]
    lines += ["1 %d %s 4 0" % (len(corners), (folder / "51.txt").read_text().strip())]
    (tmp_path / "z88i1.txt").write_text("\n".join(lines) + "\n")
    moved = sorted((new[int(node) - 1], *rest) for node, *rest in conditions)
    rows = ["%d %s %s %s" % row for row in moved]
    (tmp_path / "z88i2.txt").write_text("\n".join(["%d" % len(rows), *rows]) + "\n")
    (tmp_path / "z88i3.txt").write_text("4 0 1\n")
    memory = Path("/usr/share/z88/z88.dyn").read_text()
    (tmp_path / "z88.dyn").write_text(re.sub(r"(MAXGS|MAXIEZ|MAXKOI) +\d+", r"\1 60000000", memory))
    subprocess.run(["z88f", "-c"], cwd=tmp_path, stdout=subprocess.DEVNULL, timeout=120, check=True)
    rows = [line.split() for line in (tmp_path / "z88o2.txt").read_text().splitlines()]
    found = np.array([row[1:4] for row in rows if len(row) >= 4 and row[0].isdigit()], dtype=float)
    assert len(found) == len(places)
    largest = np.linalg.norm(found, axis=1).max()
    assert largest == pytest.approx(max(names["result"].DisplacementLengths), rel=1e-4)


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
