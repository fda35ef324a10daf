"""For scripts inside FreeCAD's window: wait while the window lives, press buttons, take pictures."""

import os
import sys
import time
import traceback

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

OUTPUT = os.environ["OUTPUT"]


def say(*what):
    """A line in the log."""
    with open(os.path.join(OUTPUT, "log.txt"), "a", encoding="utf-8") as file:
        print(*what, file=file)


def wait(seconds):
    """Let the window work."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        QtGui.QApplication.processEvents()
        time.sleep(0.005)


def wait_until(condition, seconds=120):
    """Let the window work until something holds; returns how long it took."""
    begin = time.monotonic()
    while not condition():
        if time.monotonic() - begin > seconds:
            raise AssertionError("waited %g s in vain" % seconds)
        QtGui.QApplication.processEvents()
        time.sleep(0.005)
    return time.monotonic() - begin


def start(main, name):
    """Run `main` once the window is up; say '<name> OK' when it went through; end FreeCAD."""

    def go():
        window = FreeCADGui.getMainWindow()
        window.resize(1300, 900)
        window.move(0, 0)
        try:
            wait(0.5)
            arrange()
            main()
            say(name, "OK")
        except BaseException:
            say(traceback.format_exc())
        sys.stdout.flush()
        os._exit(0)

    QtCore.QTimer.singleShot(2000, go)


def arrange(width=360):
    """The window as pictures want it: a wide panel, no console."""
    window = FreeCADGui.getMainWindow()
    for dock in window.findChildren(QtGui.QDockWidget):
        if dock.objectName() in ("Python console", "Report view"):
            dock.hide()
        if dock.objectName() == "Combo View":
            window.resizeDocks([dock], [width], QtCore.Qt.Horizontal)
    wait(0.2)


def picture(name, widget=None):
    """Save a picture of the screen where the window (or a part of it) is, the 3D view included."""
    wait(0.4)
    widget = widget or FreeCADGui.getMainWindow()
    corner = widget.mapToGlobal(QtCore.QPoint(0, 0))
    screen = QtGui.QApplication.primaryScreen()
    grabbed = screen.grabWindow(0, corner.x(), corner.y(), widget.width(), widget.height())
    grabbed.save(os.path.join(OUTPUT, name + ".png"))


def select(item, *elements):
    """Make this the selection."""
    FreeCADGui.Selection.clearSelection()
    for element in elements or ("",):
        FreeCADGui.Selection.addSelection(item.Document.Name, item.Name, element)
    wait(0.1)


def view_all():
    """Isometric view of everything."""
    view = FreeCADGui.ActiveDocument.ActiveView
    view.viewIsometric()
    view.fitAll()
    wait(0.2)


def panel():
    """The mesh panel that is open in the active document."""
    from DelaunayMesher.gui import task_mesh_object

    return task_mesh_object.MeshPanel.current


def version():
    return tuple(int(number) for number in FreeCAD.Version()[:2])
