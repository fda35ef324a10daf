"""Translation of what people read, and the paths of icons and translations."""

import os

import FreeCAD

CONTEXT = "DelaunayMesher"
RESOURCES = os.path.join(
    os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "resources"
)
ICONS = os.path.join(RESOURCES, "icons")
TRANSLATIONS = os.path.join(RESOURCES, "translations")


def tr(text):
    """`text` in the language of the window."""
    return FreeCAD.Qt.translate(CONTEXT, text)


def icon(name):
    """Path of an icon of this workbench."""
    return os.path.join(ICONS, name + ".svg")


def qt_icon(name):
    """QIcon of this workbench.  FreeCAD draws it: Qt itself needs a plugin for SVG that may be missing."""
    import FreeCADGui

    return FreeCADGui.getIcon(icon(name))
