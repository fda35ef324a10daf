"""One run of CalculiX beside the window, with what the mesh panel asks of a job (see mesh_job.py).

Writing the input and reading the results is FreeCAD's work in the thread of the window; CalculiX is a
process.
"""

import time

import FreeCAD
from PySide import QtCore

from ..document.calculix import Calculation
from ..errors import MeshCancelled
from .guards import patience, undo_step
from .texts import tr

STRESS_FIELDS = ("von Mises Stress", "von Mises stress")


class SolveJob:
    """Prepared by the constructor (raises MeshError), then start(), and store() once `finished` and good."""

    stage, fraction = "solve", None
    shown = None  # the object with the stresses, after store()

    def __init__(self, target):
        self.where = (target.Document.Name, target.Name)
        self.cancelled = False
        self.begin, self.end = time.monotonic(), None
        with patience("solve"), undo_step(target.Document, tr("CalculiX")):  # a missing solver is made
            self.calculation = Calculation(target)

    def start(self):
        self.process = self.calculation.start()

    def cancel(self):
        self.cancelled = True
        self.process.kill()

    @property
    def finished(self):
        if self.end is None and self.process.state() == QtCore.QProcess.NotRunning:
            self.end = time.monotonic()
        return self.end is not None

    @property
    def seconds(self):
        """Time since the start; of a finished run, its length."""
        return (self.end or time.monotonic()) - self.begin

    @property
    def error(self):
        """MeshCancelled after cancel(); what CalculiX itself says is found out by store()."""
        return MeshCancelled(self.stage) if self.cancelled else None

    def target(self):
        """The mesh object, or None when it or its document has gone meanwhile."""
        document = FreeCAD.listDocuments().get(self.where[0])
        return document.getObject(self.where[1]) if document else None

    def store(self, target):
        """Read the results into the analysis, as one step that can be undone, and show the stresses.

        Returns the result object; raises MeshError when there is none.
        """
        with patience("solve"), undo_step(target.Document, tr("Results of CalculiX")):
            result = self.calculation.load()
            self.shown = show_stress(result, self.calculation.analysis)
            hide(target, target.Shape)
        return result


def hide(*items):
    """So that they do not cover the stresses; None is left out."""
    for item in items:
        if item is not None and item.ViewObject:
            item.ViewObject.hide()


def show_stress(result, analysis):
    """Colour the pipeline of FreeCAD 1.0 and later, or the mesh of the result, by the von Mises stress.

    Returns the object that FreeCAD has a panel for.
    """
    pipelines = [item for item in analysis.Group if item.isDerivedFrom("Fem::FemPostPipeline")]
    if not pipelines:
        from femresult.resulttools import show_result

        result.Mesh.ViewObject.show()
        show_result(result, "Sabs")
        return result
    if hasattr(result, "Mesh") and result.Mesh:
        result.Mesh.ViewObject.hide()
    view = pipelines[-1].ViewObject
    view.show()
    view.DisplayMode = "Surface"
    fields = view.getEnumerationsOfProperty("Field")
    view.Field = next((name for name in STRESS_FIELDS if name in fields), view.Field)
    return pipelines[-1]
