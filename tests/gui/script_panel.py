"""In FreeCAD's window: mesh a part from the panel, cancel a run in the middle, save, reopen, double click."""

import os
import time

import drive
import FemGui
import FreeCAD
import FreeCADGui
from drive import say, wait, wait_until
from PySide import QtCore, QtGui

COMMAND = "DelaunayMesher_MeshSolid"


def command_is_in_fem_workbench():
    """The command is in the Mesh menu and in the toolbar of FreeCAD's own workbench."""
    FreeCADGui.activateWorkbench("FemWorkbench")
    wait(0.5)
    window = FreeCADGui.getMainWindow()
    menus = [
        menu.title().replace("&", "")
        for menu in window.menuBar().findChildren(QtGui.QMenu)
        for action in menu.actions()
        if action.objectName() == COMMAND
    ]
    bars = [
        bar.objectName()
        for bar in window.findChildren(QtGui.QToolBar)
        for action in bar.actions()
        if action.objectName() == COMMAND
    ]
    say("in FEM workbench: menus", menus, "toolbars", bars)
    assert "Mesh" in menus and "Mesh" in bars


def make_part():
    """Document with a box that has a rounded hole, and an active analysis."""
    document = FreeCAD.newDocument("Part")
    box = document.addObject("Part::Box", "Box")
    drill = document.addObject("Part::Cylinder", "Drill")
    drill.Placement.Base = FreeCAD.Vector(5, 5, 0)
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = box, drill
    document.recompute()
    analysis = drive.add_analysis(document)
    drive.view_all()
    return document, cut, analysis


def mesh_from_panel(document, cut, analysis):
    """The command makes an object in the analysis, the panel meshes it; returns the object."""
    panel = drive.open_panel(cut)
    target = panel.target
    assert target in analysis.Group and target.Shape == cut
    assert FreeCADGui.ActiveDocument.getInEdit()
    field = panel.options_box.fields["max_size"]
    assert abs(field.value() - 0.87) < 1e-6, field.value()  # 1/20 of the diagonal of a 10 mm cube
    field.write(1.0)
    panel.options_box.fields["order"].set(2)
    panel.run_box.button.click()
    assert panel.running
    wait_until(lambda: not panel.running)
    say("meshed:", target.Summary)
    assert target.FemMesh.VolumeCount > 5000
    assert target.ElementOrder == "2nd" and abs(target.MaxSize.Value - 1.0) < 1e-9
    assert target.FemMesh.TetraCount == target.FemMesh.VolumeCount
    return target


def cancel_in_the_middle(target):
    """A long run is cancelled: the window ticks on meanwhile, it ends soon, the old mesh stays."""
    before = target.FemMesh.NodeCount
    panel = drive.panel()
    panel.options_box.fields["max_size"].write(0.12)
    panel.options_box.fields["order"].set(1)
    ticks = []
    timer = QtCore.QTimer()
    timer.timeout.connect(lambda: ticks.append(time.monotonic()))
    timer.start(20)
    panel.run_box.button.click()
    job = panel.job
    seconds = wait_until(lambda: job.stage == "refinement" and job.seconds > 1.0 or job.finished)
    assert not job.finished
    wait(0.5)
    longest = max(b - a for a, b in zip(ticks, ticks[1:]))
    say("running: longest pause of the window %.2f s in %.1f s, %d ticks" % (longest, seconds, len(ticks)))
    say("progress %.2f at stage %s" % (job.fraction, job.stage))
    assert 0.05 < job.fraction < 1.0
    drive.picture("running")
    panel.run_box.button.click()
    taken = wait_until(lambda: not panel.running)
    say("cancelled in %.2f s" % taken)
    assert taken < 1.5  # half a second on a machine that does nothing else
    assert target.FemMesh.NodeCount == before
    assert "kept" in panel.run_box.status.text()


def errors_are_shown(target):
    """Sizes that contradict each other end in a message, not in a traceback."""
    panel = drive.panel()
    panel.options_box.fields["max_size"].write(1.0)
    panel.options_box.fields["min_size"].set(5.0)
    drive.run(panel)
    text = panel.run_box.log.toPlainText()
    say("refused:", text)
    assert "larger than" in text
    panel.options_box.fields["min_size"].set(None)


def close_and_undo(target):
    """Esc closes the panel; options and the object itself can be undone and redone."""
    count = target.FemMesh.NodeCount
    assert drive.panel().reject()
    wait(0.3)
    assert not FreeCADGui.ActiveDocument.getInEdit() and not FreeCADGui.Control.activeDialog()
    document = target.Document
    steps = list(document.UndoNames)
    say("undo:", steps)
    assert steps[0] == "Mesh options" and steps[-1] == "Delaunay mesh" and "Delaunay mesh run" in steps
    document.undo()
    assert abs(target.MinSize.Value - 5.0) < 1e-9
    document.redo()
    assert target.MinSize.Value == 0.0
    assert target.FemMesh.NodeCount == count
    while document.UndoCount:
        document.undo()
    assert document.getObject("FEMMeshDelaunay") is None
    while document.RedoCount:
        document.redo()
    assert document.getObject("FEMMeshDelaunay").FemMesh.NodeCount == count
    return document


