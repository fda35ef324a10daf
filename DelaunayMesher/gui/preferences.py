"""What new meshes start with and the colours: the user's preferences, or the defaults.

Only what FreeCAD's start needs is imported at the top.
"""

import FreeCAD

PATH = "User parameter:BaseApp/Preferences/Mod/DelaunayMesher"
WINDOW_DEFAULTS = {"order": 2}  # as FreeCAD's other meshers: straight elements are too stiff for stresses


def group():
    """The parameter group."""
    return FreeCAD.ParamGet(PATH)


def stored_options():
    """The rows of the options table that have a preference: all but lengths, which depend on the part."""
    from ..options import OPTIONS

    return [option for option in OPTIONS if option.kind != "length"]


def stored_value(option):
    """The preference for an option, checked; the default when there is none or it makes no sense."""
    from ..errors import InputError

    text = group().GetString(option.property_name, "")
    if not text:
        return default(option)
    if option.kind == "bool":
        return text == "True"
    try:
        return option.check(float(text))
    except (InputError, ValueError):
        return default(option)


def default(option):
    """What holds without a preference."""
    return WINDOW_DEFAULTS.get(option.name, option.default)


def store_value(option, value):
    """Keep a preference; the default is not written down."""
    if value == default(option):
        group().RemString(option.property_name)
    else:
        group().SetString(option.property_name, repr(value))


def options_for(part):
    """{name: value} that differs from the table's defaults, for a new mesh of `part`."""
    from ..document import estimate
    from ..document.placement import own_shape

    chosen = {option.name: stored_value(option) for option in stored_options()}
    changed = {
        option.name: chosen[option.name]
        for option in stored_options()
        if chosen[option.name] != option.default
    }
    shape = own_shape(part)
    size = estimate.suggested_size(shape) if shape else 0.0
    return {"max_size": size, **changed} if size else changed


class PreferencesPage:
    """The page in FreeCAD's preferences dialog; FreeCAD makes one when the dialog opens."""

    def __init__(self, parent=None):
        from PySide import QtGui

        from .option_fields import make_field
        from .texts import tr

        self.form = QtGui.QWidget(parent)
        self.form.setWindowTitle(tr("General"))
        outer = QtGui.QVBoxLayout(self.form)
        box = QtGui.QGroupBox(tr("Defaults of new meshes"))
        grid = QtGui.QGridLayout(box)
        self.fields = [make_field(option) for option in stored_options()]
        for row, field in enumerate(self.fields):
            field.add_to(grid, row)
        grid.setColumnStretch(1, 1)
        outer.addWidget(box)
        outer.addWidget(self._colour_box())
        outer.addStretch(1)

    def _colour_box(self):
        import FreeCADGui
        from PySide import QtGui

        from .texts import tr

        box = QtGui.QGroupBox(tr("Colours"))
        form = QtGui.QFormLayout(box)
        labels = {
            "ColourBad": tr("Bad elements"),
            "ColourGood": tr("Good elements"),
            "ColourSmall": tr("Small sizes"),
            "ColourLarge": tr("Large sizes"),
            "ColourChosen": tr("Chosen element"),
        }
        self.colours = {name: FreeCADGui.UiLoader().createWidget("Gui::ColorButton") for name in labels}
        for name, text in labels.items():
            form.addRow(text + ":", self.colours[name])
        return box

    def loadSettings(self):
        from PySide import QtGui

        from .colours import stored_colour

        for field in self.fields:
            field.set(stored_value(field.option))
        for name, button in self.colours.items():
            button.setProperty("color", QtGui.QColor.fromRgbF(*stored_colour(name)))

    def saveSettings(self):
        from .colours import store_colour

        for field in self.fields:
            store_value(field.option, field.value())
        for name, button in self.colours.items():
            store_colour(name, button.property("color").getRgbF()[:3])
