"""In FreeCAD's window: from a part to stresses with FreeCAD's own analysis objects and CalculiX."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import drive
import FemGui
import FreeCAD
import FreeCADGui
import ObjectsFem
from drive import say, wait, wait_until

LENGTH, SIDE, FORCE, YOUNG = 100.0, 10.0, 100.0, 210000.0  # mm, mm, N, MPa


def make_analysis():
    """A cantilever: fixed at one end, a force at the other."""
    document = FreeCAD.newDocument("Cantilever")
    beam = document.addObject("Part::Box", "Beam")
    beam.Length, beam.Width, beam.Height = LENGTH, SIDE, SIDE
    document.recompute()
    analysis = ObjectsFem.makeAnalysis(document, "Analysis")
    FemGui.setActiveAnalysis(analysis)
    solver = ObjectsFem.makeSolverCalculixCcxTools(document, "CalculiX")
    solver.GeometricalNonlinearity = "linear"
    steel = ObjectsFem.makeMaterialSolid(document, "Steel")
    card = steel.Material
    card.update(Name="Steel", YoungsModulus="%g MPa" % YOUNG, PoissonRatio="0.30")
    steel.Material = card
    fixed = ObjectsFem.makeConstraintFixed(document, "Fixed")
    fixed.References = [(beam, "Face1")]
    force = ObjectsFem.makeConstraintForce(document, "Force")
    force.References = [(beam, "Face2")]
    force.Force = FORCE if drive.version() < (1, 0) else "%g N" % FORCE
    force.Direction = (beam, ["Edge5"])
    for item in (solver, steel, fixed, force):
        analysis.addObject(item)
    document.recompute()
    drive.view_all()
    return beam, analysis, solver


def mesh(beam):
    """From the panel, second order."""
    drive.select(beam)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.3)
    panel = drive.panel()
    panel.options_box.fields["order"].set(2)
    panel.run_box.button.click()
    wait_until(lambda: not panel.running)
    say(panel.target.Summary)
    panel.reject()
    wait(0.3)


def solve(analysis, solver):
    """With FreeCAD's ccxtools; returns the result object."""
    from femtools.ccxtools import FemToolsCcx

    tool = FemToolsCcx(analysis, solver)
    tool.update_objects()
    tool.setup_working_dir(drive.OUTPUT, create=True)
    tool.setup_ccx()
    problem = tool.check_prerequisites()
    assert not problem, problem
    tool.purge_results()
    tool.write_inp_file()
    tool.ccx_run()
    tool.load_results()
    return next(item for item in analysis.Group if item.isDerivedFrom("Fem::FemResultObject"))


def main():
    FreeCADGui.activateWorkbench("FemWorkbench")
    wait(0.3)
    beam, analysis, solver = make_analysis()
    mesh(beam)
    result = solve(analysis, solver)
    found = max(result.DisplacementLengths)
    expected = FORCE * LENGTH**3 / (3 * YOUNG * SIDE**4 / 12)
    shear = 1.2 * FORCE * LENGTH / (YOUNG / 2.6 * SIDE**2)
    say("displacement %.5f mm, beam theory %.5f mm" % (found, expected + shear))
    assert abs(found - expected - shear) < 0.02 * expected
    drive.picture("solved")


drive.start(main, "SOLVE")
