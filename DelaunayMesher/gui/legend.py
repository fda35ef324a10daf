"""A strip of colours with the sizes at its ends."""

from PySide import QtCore, QtGui

from .colours import size_scale

HEIGHT = 12


class Legend(QtGui.QWidget):
    """Hidden until show_range()."""

    def __init__(self):
        super().__init__()
        self.low, self.high = QtGui.QLabel(), QtGui.QLabel()
        self.strip = Strip()
        line = QtGui.QHBoxLayout(self)
        line.setContentsMargins(0, 0, 0, 0)
        line.addWidget(self.low)
        line.addWidget(self.strip, 1)
        line.addWidget(self.high)
        self.hide()

    def show_range(self, low, high):
        """Texts at the two ends."""
        self.low.setText(low)
        self.high.setText(high)
        self.show()


class Strip(QtGui.QWidget):
    """The colours of sizes from small to large."""

    def __init__(self):
        super().__init__()
        self.setFixedHeight(HEIGHT)

    def paintEvent(self, event):
        painter = QtGui.QPainter(self)
        gradient = QtGui.QLinearGradient(0, 0, self.width(), 0)
        for place, colour in size_scale():
            gradient.setColorAt(place, QtGui.QColor.fromRgbF(*colour))
        painter.fillRect(QtCore.QRect(0, 0, self.width(), HEIGHT), gradient)
        painter.end()
