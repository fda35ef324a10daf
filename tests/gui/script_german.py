"""In FreeCAD's window in German: the texts are translated."""

import drive
import FreeCAD
import FreeCADGui
from drive import say
from PySide import QtGui


def main():
    FreeCADGui.setLocale("German")
    drive.activate()
    document = FreeCAD.newDocument("Teil")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    drive.view_all()
    panel = drive.open_panel(box)
    drive.run(panel)
    drive.picture("german")
    texts = {label.text() for label in panel.options_box.findChildren(QtGui.QLabel)}
    say(sorted(texts), panel.run_box.status.text(), panel.run_box.log.toPlainText())
    assert "Wachstumsrate:" in texts
    assert panel.run_box.button.text() == "Vernetzen" and panel.run_box.status.text() == "Fertig"


drive.start(main, "GERMAN")
