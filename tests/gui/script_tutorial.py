"""In FreeCAD's window: the clicks of docs/tutorial.md, from a bare part to stresses."""

import drive
import FemGui
import FreeCAD
import FreeCADGui
from drive import say, wait, wait_until


def make_part():
    document = FreeCAD.newDocument("Part")
    part = document.addObject("Part::Box", "Bar")
    part.Length, part.Width, part.Height = 60, 10, 10
    document.recompute()
    drive.view_all()
    return document, part


def fix(document, part):
    """Analysis, solver and material come by the way, as one step that can be undone."""
    drive.select(part, "Face1")
    FreeCADGui.runCommand("DelaunayMesher_Fix")
    wait(0.3)
    fixed = document.getObject("ConstraintFixed") or document.getObject("Fixed")
    members = [item.TypeId for item in FemGui.getActiveAnalysis().Group]
    say(members, fixed.References)
    assert len(members) == 3 and fixed.References == [(part, ("Face1",))]
    assert not FreeCADGui.Selection.getSelection()
    document.undo()
    assert document.Objects == [part]
    document.redo()
    FemGui.setActiveAnalysis(
        next(item for item in document.Objects if item.isDerivedFrom("Fem::FemAnalysis"))
    )


def force(document, part):
    """FreeCAD's panel opens; nothing else is added."""
    drive.select(part, "Face2")
    FreeCADGui.runCommand("DelaunayMesher_Force")
    wait(0.3)
    made = FreeCADGui.ActiveDocument.getInEdit().Object
    FreeCADGui.ActiveDocument.resetEdit()
    wait(0.2)
    assert made.References == [(part, ("Face2",))] and len(FemGui.getActiveAnalysis().Group) == 4
    return made


def solve(part, made):
    """The stress of a bar that is pulled: force over section."""
    panel = drive.open_panel(part)
    panel.run_box.solve_button.click()
    wait_until(lambda: not panel.running)
    say(panel.run_box.log.toPlainText(), panel.target.Summary)
    assert panel.run_box.status.text() == "Solved" and panel.target.ElementOrder == "2nd"
    drive.picture("tutorial")
    result = next(i for i in FemGui.getActiveAnalysis().Group if i.isDerivedFrom("Fem::FemResultObject"))
    newtons = float(getattr(made.Force, "Value", made.Force)) * (
        1e-3 if hasattr(made.Force, "Value") else 1.0
    )
    moved = newtons * 60 / (210000 * 100)
    say("displacement", max(result.DisplacementLengths), "of a bar without side effects", moved)
    assert abs(max(result.DisplacementLengths) - moved) < 0.05 * moved
    assert panel.reject()


def main():
    drive.activate()
    document, part = make_part()
    fix(document, part)
    solve(part, force(document, part))


drive.start(main, "TUTORIAL")
