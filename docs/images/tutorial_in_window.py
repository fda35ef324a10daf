"""Runs in FreeCAD's window (see make_pictures.py): the steps of docs/tutorial.md, one picture each."""

import FreeCADGui
from PySide import QtGui
from small_picture import drive, picture

FORCE = 8000.0  # N


def face_where(part, wanted):
    """Name of the first face whose bounding box is as wanted."""
    return next("Face%d" % i for i, f in enumerate(part.Shape.Faces, 1) if wanted(f.BoundBox))


def click(part, element):
    """As a click on the part in the view: the element is selected."""
    drive.select(part, element)
    drive.wait(0.2)


def fix_the_foot(part):
    view = FreeCADGui.ActiveDocument.ActiveView
    view.viewBottom()
    view.fitAll()
    click(part, face_where(part, lambda box: box.ZMax < 1e-6))
    picture("1_foot")
    FreeCADGui.runCommand("DelaunayMesher_Fix")
    drive.wait(0.3)


def pull_at_the_bore(part):
    drive.view_all()
    click(part, face_where(part, lambda box: abs(box.ZLength - 26) < 1e-6 and box.XLength > 20))
    picture("2_bore")
    FreeCADGui.runCommand("DelaunayMesher_Force")
    drive.wait(0.5)
    force = FreeCADGui.ActiveDocument.getInEdit().Object
    field = next(box for box in spin_boxes() if box.objectName() == "spinForce")
    field.setProperty("rawValue", FORCE)
    drive.wait(0.2)
    picture("3_force")
    button(QtGui.QDialogButtonBox.Ok).click()
    drive.wait(0.5)
    drive.say(force.Force, "left in edit:", FreeCADGui.ActiveDocument.getInEdit())


def spin_boxes():
    """The fields of the open task panel."""
    boxes = FreeCADGui.getMainWindow().findChildren(QtGui.QAbstractSpinBox)
    return [box for box in boxes if box.isVisible()]


def button(kind):
    """A button of the open task panel."""
    for box in FreeCADGui.getMainWindow().findChildren(QtGui.QDialogButtonBox):
        if box.isVisible() and box.button(kind):
            return box.button(kind)
    raise AssertionError("no such button")


def mesh_and_solve(part):
    panel = drive.open_panel(part)
    picture("4_mesh")
    panel.run_box.solve_button.click()
    drive.wait_until(lambda: not panel.running)
    drive.say(panel.run_box.log.toPlainText())
    assert panel.run_box.status.text() == "Solved"
    drive.view_all()
    bring_to_view(panel.run_box)
    picture("5_stress")
    return panel


def bring_to_view(box):
    """Scroll the task panel down to the figures."""
    for area in FreeCADGui.getMainWindow().findChildren(QtGui.QScrollArea):
        if area.isAncestorOf(box):
            area.verticalScrollBar().setValue(area.verticalScrollBar().maximum())
    drive.wait(0.2)


def main():
    drive.activate()
    part = drive.open_bracket()
    fix_the_foot(part)
    pull_at_the_bore(part)
    mesh_and_solve(part)


drive.start(main, "PICTURES")
