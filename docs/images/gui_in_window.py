"""Runs in FreeCAD's window (see make_pictures.py): the steps of docs/gui.md, one picture each."""

import FreeCADGui
from small_picture import drive, picture


def run(panel):
    drive.run(panel)
    drive.view_all()


def open_part():
    part = drive.open_bracket()
    drive.add_analysis(part.Document)
    drive.view_all()
    return part


def mesh_panel(part):
    panel = drive.open_panel(part)
    panel.options_box.preview_button.click()
    drive.wait_until(lambda: panel.preview.overlay is not None)
    picture("preview")
    run(panel)
    picture("meshed")
    panel.reject()
    drive.wait(0.3)
    return panel.target


def refinement(part, target):
    target.ViewObject.hide()
    part.ViewObject.show()
    drive.select(part, *bore(part))
    FreeCADGui.runCommand("DelaunayMesher_RefineFaces")
    drive.wait(0.5)
    picture("refine")
    FreeCADGui.ActiveDocument.resetEdit()
    drive.wait(0.3)
    target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    drive.wait(0.3)
    run(drive.panel())
    picture("refined")


def bore(part):
    """Names of the faces of the large hole."""
    faces = enumerate(part.Shape.Faces, 1)
    return ["Face%d" % i for i, f in faces if abs(getattr(f.Surface, "Radius", 0.0) - 13.0) < 1e-6]


def quality():
    from DelaunayMesher.gui.task_quality import QualityPanel

    drive.panel().run_box.quality_button.click()
    drive.wait(0.5)
    panel = QualityPanel.current
    panel.cut_box.axis.setCurrentIndex(2)
    panel.cut_box.slider.setValue(100)
    drive.wait(0.2)
    picture("quality")
    panel.cut_box.axis.setCurrentIndex(0)
    panel.worst_box.table.selectRow(0)
    picture("worst")
    panel.reject()


def main():
    drive.activate()
    part = open_part()
    target = mesh_panel(part)
    refinement(part, target)
    quality()


drive.start(main, "PICTURES")
