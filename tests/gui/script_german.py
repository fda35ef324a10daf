"""In FreeCAD's window in German: the texts are translated."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import drive
import FreeCAD
import FreeCADGui
from drive import say, wait
from PySide import QtGui


def main():
    FreeCADGui.setLocale("German")
    FreeCADGui.activateWorkbench("DelaunayMesherWorkbench")
    wait(0.5)
    document = FreeCAD.newDocument("Teil")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    drive.view_all()
    drive.select(box)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.5)
    panel = drive.panel()
    panel.run_box.button.click()
    drive.wait_until(lambda: not panel.running)
    drive.picture("german")
    texts = {label.text() for label in panel.options_box.findChildren(QtGui.QLabel)}
    say(sorted(texts), panel.run_box.status.text(), panel.run_box.log.toPlainText())
    assert "Wachstumsrate:" in texts
    assert panel.run_box.button.text() == "Vernetzen" and panel.run_box.status.text() == "Fertig"


drive.start(main, "GERMAN")
