"""In FreeCAD's window: start is quick, the preferences page opens, a missing extension is explained."""

import gc
import os
import sys
import time

import drive
import FreeCAD
import FreeCADGui
from drive import say, wait
from PySide import QtCore, QtGui

LONGEST_START = 0.25  # seconds; some 0.02 on a machine that does nothing else


def start_is_quick():
    """Nothing heavy was imported when the window started; importing it all again takes little."""
    ours = [name for name in sys.modules if name.startswith("DelaunayMesher")]
    say("modules after the start:", sorted(ours))
    assert "DelaunayMesher.options" not in ours and "DelaunayMesher.document" not in ours
    for name in ours:
        del sys.modules[name]
    begin = time.perf_counter()
    from DelaunayMesher.gui import startup  # noqa: F401

    taken = time.perf_counter() - begin
    say("import of the workbench %.3f s" % taken)
    assert taken < LONGEST_START


def missing_extension():
    """Without the compiled part the command says what to do, and nothing is made."""
    from DelaunayMesher import extension
    from DelaunayMesher.errors import MeshError

    def fail():
        raise MeshError("extension", "no_extension", "there is no _core")

    document = FreeCAD.newDocument("Part")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    drive.select(box)
    loaded, extension.load = extension.load, fail
    text = drive.message_of(lambda: FreeCADGui.runCommand("DelaunayMesher_MeshSolid"))
    extension.load = loaded
    say(text)
    assert "setup.sh" in text and "pip install" in text and "no _core" in text
    assert os.path.join(drive.ROOT, "compiled") in text or "Mod/DelaunayMesher/compiled" in text
    assert document.Objects == [box]


def narrow_panel():
    """The panel makes room for itself in FreeCAD's narrow side panel, and its fields live on."""
    drive.arrange(200)
    document = FreeCAD.newDocument("Narrow")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    drive.select(box)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    for _ in range(5):
        wait(0.1)
        gc.collect()
    panel = drive.panel()
    assert not panel.run_box.button.icon().pixmap(16, 16).isNull()
    assert panel.options_box.width() >= panel.options_box.minimumSizeHint().width()
    assert panel.options_box.fields["max_size"].value() > 0
    assert panel.reject()


def preferences_dialog():
    """Our page is in FreeCAD's dialog and can be drawn."""

    def look():
        dialog = QtGui.QApplication.activeModalWidget()
        found.extend(box for box in dialog.findChildren(QtGui.QGroupBox) if "new meshes" in box.title())
        dialog.reject()

    found = []
    QtCore.QTimer.singleShot(1500, look)
    FreeCADGui.showPreferences("Delaunay Mesher", 0)
    wait(0.3)
    assert found


def package_is_valid():
    """FreeCAD's Addon Manager finds in package.xml what is there."""
    from DelaunayMesher import __version__

    metadata = FreeCAD.Metadata(os.path.join(drive.ROOT, "package.xml"))
    workbench = metadata.Content["workbench"][0]
    say(metadata.Name, metadata.Version, workbench.Classname)
    assert metadata.Version == __version__
    assert workbench.Classname in FreeCADGui.listWorkbenches()
    assert metadata.Name and metadata.Description and metadata.Maintainer[0]["email"]
    assert all("example" not in url["location"] for url in metadata.Urls)  # it would be installed from there
    for name in (metadata.Icon, workbench.Icon, metadata.License[0]["file"]):
        assert os.path.isfile(os.path.join(drive.ROOT, name)), name


def main():
    start_is_quick()
    drive.activate()
    missing_extension()
    narrow_panel()
    preferences_dialog()
    package_is_valid()


drive.start(main, "START")
