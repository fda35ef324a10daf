"""In FreeCAD's window: from a part to stresses with FreeCAD's own analysis objects and CalculiX."""

import drive
import FreeCAD
import FreeCADGui
import ObjectsFem
from drive import say, wait, wait_until

from DelaunayMesher.document.calculix import extremes, newest

LENGTH, SIDE, FORCE, YOUNG = 100.0, 10.0, 100.0, 210000.0  # mm, mm, N, MPa


def make_analysis():
    """A cantilever: fixed at one end, a force at the other."""
    document = FreeCAD.newDocument("Cantilever")
    beam = document.addObject("Part::Box", "Beam")
    beam.Length, beam.Width, beam.Height = LENGTH, SIDE, SIDE
    document.recompute()
    analysis = drive.add_analysis(document)
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
    for item in (steel, fixed, force):
        analysis.addObject(item)
    document.recompute()
    drive.view_all()
    return beam, analysis


def mesh_and_solve(beam, analysis):
    """From the panel, second order; the solver is made by the way.  Returns the result object."""
    panel = drive.open_panel(beam)
    panel.options_box.fields["order"].set(2)
    panel.run_box.solve_button.click()
    wait_until(lambda: not panel.running)
    say(panel.target.Summary)
    text = panel.run_box.log.toPlainText()
    say(text)
    assert "von Mises" in text, text
    drive.view_all()
    drive.picture("solved")
    assert analysis.Document.UndoNames[0] == "Results of CalculiX"
    return panel


def something_is_missing(panel, analysis):
    """Without a material the panel says so, and CalculiX does not run."""
    steel = next(item for item in analysis.Group if item.Name == "Steel")
    analysis.removeObject(steel)
    panel.run_box.solve_button.click()
    assert not panel.running
    text = panel.run_box.log.toPlainText()
    say("refused:", text)
    assert "material" in text and panel.run_box.button.isEnabled()
    analysis.addObject(steel)


def changed_options(panel):
    """Solve meshes first when the mesh is not of the options as they are now, and only then."""
    target = panel.target
    before, size = target.RunNumber, panel.options_box.fields["max_size"].value()
    for wanted, runs in ((0.9 * size, 1), (0.9 * size, 1), (size, 2)):
        panel.options_box.fields["max_size"].write(wanted)
        panel.run_box.solve_button.click()
        wait_until(lambda: not panel.running)
        assert panel.run_box.status.text() == "Solved"
        assert target.RunNumber == before + runs


def cancel(panel):
    """CalculiX is stopped, the results of before stay."""
    panel.run_box.solve_button.click()
    assert panel.running
    drive.run(panel)
    say(panel.run_box.status.text())
    assert panel.run_box.status.text() == "Cancelled"


def results_panel(panel):
    """FreeCAD's own panel opens for the result."""
    panel.run_box.results_button.click()
    wait(0.5)
    assert FreeCADGui.ActiveDocument.getInEdit().Object == panel.shown
    drive.picture("results")
    FreeCADGui.ActiveDocument.resetEdit()
    wait(0.2)


def command(target):
    """The toolbar's command opens the panel and solves at once."""
    FreeCADGui.Selection.clearSelection()
    assert FreeCADGui.Command.get("DelaunayMesher_Solve").isActive()
    FreeCADGui.runCommand("DelaunayMesher_Solve")
    panel = drive.panel()
    assert panel.target == target and panel.running
    wait_until(lambda: not panel.running)
    assert panel.run_box.status.text() == "Solved"
    command_in_open_panel(panel)
    assert panel.reject()


def command_in_open_panel(panel):
    """It uses the panel of the mesh when that is open, and starts nothing beside a run."""
    panel.run_box.button.click()
    job, before = panel.job, panel.target.RunNumber
    FreeCADGui.runCommand("DelaunayMesher_Solve")
    assert panel.job is job
    wait_until(lambda: not panel.running)
    assert panel.run_box.status.text() == "Done" and panel.target.RunNumber == before + 1
    FreeCADGui.runCommand("DelaunayMesher_Solve")
    assert drive.panel() is panel and panel.running
    wait_until(lambda: not panel.running)
    assert panel.run_box.status.text() == "Solved"


def command_beside_another_panel(target, analysis):
    """Nothing is started while somebody else's panel is open; a message says why."""
    steel = next(item for item in analysis.Group if item.Name == "Steel")
    FreeCADGui.getDocument(steel.Document.Name).setEdit(steel.Name)
    wait(0.3)
    before = target.RunNumber
    drive.select(target)
    text = drive.message_of(lambda: FreeCADGui.runCommand("DelaunayMesher_Solve"))
    assert "Another task panel" in text and target.RunNumber == before
    assert FreeCADGui.ActiveDocument.getInEdit().Object == steel
    FreeCADGui.ActiveDocument.resetEdit()
    wait(0.2)


def newest_solver(target, analysis):
    """The other solver object for CalculiX, which FreeCAD 1.1 and later have."""
    for item in [item for item in analysis.Group if item.isDerivedFrom("Fem::FemSolverObject")]:
        analysis.Document.removeObject(item.Name)
    analysis.addObject(ObjectsFem.makeSolverCalculiX(analysis.Document))
    FreeCADGui.runCommand("DelaunayMesher_Solve")
    panel = drive.panel()
    wait_until(lambda: not panel.running)
    say(panel.run_box.log.toPlainText())
    assert panel.run_box.status.text() == "Solved"
    assert panel.shown.isDerivedFrom("Fem::FemPostPipeline")
    drive.picture("newest_solver")
    assert panel.reject()


def main():
    drive.activate()
    beam, analysis = make_analysis()
    panel = mesh_and_solve(beam, analysis)
    found, stress = extremes(newest(analysis.Group, "Fem::FemResultObject"))
    expected = FORCE * LENGTH**3 / (3 * YOUNG * SIDE**4 / 12)
    shear = 1.2 * FORCE * LENGTH / (YOUNG / 2.6 * SIDE**2)
    say("displacement %.5f mm, beam theory %.5f mm, stress %.2f MPa" % (found, expected + shear, stress))
    assert abs(found - expected - shear) < 0.02 * expected
    assert 0.9 < stress / (6 * FORCE * LENGTH / SIDE**3) < 2.0  # singular at the fixed edges
    something_is_missing(panel, analysis)
    changed_options(panel)
    cancel(panel)
    results_panel(panel)
    command(panel.target)
    command_beside_another_panel(panel.target, analysis)
    if drive.version() >= (1, 1):
        newest_solver(panel.target, analysis)


drive.start(main, "SOLVE")
