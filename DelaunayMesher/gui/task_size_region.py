"""The panel of a size region.  The view follows its fields; Cancel takes the changes back."""

import FreeCADGui
from PySide import QtCore, QtGui

from ..document.size_region import KINDS, PROPERTIES, USED
from .option_fields import LARGEST, NARROW
from .texts import qt_icon, tr

KIND_LABELS = {"Sphere": "Sphere", "Box": "Box", "Cylinder": "Cylinder"}
LABELS = {
    ("Sphere", "Point"): "Centre",
    ("Sphere", "Radius"): "Radius",
    ("Box", "Point"): "Corner",
    ("Box", "SecondPoint"): "Opposite corner",
    ("Cylinder", "Point"): "Start of the axis",
    ("Cylinder", "SecondPoint"): "End of the axis",
    ("Cylinder", "Radius"): "Radius",
}
POINTS = ("Point", "SecondPoint")
LENGTHS = ("Radius", "Size", "Transition")


class SizeRegionPanel:
    """What FreeCAD's task dialog wants: form, accept, reject."""

    current = None  # the one that was opened last

    def __init__(self, target):
        SizeRegionPanel.current = self
        self.target = target
        target.Document.openTransaction("Size region")
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(tr("Size region"))
        self.form.setWindowIcon(qt_icon("size_region"))
        self.grid = QtGui.QGridLayout(self.form)
        self.grid.setColumnStretch(1, 1)
        self.kind = QtGui.QComboBox()
        self.kind.addItems([tr(KIND_LABELS[kind]) for kind in KINDS])
        self.kind.setCurrentIndex(list(KINDS).index(target.Kind))
        self.kind.currentIndexChanged.connect(self.change_kind)
        self.labels, self.fields, self.lines = {}, {}, {}
        self.grid.addWidget(QtGui.QLabel(tr("Kind:")), 0, 0)
        self.grid.addWidget(self.kind, 0, 1)
        for name in POINTS:
            self.add_row(name, ["%s.%s" % (name, axis) for axis in "xyz"])
        for name in LENGTHS:
            self.add_row(name, [name])
        self.labels["Size"].setText(tr("Size:"))
        self.labels["Transition"].setText(tr("Transition:"))
        self.show_used()

    def add_row(self, name, paths):
        """A label and a field for each number of a property."""
        tip = tr(next(text for other, _, text in PROPERTIES if other == name))
        self.labels[name] = QtGui.QLabel()
        self.labels[name].setToolTip(tip)
        row = self.grid.rowCount()
        self.grid.addWidget(self.labels[name], row, 0, QtCore.Qt.AlignTop)
        column = QtGui.QVBoxLayout()
        self.grid.addLayout(column, row, 1)
        for path in paths:
            field = self.make_field(path)
            field.setToolTip(tip)
            self.lines[path] = QtGui.QWidget()
            line = QtGui.QHBoxLayout(self.lines[path])
            line.setContentsMargins(0, 0, 0, 0)
            if "." in path:
                line.addWidget(QtGui.QLabel(path[-1]))
            line.addWidget(field, 1)
            column.addWidget(self.lines[path])
            self.fields[path] = field

    def make_field(self, path):
        """A length that follows the property and sets it; units and expressions are welcome."""
        field = FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox")
        field.setProperty("unit", "mm")
        field.setProperty("minimum", -LARGEST if "." in path else 0.0)
        field.setProperty("maximum", LARGEST)
        field.setMinimumWidth(NARROW)
        FreeCADGui.ExpressionBinding(field).bind(self.target, path)
        field.setProperty("rawValue", self.read(path))
        QtCore.QObject.connect(field, QtCore.SIGNAL("valueChanged(double)"), lambda *_: self.write(path))
        return field

    def read(self, path):
        """The number at 'Point.x' or 'Radius', in mm."""
        name, _, axis = path.partition(".")
        value = getattr(self.target, name)
        return float(getattr(value, axis) if axis else value.Value)

    def write(self, path):
        """Put a field's number into the object, unless an expression is in charge of it."""
        if any(other.lstrip(".") == path for other, *_ in self.target.ExpressionEngine):
            return
        name, _, axis = path.partition(".")
        number = float(self.fields[path].property("rawValue"))
        if axis:
            point = getattr(self.target, name)
            setattr(point, axis, number)
            number = point
        setattr(self.target, name, number)

    def change_kind(self, index):
        self.target.Kind = list(KINDS)[index]
        self.show_used()

    def show_used(self):
        """Only the fields that the kind needs."""
        kind = self.target.Kind
        for path, line in self.lines.items():
            name = path.partition(".")[0]
            line.setVisible(name in USED[kind] or name in ("Size", "Transition"))
        for name in ("Point", "SecondPoint", "Radius"):
            self.labels[name].setVisible(name in USED[kind])
            self.labels[name].setText(tr(LABELS.get((kind, name), "")) + ":")

    def accept(self):
        self.target.Document.commitTransaction()
        return self.close()

    def reject(self):
        self.target.Document.abortTransaction()
        return self.close()

    def close(self):
        FreeCADGui.ActiveDocument.resetEdit()
        return True
