"""Our commands inside FreeCAD's own FEM workbench, in its Mesh menu and toolbar.

FreeCAD 1.0 has workbench manipulators for this; before, the menu and the toolbar are completed each time the
FEM workbench is opened, because FreeCAD builds them anew.
"""

import FreeCADGui

from . import commands

NEIGHBOUR = "FEM_MeshGmshFromShape"
TOOLBAR = "Mesh"


class FemManipulator:
    """FreeCAD 1.0 and later ask this object."""

    def modifyMenuBar(self):
        return [{"insert": name, "menuItem": NEIGHBOUR, "after": ""} for name in reversed(commands.IN_FEM)]

    def modifyToolBars(self):
        return [{"append": name, "toolBar": TOOLBAR} for name in commands.IN_FEM]


def install():
    """Take care that the commands appear."""
    if hasattr(FreeCADGui, "addWorkbenchManipulator"):
        install.manipulator = FemManipulator()
        FreeCADGui.addWorkbenchManipulator(install.manipulator)
        return
    from PySide import QtCore

    window = FreeCADGui.getMainWindow()
    window.workbenchActivated.connect(
        lambda name: QtCore.QTimer.singleShot(0, complete) if name == "FemWorkbench" else None
    )


def complete():
    """Add the commands to menu and toolbar where they are missing."""
    from PySide import QtGui

    window = FreeCADGui.getMainWindow()
    for menu in window.menuBar().findChildren(QtGui.QMenu):
        insert_after(menu, [action.objectName() for action in menu.actions()])
    for bar in window.findChildren(QtGui.QToolBar):
        if bar.objectName() == TOOLBAR:
            insert_after(bar, [action.objectName() for action in bar.actions()])


def insert_after(place, names):
    """Insert our actions behind the neighbour's in a menu or toolbar, once."""
    if NEIGHBOUR not in names or commands.IN_FEM[0] in names:
        return
    actions = place.actions()
    position = names.index(NEIGHBOUR) + 1
    before = actions[position] if position < len(actions) else None
    for name in commands.IN_FEM:
        for action in new_actions(name, place):
            place.insertAction(before, action)


def new_actions(name, parent):
    """The actions FreeCAD has for a command; our own when the command has been shown nowhere yet."""
    from PySide import QtGui

    command = FreeCADGui.Command.get(name)
    actions = command.getAction() if command else []
    if actions:
        return actions
    resources = commands.COMMANDS[name].GetResources()
    action = QtGui.QAction(FreeCADGui.getIcon(resources["Pixmap"]), resources["MenuText"], parent)
    action.setObjectName(name)
    action.setToolTip(resources["ToolTip"])
    action.triggered.connect(lambda *_: FreeCADGui.runCommand(name))
    return [action]
