"""Creating a mesh object for a part, and opening the panel of one."""

import FreeCAD
import FreeCADGui

from .texts import tr

STATUS_MILLISECONDS = 15000


def create(part):
    """New mesh object for `part` with the default options, undoable, in the active analysis; its panel opens.

    The steps go through FreeCAD's Python console, so that macros can record them.
    """
    if not extension_is_there() or panel_is_open():
        return
    from ..document.placement import is_surface, own_shape
    from ..document.plc_from_shape import check_solid
    from ..errors import MeshError
    from . import preferences
    from .explain import explain
    from .guards import mesh_errors, undo_step

    document = part.Document
    try:
        with mesh_errors("options"), undo_step(document, tr("Delaunay mesh")):
            if not is_surface(part):
                check_solid(own_shape(part))
            arguments = "".join(", %s=%r" % item for item in preferences.options_for(part).items())
            FreeCADGui.addModule("DelaunayMesher.document")
            FreeCADGui.doCommand(
                "mesh = DelaunayMesher.document.add_mesh(FreeCAD.getDocument(%r).getObject(%r)%s)"
                % (document.Name, part.Name, arguments)
            )
    except MeshError as error:
        show_error("%s\n\n%s" % (part.Label, explain(error)))
        return
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.doCommand("FreeCADGui.getDocument(mesh.Document.Name).setEdit(mesh.Name)")


def edit(mesh):
    """Open the panel of a mesh object, unless another panel is open.  Its analysis becomes the active one."""
    if panel_is_open():
        return
    import FemGui

    from ..document import mesh_object

    analysis = mesh_object.analysis_of(mesh)
    if analysis is not None and FemGui.getActiveAnalysis() != analysis:
        FemGui.setActiveAnalysis(analysis)
    FreeCADGui.getDocument(mesh.Document.Name).setEdit(mesh.Name)


def solve(mesh):
    """Press Solve in the panel of a mesh object; it is opened first, unless a panel is open."""
    from .view_mesh_object import open_panel

    if open_panel(mesh) is None:
        edit(mesh)
    panel = open_panel(mesh)
    if panel is not None:
        panel.run_box.solve_button.click()  # which does nothing during a run


def panel_is_open():
    """Whether another task panel is open; the user is told."""
    if not FreeCADGui.Control.activeDialog():
        return False
    show_error(tr("Another task panel is open. Close it first."))
    return True


def extension_is_there():
    """Whether the compiled part can be loaded; otherwise the user is told what to do."""
    from . import installation

    problem = installation.problem()
    if problem:
        show_error(problem)
    return not problem


def show_error(text):
    """A message box, and the same in the report view."""
    from PySide import QtGui

    FreeCAD.Console.PrintError("Delaunay Mesher: %s\n" % text)
    QtGui.QMessageBox.warning(FreeCADGui.getMainWindow(), tr("Delaunay Mesher"), text)


def show_status(text):
    """A line in the status bar for some seconds, and in the report view."""
    FreeCAD.Console.PrintMessage("Delaunay Mesher: %s\n" % text)
    FreeCADGui.getMainWindow().statusBar().showMessage(text, STATUS_MILLISECONDS)
