"""A histogram drawn with plain Qt: bars coloured from bad to good, the target as a line."""

from PySide import QtCore, QtGui

from .colours import colour_of, quality_scale
from .texts import tr

BARS = 36
MARGIN_LEFT, MARGIN_RIGHT, MARGIN_TOP, MARGIN_BOTTOM = 8, 8, 18, 22


class Histogram(QtGui.QWidget):
    """Counts of values in [low, high]; a tooltip tells those of the bar under the mouse."""

    def __init__(self):
        super().__init__()
        self.setMinimumSize(180, 150)
        self.setMouseTracking(True)
        self.counts, self.measure, self.target = [], None, None

    def show_values(self, values, measure, target=None):
        """values (t,) of a measure; target: value to mark, or None."""
        import numpy as np

        self.measure, self.target = measure, target
        clipped = np.clip(values, measure.low, measure.high)
        self.counts = np.histogram(clipped, BARS, (measure.low, measure.high))[0].tolist()
        self.update()

    def plot(self):
        """The rectangle of the bars."""
        return self.rect().adjusted(MARGIN_LEFT, MARGIN_TOP, -MARGIN_RIGHT, -MARGIN_BOTTOM)

    def place(self, value):
        """Horizontal place of a value."""
        area = self.plot()
        share = (value - self.measure.low) / (self.measure.high - self.measure.low)
        return area.left() + share * area.width()

    def paintEvent(self, event):
        painter = QtGui.QPainter(self)
        painter.fillRect(self.rect(), self.palette().base())
        if self.counts:
            self.paint_bars(painter)
            self.paint_axis(painter)
        painter.end()

    def paint_bars(self, painter):
        area, most = self.plot(), max(max(self.counts), 1)
        scale = quality_scale()
        width = area.width() / float(BARS)
        painter.setPen(QtCore.Qt.NoPen)
        for bar, count in enumerate(self.counts):
            height = area.height() * count / float(most)
            if count:
                height = max(height, 2.0)  # a single bad element must be seen
            middle = (bar + 0.5) / BARS
            value = self.measure.low + middle * (self.measure.high - self.measure.low)
            painter.setBrush(QtGui.QColor.fromRgbF(*colour_of(self.measure.goodness(value), scale)))
            painter.drawRect(
                QtCore.QRectF(area.left() + bar * width + 0.5, area.bottom() - height, width - 1, height)
            )

    def paint_axis(self, painter):
        area = self.plot()
        painter.setPen(self.palette().text().color())
        painter.drawLine(area.bottomLeft(), area.bottomRight())
        for value in self.measure.ticks:
            x = int(self.place(value))
            painter.drawLine(x, area.bottom(), x, area.bottom() + 3)
            box = QtCore.QRect(x - 20, area.bottom() + 4, 40, MARGIN_BOTTOM - 4)
            painter.drawText(box, QtCore.Qt.AlignHCenter | QtCore.Qt.AlignTop, "%g" % value)
        if self.target is not None:
            x = int(self.place(self.target))
            painter.setPen(QtGui.QPen(QtGui.QColor("#c0392b"), 1, QtCore.Qt.DashLine))
            painter.drawLine(x, area.top() - 4, x, area.bottom())
            text = tr("target %g\u00b0") % self.target
            painter.drawText(x + 4, area.top() - 4, text)

    def mouseMoveEvent(self, event):
        area = self.plot()
        position = event.pos()
        bar = int(BARS * (position.x() - area.left()) / max(area.width(), 1))
        if not self.counts or not 0 <= bar < BARS:
            return
        step = (self.measure.high - self.measure.low) / float(BARS)
        low = self.measure.low + bar * step
        text = tr("%.4g to %.4g: %d elements") % (low, low + step, self.counts[bar])
        QtGui.QToolTip.showText(self.mapToGlobal(position), text, self)
