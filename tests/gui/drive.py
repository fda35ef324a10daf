"""For scripts inside FreeCAD's window: wait while the window lives, press buttons, take pictures."""

import os
import sys
import time
import traceback

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

OUTPUT = os.environ["OUTPUT"]
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


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
    """Run `main` once the window is up; say '<name> OK' when it went through; end FreeCAD.

    Qt prints an exception in a slot and goes on: here it is noted, and there is no OK.
    """
    uncaught = []

    def note(kind, error, place):
        uncaught.append(error)
        say("".join(traceback.format_exception(kind, error, place)))

    def go():
        sys.excepthook = note
        window = FreeCADGui.getMainWindow()
        window.resize(1300, 900)
        window.move(0, 0)
        try:
            wait(0.5)
            arrange()
            main()
            wait(0.2)  # for what is still to come
            assert not uncaught, "%d exceptions were not caught" % len(uncaught)
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


def activate(name="DelaunayMesherWorkbench"):
    """Change to a workbench."""
    FreeCADGui.activateWorkbench(name)
    wait(0.5)


def add_analysis(document):
    """A new analysis, which becomes the active one."""
    import FemGui
    import ObjectsFem

    analysis = ObjectsFem.makeAnalysis(document, "Analysis")
    FemGui.setActiveAnalysis(analysis)
    return analysis


def open_bracket():
    """The example part in a document of its own, visible."""
    document = FreeCAD.openDocument(os.path.join(ROOT, "resources", "examples", "bracket.FCStd"))
    part = document.getObject("Bracket")
    part.ViewObject.show()
    view_all()
    return part


def open_panel(part):
    """'Mesh this solid' on a part; returns the panel."""
    select(part)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.5)
    return panel()


def run(opened):
    """Press Mesh in a panel and wait for the end; returns the panel."""
    opened.run_box.button.click()
    wait_until(lambda: not opened.running)
    return opened


def message_of(action):
    """Text of the message box that `action` opens; the box is closed."""
    texts = []

    def close():
        box = QtGui.QApplication.activeModalWidget()
        if box is None:
            QtCore.QTimer.singleShot(100, close)
            return
        texts.append(box.text())
        picture("message", box)
        box.accept()

    QtCore.QTimer.singleShot(300, close)
    action()
    wait(0.2)
    return texts[0]


def panel():
    """The mesh panel that is open in the active document."""
    from DelaunayMesher.gui import task_mesh_object

    return task_mesh_object.MeshPanel.current


def version():
    return tuple(int(number) for number in FreeCAD.Version()[:2])
