"""Tells a panel when the mesh that it shows has changed, or is gone."""

import FreeCAD
from PySide import QtCore


class MeshWatch:
    """Calls changed() after another mesh was put into the mesh object, gone() after it or its document was
    deleted, until end().

    FreeCAD calls the slots in the middle of its work; timers wait for the end of it.  They belong to
    `widget`, so that nothing is called once that is gone.
    """

    def __init__(self, target, widget, changed, gone):
        self.target, self.document = target, target.Document
        self.changed, self.gone = later(changed, widget), later(gone, widget)
        FreeCAD.addDocumentObserver(self)

    def slotChangedObject(self, item, name):
        if item == self.target and name == "FemMesh":
            self.changed.start()

    def slotDeletedObject(self, item):
        if item == self.target:
            self.lose()

    def slotDeletedDocument(self, document):
        if document == self.document:
            self.lose()

    def lose(self):
        self.changed.stop()
        self.gone.start()

    def end(self):
        FreeCAD.removeDocumentObserver(self)


def later(action, widget):
    """A timer of the widget; start() it to have the action done once, when FreeCAD is idle."""
    timer = QtCore.QTimer(widget)
    timer.setSingleShot(True)
    timer.timeout.connect(action)
    return timer
