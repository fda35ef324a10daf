"""What happens when the window starts: the workbench and its commands become known to FreeCAD."""

import FreeCADGui

from . import commands, fem_menu, texts
from .workbench import DelaunayMesherWorkbench


def start():
    """Register everything; called once by InitGui.py."""
    FreeCADGui.addLanguagePath(texts.TRANSLATIONS)
    FreeCADGui.updateLocale()
    commands.register()
    FreeCADGui.addWorkbench(DelaunayMesherWorkbench())
    fem_menu.install()
    add_preferences()


def add_preferences():
    """Our page in the preferences; its widgets are made when somebody opens it."""
    from .preferences import PreferencesPage

    FreeCADGui.addIconPath(texts.ICONS)  # preferences-delaunay_mesher.svg is there
    FreeCADGui.addPreferencePage(PreferencesPage, "Delaunay Mesher")
