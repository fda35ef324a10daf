"""From a part to stresses without a window: document.solve() drives FreeCAD's CalculiX tools."""

import shutil

import FreeCAD
import ObjectsFem
import pytest

from DelaunayMesher import document
from DelaunayMesher.document.calculix import extremes
from DelaunayMesher.document.placement import version
from DelaunayMesher.errors import MeshError

LENGTH, SIDE, FORCE, YOUNG = 100.0, 10.0, 100.0, 210000.0  # mm, mm, N, MPa

pytestmark = pytest.mark.skipif(not shutil.which("ccx"), reason="CalculiX is not installed")
needs_newest_solver = pytest.mark.skipif(
    version() < (1, 1),
    reason="optional: FreeCAD before 1.1 has no second solver object for CalculiX",
)


@pytest.fixture
def cantilever():
    """(beam, analysis): fixed at one end, a force across at the other, no solver yet."""
    file = FreeCAD.newDocument("cantilever")
    beam = file.addObject("Part::Box", "Beam")
    beam.Length, beam.Width, beam.Height = LENGTH, SIDE, SIDE
    file.recompute()
    analysis = ObjectsFem.makeAnalysis(file, "Analysis")
    steel = ObjectsFem.makeMaterialSolid(file, "Steel")
    card = steel.Material
    card.update(Name="Steel", YoungsModulus="%g MPa" % YOUNG, PoissonRatio="0.30")
    steel.Material = card
    fixed = ObjectsFem.makeConstraintFixed(file, "Fixed")
    fixed.References = [(beam, "Face1")]
    force = ObjectsFem.makeConstraintForce(file, "Force")
    force.References = [(beam, "Face2")]
    force.Force = FORCE if FreeCAD.Version()[0] == "0" else "%g N" % FORCE
    force.Direction = (beam, ["Edge5"])
    for item in (steel, fixed, force):
        analysis.addObject(item)
    file.recompute()
    yield beam, analysis
    FreeCAD.closeDocument(file.Name)


def add_newest_solver(analysis):
    """The solver object that FreeCAD 1.1 gives a new analysis."""
    analysis.addObject(ObjectsFem.makeSolverCalculiX(analysis.Document))


@pytest.mark.parametrize("solver", ["made by the way", pytest.param("newest", marks=needs_newest_solver)])
def test_beam_theory(cantilever, solver):
    beam, analysis = cantilever
    if solver == "newest":
        add_newest_solver(analysis)
    target = document.add_mesh(beam, analysis=analysis, max_size=5.0, order=2)
    document.run(target)
    found, stress = extremes(document.solve(target))
    bending = FORCE * LENGTH**3 / (3 * YOUNG * SIDE**4 / 12)
    shear = 1.2 * FORCE * LENGTH / (YOUNG / 2.6 * SIDE**2)
    assert found == pytest.approx(bending + shear, rel=0.02)
    assert 0.9 < stress / (6 * FORCE * LENGTH / SIDE**3) < 2.0  # singular at the fixed edges


def test_what_is_missing_is_said(cantilever):
    beam, analysis = cantilever
    target = document.add_mesh(beam, max_size=10.0)
    with pytest.raises(MeshError, match="in no analysis"):
        document.solve(target)
    analysis.addObject(target)
    with pytest.raises(MeshError, match="not_ready"):
        document.solve(target)  # the mesh is empty
    document.run(target)
    analysis.removeObject(next(item for item in analysis.Group if item.Name == "Steel"))
    with pytest.raises(MeshError, match="material"):
        document.solve(target)


def test_a_mesh_of_others_in_the_way(cantilever):
    beam, analysis = cantilever
    target = document.add_mesh(beam, analysis=analysis, max_size=10.0)
    document.run(target)
    document.run(document.add_mesh(beam, analysis=analysis, max_size=10.0))
    with pytest.raises(MeshError, match="which_mesh"):
        document.solve(target)
