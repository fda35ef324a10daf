"""Input fields made from the rows of options.py, each tied to a property of the mesh object or a preference.

A field has value() and set(value) in the option's own type, None for automatic.  Lengths and angles take
units and expressions, as everywhere in FreeCAD.
"""

import math

import FreeCADGui
from PySide import QtCore, QtGui

from ..document.properties import choice_names, sentence
from .texts import tr

UNITS = {"length": "mm", "angle": "deg"}
LARGEST = 1e9
DECIMALS = 12
NARROW = 96  # pixels that a field needs at least: FreeCAD's panels are narrow at first
CHOICE_LABELS = {
    ("order", 1): "First (4 nodes)",
    ("order", 2): "Second (10 nodes)",
}


class Field:
    """A labelled widget for one option; `changed` functions are called when the user changes it."""

    def __init__(self, option):
        self.option = option
        self.listeners = []
        self.label = QtGui.QLabel(tr(option.label) + ":")
        self.widget = self.make()
        self.automatic = None
        tip = tr(sentence(option.help))
        self.label.setToolTip(tip)
        self.widget.setToolTip(tip)
        self.widget.setObjectName(option.property_name)
        if option.default is None:
            self.automatic = QtGui.QCheckBox(tr("auto"))
            self.automatic.setToolTip(tr("Chosen from the size of the part"))
            self.automatic.setObjectName(option.property_name + "Automatic")
            self.automatic.toggled.connect(self.on_automatic)

    def add_to(self, grid, row):
        """Place label, field and check box in a row of a grid layout."""
        grid.addWidget(self.label, row, 0)
        if self.automatic is None:
            grid.addWidget(self.widget, row, 1, 1, 2)
        else:
            grid.addWidget(self.widget, row, 1)
            grid.addWidget(self.automatic, row, 2)

    def on_automatic(self, on):
        self.widget.setEnabled(not on)
        self.notify()

    def notify(self, *_):
        for listener in self.listeners:
            listener()

    def value(self):
        """The chosen value; None when automatic."""
        if self.automatic is not None and self.automatic.isChecked():
            return None
        return self.read()

    def set(self, value):
        """Show a value; None ticks 'automatic'."""
        if self.automatic is not None:
            self.automatic.setChecked(value is None)
        if value is not None:
            self.write(value)

    def show_automatic(self, value):
        """What an automatic value comes to at the moment."""
        if self.value() is None:
            self.write(value)

    def bind(self, target):
        """Accept expressions for the property of this document object."""

    def is_bound_to_expression(self, target):
        """Whether an expression of the document decides the value."""
        return any(path == self.option.property_name for path, *_ in target.ExpressionEngine)


class QuantityField(Field):
    """Length or angle."""

    def make(self):
        widget = FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox")
        widget.setProperty("unit", UNITS[self.option.kind])
        widget.setProperty("minimum", self.option.minimum or 0.0)
        widget.setProperty("maximum", self.option.maximum or LARGEST)
        widget.setMinimumWidth(NARROW)
        QtCore.QObject.connect(widget, QtCore.SIGNAL("valueChanged(double)"), self.notify)
        return widget

    def read(self):
        return float(self.widget.property("rawValue"))

    def write(self, value):
        self.widget.setProperty("rawValue", float(value))
        self.widget.setProperty("singleStep", step_for(value))

    def bind(self, target):
        FreeCADGui.ExpressionBinding(self.widget).bind(target, self.option.property_name)


class ShortSpinBox(QtGui.QDoubleSpinBox):
    """12 instead of 12.00, and all digits of what a document holds: Qt rounds the value to its decimals."""

    def __init__(self):
        super().__init__()
        self.setDecimals(DECIMALS)

    def textFromValue(self, value):
        # Not by QLocale.toString(), which PySide calls in single precision.
        return ("%.*g" % (DECIMALS, value)).replace(".", self.locale().decimalPoint())


class SpinField(Field):
    """A number in a spin box of Qt's."""

    def read(self):
        return self.widget.value()

    def write(self, value):
        self.widget.setValue(value)


class NumberField(SpinField):
    """Number without a unit."""

    def make(self):
        widget = ShortSpinBox()
        widget.setMinimumWidth(NARROW)
        least = 10.0**-DECIMALS if self.option.open_minimum else 0.0
        widget.setRange(self.option.minimum + least, self.option.maximum)
        widget.setSingleStep(0.05 if self.option.default < 1 else 1.0)
        widget.valueChanged.connect(self.notify)
        return widget


class WholeField(SpinField):
    """Whole number; 0 means automatic where the help says so."""

    def make(self):
        widget = QtGui.QSpinBox()
        widget.setMinimumWidth(NARROW)
        widget.setRange(self.option.minimum, self.option.maximum)
        if self.option.name in ("threads", "max_elements"):
            widget.setSpecialValueText(tr("automatic"))
        if self.option.name == "max_elements":
            widget.setSingleStep(100000)
            widget.setGroupSeparatorShown(True)
        widget.valueChanged.connect(self.notify)
        return widget


class CheckField(Field):
    """Yes or no."""

    def make(self):
        widget = QtGui.QCheckBox()
        widget.toggled.connect(self.notify)
        return widget

    def read(self):
        return self.widget.isChecked()

    def write(self, value):
        self.widget.setChecked(value)


class ChoiceField(Field):
    """One of a few."""

    def make(self):
        widget = QtGui.QComboBox()
        widget.setMinimumWidth(NARROW)
        widget.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
        for choice, name in zip(self.option.choices, choice_names(self.option)):
            widget.addItem(tr(CHOICE_LABELS.get((self.option.name, choice), name)))
        widget.currentIndexChanged.connect(self.notify)
        return widget

    def read(self):
        return self.option.choices[self.widget.currentIndex()]

    def write(self, value):
        self.widget.setCurrentIndex(self.option.choices.index(value))


KINDS = {
    "length": QuantityField,
    "angle": QuantityField,
    "float": NumberField,
    "int": WholeField,
    "bool": CheckField,
    "choice": ChoiceField,
}


def make_field(option):
    """The field for a row of the options table."""
    return KINDS[option.kind](option)


def step_for(value):
    """A step of the arrows that suits a value: a tenth of its power of ten."""
    return 10.0 ** (math.floor(math.log10(value)) - 1) if value > 0 else 0.1
