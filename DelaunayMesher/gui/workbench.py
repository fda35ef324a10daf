"""The workbench with its menu and toolbar."""

import FreeCAD
import FreeCADGui

from . import commands
from .texts import icon, tr


class DelaunayMesherWorkbench(FreeCADGui.Workbench):
    """Meshing next to the analysis commands of the FEM workbench that one needs around it."""

    Icon = icon("delaunay_mesher")

    def __init__(self):
        self.__class__.MenuText = tr("Delaunay Mesher")
        self.__class__.ToolTip = tr("Tetrahedral meshes of solids for finite element analysis")

    def Initialize(self):
        """Called when the workbench is opened for the first time."""
        self.appendToolbar(tr("Delaunay Mesher"), commands.MESHING)
        self.appendMenu(tr("&Delaunay Mesher"), commands.NAMES)
        self.appendToolbar(tr("Analysis"), [*self.fem_commands(), *commands.ANALYSIS])

    def fem_commands(self):
        """Commands of FreeCAD's FEM workbench that are there; none where that workbench does not load."""
        try:
            import femcommands.commands  # noqa: F401  registers them
            import FemGui  # noqa: F401
        except ImportError as error:
            FreeCAD.Console.PrintWarning("Delaunay Mesher: the FEM workbench does not load: %s\n" % error)
            return []

        wanted = ["FEM_Analysis", "FEM_MaterialSolid"]
        known = FreeCADGui.listCommands()
        return [name for name in wanted if name in known]

    def ContextMenu(self, recipient):
        """Offered on a right click in this workbench."""
        self.appendContextMenu(tr("Delaunay Mesher"), commands.NAMES)

    def GetClassName(self):
        return "Gui::PythonWorkbench"
