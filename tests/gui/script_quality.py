"""In FreeCAD's window: refine a face, mesh again, look at the quality panel, click on an element, cut.
The quality panel follows its mesh.
"""

import json
import os

import drive
import FreeCAD
import FreeCADGui
from drive import say, wait
from PySide import QtGui


def make_mesh():
    """A cylinder meshed from the panel."""
    document = FreeCAD.newDocument("Part")
    part = document.addObject("Part::Cylinder", "Cylinder")
    part.Radius, part.Height = 10, 30
    document.recompute()
    drive.view_all()
    drive.select(part)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.3)
    run_panel()
    target = drive.panel().target
    drive.panel().reject()
    wait(0.3)
    return part, target


def run_panel():
    """Press Mesh and wait."""
    panel = drive.panel()
    drive.run(panel)
    say(panel.target.Summary)


def refine(part, target):
    """The command makes FreeCAD's own refinement; the mesh becomes finer there."""
    before = target.FemMesh.VolumeCount
    drive.select(part, "Face2")
    FreeCADGui.runCommand("DelaunayMesher_RefineFaces")
    wait(0.5)
    refinement = (target.MeshRegionList or target.MeshRefinementList)[0]
    assert FreeCADGui.ActiveDocument.getInEdit().Object == refinement
    assert refinement.References[0][1] in ("Face2", ("Face2",))
    assert 0 < refinement.CharacteristicLength.Value < target.MaxSize.Value
    FreeCADGui.ActiveDocument.resetEdit()
    wait(0.3)
    assert refinement in target.ViewObject.Proxy.claimChildren()
    assert target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.3)
    run_panel()
    say("tetrahedra before and after the refinement:", before, target.FemMesh.VolumeCount)
    assert target.FemMesh.VolumeCount > 1.5 * before


def group(part, target):
    """The command makes FreeCAD's own group, which undo takes back; the next mesh has it."""
    assert drive.panel().reject()
    wait(0.3)
    part.ViewObject.show()
    drive.select(part, "Face1", "Face3")
    FreeCADGui.runCommand("DelaunayMesher_Group")
    wait(0.5)
    made = target.MeshGroupList[0]
    assert FreeCADGui.ActiveDocument.getInEdit().Object == made
    assert made.References == [(part, ("Face1", "Face3"))]
    FreeCADGui.ActiveDocument.resetEdit()
    wait(0.3)
    assert made in target.ViewObject.Proxy.claimChildren()
    name = made.Name
    target.Document.undo()
    assert target.MeshGroupList == [] and target.Document.getObject(name) is None
    target.Document.redo()
    assert target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.3)
    run_panel()
    mesh = target.FemMesh
    found = {mesh.getGroupName(number): len(mesh.getGroupElements(number)) for number in mesh.Groups}
    say("groups:", found)
    assert found[name] == found["Face1"] + found["Face3"] > 0


def quality_panel(target):
    """From the mesh panel's button; the figures agree with the report."""
    from DelaunayMesher.document.mesh_object import stored_report
    from DelaunayMesher.gui.measures import MEASURES
    from DelaunayMesher.gui.task_quality import QualityPanel

    drive.panel().run_box.quality_button.click()
    wait(0.5)
    panel = QualityPanel.current
    assert len(panel.values) == target.FemMesh.VolumeCount
    assert abs(panel.values.min() - stored_report(target)["quality"]["min_dihedral"]) < 1e-6
    assert sum(panel.plot_box.histogram.counts) == len(panel.values)
    drive.picture("quality")

    panel.worst_box.table.selectRow(0)
    wait(0.3)
    assert panel.overlay.chosen.getNumChildren() > 0
    places = {panel.worst_box.table.item(row, 2).text() for row in range(100)}
    say("worst elements lie on", sorted(places))
    assert places <= {"Face1", "Face2", "Face3", "inside"}
    drive.picture("worst")

    drive.view_all()
    panel.cut_box.axis.setCurrentIndex(1)
    wait(0.3)
    kept = panel.kept()
    assert 0 < kept.sum() < len(kept) and not target.ViewObject.Visibility
    drive.picture("cut")
    panel.cut_box.axis.setCurrentIndex(0)
    panel.cut_box.bad_only.setChecked(True)
    panel.cut_box.limit.setValue(35)
    assert panel.kept().sum() == (panel.values < 35).sum()
    drive.picture("bad_only")
    for index in range(len(MEASURES)):
        panel.plot_box.measure.setCurrentIndex(index)
        wait(0.05)
    export_report(target)
    scene = FreeCADGui.ActiveDocument.ActiveView.getSceneGraph()
    children = scene.getNumChildren()
    panel.reject()
    wait(0.3)
    assert scene.getNumChildren() == children - 1 and target.ViewObject.Visibility
    assert not FreeCADGui.Control.activeDialog()


def quality_follows(target):
    """The panel shows the mesh that undo brings, also none; it closes when mesh object or document go."""
    from DelaunayMesher.gui.task_quality import QualityPanel

    document = target.Document
    panel = open_quality(target)
    panel.worst_box.table.selectRow(0)
    panel.cut_box.axis.setCurrentIndex(1)
    counts = [target.FemMesh.VolumeCount]
    while counts[-1]:
        document.undo()
        wait(0.05)
        assert len(panel.values) == target.FemMesh.VolumeCount
        counts.append(target.FemMesh.VolumeCount)
    say("elements while undoing:", counts)
    assert panel.overlay.chosen.getNumChildren() == 0
    while document.RedoCount:
        document.redo()
    wait(0.05)
    assert len(panel.values) == counts[0]
    name = target.Name
    document.openTransaction("Delete")
    document.removeObject(name)
    document.commitTransaction()
    wait(0.1)
    assert not FreeCADGui.Control.activeDialog() and QualityPanel.current is None
    document.undo()
    open_quality(document.getObject(name))
    FreeCAD.closeDocument(document.Name)
    wait(0.1)
    assert not FreeCADGui.Control.activeDialog() and QualityPanel.current is None


def open_quality(target):
    from DelaunayMesher.gui.task_quality import QualityPanel

    drive.select(target)
    FreeCADGui.runCommand("DelaunayMesher_Quality")
    wait(0.2)
    return QualityPanel.current


def export_report(target):
    """The report is saved; where nothing can be written, a message says so."""
    from DelaunayMesher.gui import task_quality

    ask = QtGui.QFileDialog.getSaveFileName
    panel = task_quality.QualityPanel.current
    good, bad = (os.path.join(drive.OUTPUT, name) for name in ("report.json", "missing/report.json"))
    QtGui.QFileDialog.getSaveFileName = lambda *_: (good, "")
    panel.export()
    with open(good, encoding="utf-8") as file:
        assert json.load(file)["tetrahedra"] == target.FemMesh.VolumeCount
    QtGui.QFileDialog.getSaveFileName = lambda *_: (bad, "")
    text = drive.message_of(panel.export)
    QtGui.QFileDialog.getSaveFileName = ask
    say(text)
    assert "not saved" in text and bad in text


def main():
    drive.activate()
    part, target = make_mesh()
    refine(part, target)
    group(part, target)
    quality_panel(target)
    quality_follows(target)


drive.start(main, "QUALITY")
