"""FreeCAD's own FEM examples with our mesh: within 2 % of formulas and of other meshers' fine meshes."""

import shutil

import FreeCAD
import numpy as np
import pytest
from fem_examples import EXAMPLES, open_example, replace_mesh, solve_with_our_mesh, write_input

QUICK = ("ccx_cantilever_faceload",)
needs_ccx = pytest.mark.skipif(not shutil.which("ccx"), reason="CalculiX (ccx) is not installed")


@needs_ccx
@pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.long) for name in EXAMPLES]
)
def test_example_agrees_with_its_reference(name, tmp_path):
    value, _ = solve_with_our_mesh(name, tmp_path)
    assert np.asarray(value) == pytest.approx(np.asarray(EXAMPLES[name].expected()), rel=0.02)


def blocks(text, keyword):
    """{name: set of numbers} of the sets in a CalculiX input: keyword ELSET or NSET."""
    found, current = {}, None
    for line in text.splitlines():
        if line.startswith("*"):
            head = line.replace(" ", "").upper()
            current = None
            if head.startswith("*%s,%s=" % (keyword, keyword)):
                current = found.setdefault(line.split("=")[1].strip(), set())
        elif current is not None:
            current.update(int(entry) for entry in line.split(",") if entry.strip().isdigit())
    return found


def test_every_solid_gets_its_own_material(tmp_path):
    """Five boxes of three materials, one of them for whatever is left: the sets share the elements."""
    file, old, part = open_example("material_multiple_bendingbeam_fiveboxes")
    try:
        mesh = replace_mesh(file, old, part, 6.0)
        with open(write_input(file, tmp_path).inp_file_name) as stream:
            sets = blocks(stream.read(), "ELSET")
        groups = {
            mesh.FemMesh.getGroupName(group): set(mesh.FemMesh.getGroupElements(group))
            for group in mesh.FemMesh.Groups
        }
        solids = [groups["Solid%d" % number] for number in range(1, 6)]
        found = {name: numbers for name, numbers in sets.items() if name.startswith("FemMaterial")}
        assert set(map(frozenset, found.values())) == {
            frozenset(solids[2]),
            frozenset(solids[1] | solids[3]),
            frozenset(solids[0] | solids[4]),
        }
    finally:
        FreeCAD.closeDocument(file.Name)
