"""Runs in FreeCAD's window (see make_pictures.py): the steps of docs/gui.md, one picture each."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(ROOT, "tests", "gui"), os.path.dirname(os.path.abspath(__file__))]

import drive  # noqa: E402
import FemGui  # noqa: E402
import FreeCAD  # noqa: E402
import FreeCADGui  # noqa: E402
import ObjectsFem  # noqa: E402
from drive import wait, wait_until  # noqa: E402
from small_picture import picture  # noqa: E402


def run(panel):
    panel.run_box.button.click()
    wait_until(lambda: not panel.running)
    drive.view_all()


def open_part():
    document = FreeCAD.openDocument(os.path.join(ROOT, "resources", "examples", "bracket.FCStd"))
    part = document.getObject("Bracket")
    part.ViewObject.show()
    FemGui.setActiveAnalysis(ObjectsFem.makeAnalysis(document, "Analysis"))
    drive.view_all()
    return part


def mesh_panel(part):
    drive.select(part)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.3)
    panel = drive.panel()
    panel.options_box.preview_button.click()
    wait_until(lambda: panel.preview.overlay is not None)
    picture("preview")
    run(panel)
    picture("meshed")
    panel.reject()
    wait(0.3)
    return panel.target


def refinement(part, target):
    target.ViewObject.hide()
    part.ViewObject.show()
    drive.select(part, *bore(part))
    FreeCADGui.runCommand("DelaunayMesher_RefineFaces")
    wait(0.5)
    picture("refine")
    FreeCADGui.ActiveDocument.resetEdit()
    wait(0.3)
    target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.3)
    run(drive.panel())
    picture("refined")


def bore(part):
    """Names of the faces of the large hole."""
    faces = enumerate(part.Shape.Faces, 1)
    return ["Face%d" % i for i, f in faces if abs(getattr(f.Surface, "Radius", 0.0) - 13.0) < 1e-6]


def quality():
    from DelaunayMesher.gui.task_quality import QualityPanel

    drive.panel().run_box.quality_button.click()
    wait(0.5)
    panel = QualityPanel.current
    panel.cut_box.axis.setCurrentIndex(2)
    panel.cut_box.slider.setValue(100)
    wait(0.2)
    picture("quality")
    panel.cut_box.axis.setCurrentIndex(0)
    panel.worst_box.table.selectRow(0)
    picture("worst")
    panel.reject()


def main():
    FreeCADGui.activateWorkbench("DelaunayMesherWorkbench")
    wait(0.5)
    part = open_part()
    target = mesh_panel(part)
    refinement(part, target)
    quality()


drive.start(main, "PICTURES")
