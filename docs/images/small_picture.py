"""Small pictures of FreeCAD's window for the documentation (used by the scripts that run inside it)."""

import os
import sys

import numpy as np
from PySide import QtCore, QtGui
from scipy.spatial import cKDTree

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(ROOT, "tests", "gui"))

import drive  # noqa: E402

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
