"""From a part to stresses without a window: document.solve() drives FreeCAD's CalculiX tools."""

import shutil
import subprocess

import Fem
import FreeCAD
import numpy as np
import ObjectsFem
import Part
import pytest

import DelaunayMesher
from DelaunayMesher import document
from DelaunayMesher.document.calculix import extremes
from DelaunayMesher.document.mesh_object import is_current
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


def test_a_load_on_a_seam_is_meshed_before_it_is_solved(cantilever):
    """A seam has no nodes of its own until something refers to it."""
    beam, analysis = cantilever
    file = beam.Document
    rod = file.addObject("Part::Cylinder", "Rod")
    rod.Radius, rod.Height = SIDE / 2, LENGTH
    file.recompute()
    fixed, force = file.Fixed, file.Force
    fixed.References = [(rod, "Face3")]
    force.References = [(rod, "Face2")]
    target = document.add_mesh(rod, analysis=analysis, max_size=5.0)
    document.run(target)
    assert is_current(target)
    seam = next(k for k, edge in enumerate(rod.Shape.Edges, 1) if isinstance(edge.Curve, Part.Line))
    force.References = [(rod, "Edge%d" % seam)]
    assert not is_current(target)
    document.run(target)
    assert is_current(target) and extremes(document.solve(target))[0] > 0


def test_a_load_on_what_is_not_meshed(cantilever):
    """FreeCAD itself would leave it out in silence."""
    beam, analysis = cantilever
    other = beam.Document.addObject("Part::Box", "Other")
    other.Placement.Base.z = 500
    beam.Document.recompute()
    beam.Document.Force.References = [(other, "Face2")]
    target = document.add_mesh(beam, analysis=analysis, max_size=5.0)
    document.run(target)
    with pytest.raises(MeshError, match="Force: the mesh has no node on Other.Face2") as caught:
        document.solve(target)
    assert caught.value.code == "no_nodes"


def test_a_container_that_stands_elsewhere(cantilever):
    beam, analysis = cantilever
    part = beam.Document.addObject("App::Part", "Frame")
    part.addObject(beam)
    part.Placement = FreeCAD.Placement(
        FreeCAD.Vector(0, 0, 50), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 90)
    )
    beam.Document.recompute()
    target = document.add_mesh(part, analysis=analysis, max_size=5.0, order=2)
    document.run(target)
    bending = FORCE * LENGTH**3 / (3 * YOUNG * SIDE**4 / 12)
    assert extremes(document.solve(target))[0] == pytest.approx(1.02 * bending, rel=0.03)


def test_a_refusal_leaves_no_solver_behind(cantilever):
    beam, analysis = cantilever
    target = document.add_mesh(beam, analysis=analysis, max_size=5.0)
    analysis.removeObject(beam.Document.Steel)
    document.run(target)
    before = [item.Name for item in beam.Document.Objects]
    with pytest.raises(MeshError) as caught:
        document.solve(target)
    assert caught.value.code == "not_ready"
    assert [item.Name for item in beam.Document.Objects] == before


@pytest.mark.parametrize("order", [1, 2])
def test_the_file_of_the_command_line_is_read_by_calculix(tmp_path, order):
    """A bar under tension, by an input that includes it."""
    bar = Part.makeBox(LENGTH, SIDE, SIDE)
    DelaunayMesher.mesh(bar, max_size=5.0, order=order).write(tmp_path / "bar.inp")
    middles = [face.CenterOfMass.x for face in bar.Faces]
    near, far = 1 + np.argmin(middles), 1 + np.argmax(middles)
    deck = """*INCLUDE, INPUT=bar.inp
*MATERIAL, NAME=STEEL
*ELASTIC
%g, 0.0
*SOLID SECTION, ELSET=Solid1, MATERIAL=STEEL
*STEP
*STATIC
*BOUNDARY
Face%d, 1, 3
Face%d, 1, 1, 0.1
*NODE PRINT, NSET=Face%d, TOTALS=ONLY
RF
*END STEP
""" % (YOUNG, near, far, far)
    (tmp_path / "deck.inp").write_text(deck)
    subprocess.run([shutil.which("ccx"), "deck"], cwd=tmp_path, check=True, capture_output=True, timeout=120)
    pull = float((tmp_path / "deck.dat").read_text().split()[-3])
    assert pull == pytest.approx(YOUNG * SIDE**2 * 0.1 / LENGTH, rel=1e-4)
    assert Fem.read(str(tmp_path / "bar.inp")).VolumeCount > 100