def undo_a_run(target):
    """A run is one step: undo brings the old mesh back, redo the new one; the panel tells their figures."""
    panel = drive.panel()
    first = figures(target)
    panel.options_box.fields["max_size"].write(2.0)
    drive.run(panel)
    second = figures(target)
    say("first run:", first[:3], "second run:", second[:3])
    assert second[1] < first[1] and target.Document.UndoNames[0] == "Delaunay mesh run"
    target.Document.undo()
    assert figures(target) == first and not target.Shape.ViewObject.Visibility
    wait(0.1)
    assert "{:,d}".format(first[1]).replace(",", "\u202f") in panel.run_box.result.text()
    target.Document.redo()
    assert figures(target) == second
    target.Document.undo()
    target.Document.undo()  # the options
    assert target.MaxSize.Value == 1.0
    field = panel.options_box.fields["max_size"]
    assert field.value() == 1.0  # it follows, so that nothing writes the old value down again
    target.Growth = 0.25  # as does one that a script changes
    assert panel.options_box.fields["growth"].value() == 0.25
    target.Growth = 0.35


def undo_after_a_script(target):
    """A script's run between two of the panel: undo brings its mesh and its figures back."""
    document = target.Document
    panel = drive.panel()
    before = figures(target)
    run_with(panel, 2.5)
    target.MaxSize = 3.0
    run_script(target)
    script = figures(target)
    run_with(panel, 2.0)
    say("script:", script[:3], "panel after it:", figures(target)[:3])
    assert len({before, script, figures(target)}) == 3
    document.undo()
    assert figures(target) == script
    while figures(target) != before:
        assert document.UndoCount
        document.undo()
    target.MaxSize = 1.0
    panel.options_box.fields["max_size"].write(1.0)


def run_with(panel, size):
    panel.options_box.fields["max_size"].write(size)
    drive.run(panel)


def run_script(target):
    """As somebody does in FreeCAD's Python console."""
    from DelaunayMesher import document

    document.run(target)


def figures(target):
    """What tells one mesh from another, and the report of the run that made it."""
    mesh = target.FemMesh
    return mesh.NodeCount, mesh.VolumeCount, mesh.GroupCount, mesh.Volume.Value, target.Summary


def reopen(document):
    """Saved and opened again, the mesh and the panel are there; double click opens it."""
    path = os.path.join(drive.OUTPUT, "panel.FCStd")
    count = document.getObject("FEMMeshDelaunay").FemMesh.NodeCount
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    document = FreeCAD.openDocument(path)
    wait(0.3)
    target = document.getObject("FEMMeshDelaunay")
    assert target.FemMesh.NodeCount == count
    assert type(target.ViewObject.Proxy).__name__ == "VPMeshDelaunay"
    assert target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.3)
    assert FreeCADGui.ActiveDocument.getInEdit()
    assert FemGui.getActiveAnalysis() == document.getObject("Analysis")
    assert drive.panel().target == target
    drive.picture("reopened")
    return document, target


def digits_are_kept(target):
    """The panel shows all digits that a script has written and no more, and takes none away."""
    assert drive.panel().options_box.fields["growth"].widget.text() == "0.35"
    assert drive.panel().reject()
    wait(0.2)
    target.Growth = 0.12345678
    assert target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.2)
    panel = drive.panel()
    field = panel.options_box.fields["growth"]
    assert panel.target == target and field.value() == 0.12345678 and field.widget.text() == "0.12345678"
    assert panel.reject()
    wait(0.2)
    assert target.Growth == 0.12345678
    assert target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.2)


def close_while_running(document, target):
    """Closing the document stops the run."""
    panel = drive.panel()
    panel.options_box.fields["max_size"].write(0.1)
    panel.run_box.button.click()
    job = panel.job
    wait(0.5)
    FreeCAD.closeDocument(document.Name)
    say("stopped after closing in %.2f s" % wait_until(lambda: job.finished, 20))
    assert job.cancelled
    wait(0.3)


def main():
    command_is_in_fem_workbench()
    drive.activate()
    document, cut, analysis = make_part()
    target = mesh_from_panel(document, cut, analysis)
    drive.view_all()
    drive.picture("panel")
    undo_a_run(target)
    undo_after_a_script(target)
    cancel_in_the_middle(target)
    errors_are_shown(target)
    document = close_and_undo(target)
    document, target = reopen(document)
    digits_are_kept(target)
    close_while_running(document, target)


drive.start(main, "PANEL")
