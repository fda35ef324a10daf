"""Runs in FreeCAD's window (see make_pictures.py): the steps of docs/gui.md, one picture each."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "gui"))

import drive  # noqa: E402
import FemGui  # noqa: E402
import FreeCAD  # noqa: E402
import FreeCADGui  # noqa: E402
import numpy as np  # noqa: E402
import ObjectsFem  # noqa: E402
from drive import wait, wait_until  # noqa: E402
from PySide import QtCore, QtGui  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

WIDTH = 1000
COLOURS = 160


def picture(name):
    """A small picture: scaled down, with the 256 colours that suit it best."""
    drive.picture(name)
    path = os.path.join(drive.OUTPUT, name + ".png")
    image = QtGui.QImage(path).scaledToWidth(WIDTH, QtCore.Qt.SmoothTransformation)
    few_colours(image.convertToFormat(QtGui.QImage.Format_RGB32)).save(path, "PNG", 0)


def few_colours(image):
    """The picture with a table of colours: k-means, started from the most frequent ones."""
    pixels = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(-1, 4)[:, :3]
    colours, which, counts = np.unique(pixels >> 2 << 2, axis=0, return_inverse=True, return_counts=True)
    means = colours[np.argsort(-counts)[:COLOURS]].astype(float)
    for _ in range(10):
        nearest = cKDTree(means).query(colours)[1]
        weights = np.bincount(nearest, counts, len(means))
        for channel in range(3):
            sums = np.bincount(nearest, counts * colours[:, channel], len(means))
            means[:, channel] = np.where(weights > 0, sums / np.maximum(weights, 1), means[:, channel])
    width, height = image.width(), image.height()
    data = nearest[which.reshape(-1)].astype(np.uint8).tobytes()
    result = QtGui.QImage(data, width, height, width, QtGui.QImage.Format_Indexed8).copy()
    result.setColorCount(len(means))
    for index, (blue, green, red) in enumerate(means.astype(int).tolist()):
        result.setColor(index, QtGui.QColor(red, green, blue).rgb())
    return result


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
