"""What keeps the window and the document sound when something unforeseen goes wrong in the middle."""

import traceback
from contextlib import contextmanager

import FreeCAD
from PySide import QtCore, QtGui

from ..errors import MeshError


@contextmanager
def mesh_errors(stage):
    """Any error inside becomes a MeshError of this stage, which the panels can show."""
    try:
        yield
    except MeshError:
        raise
    except Exception as error:
        FreeCAD.Console.PrintLog(traceback.format_exc())
        raise MeshError(stage, "internal", "%s: %s" % (type(error).__name__, error)) from error


@contextmanager
def patience(stage):
    """mesh_errors(), and the cursor tells to wait."""
    QtGui.QApplication.setOverrideCursor(QtCore.Qt.WaitCursor)
    try:
        with mesh_errors(stage):
            yield
    finally:
        QtGui.QApplication.restoreOverrideCursor()


@contextmanager
def undo_step(document, title):
    """What happens inside is one step that can be undone; after an error nothing of it stays."""
    document.openTransaction(title)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
