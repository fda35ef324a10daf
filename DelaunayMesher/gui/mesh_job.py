"""One run of the mesher in a thread of its own.

The document is read before (in the constructor) and written after (store()), both in the thread of the
window; between, the thread touches copies only.  The core runs without Python's lock, so the window stays
alive.  The panel asks for `stage`, `fraction` and `finished` now and then, so that no signal crosses threads.
"""

import threading
import time
import traceback

import FreeCAD
from PySide import QtCore

from ..document import history, mesh_object
from ..document.femmesh import fill, put
from ..errors import MeshCancelled, MeshError
from ..progress import Progress
from .guards import mesh_errors, undo_step
from .texts import tr

LONGEST_STOP = 5.0  # seconds that the end of FreeCAD waits for a thread
unfinished = []


def remember(job):
    """Take care that FreeCAD ends only when the job's thread has: it must not outlive Python."""
    if not unfinished:
        QtCore.QCoreApplication.instance().aboutToQuit.connect(stop_all)
    unfinished[:] = [other for other in unfinished if not other.finished] + [job]


def stop_all():
    """Cancel what runs and wait for it."""
    for job in unfinished:
        job.cancel()
    for job in unfinished:
        job.thread.join(LONGEST_STOP)


class MeshJob:
    """Prepared by the constructor (raises MeshError), then start(), and store() once `finished` and good."""

    def __init__(self, target):
        with mesh_errors("options"):
            self.task = mesh_object.collect(target)
            self.task.detach()
        self.where = (target.Document.Name, target.Name)
        self.stage, self.fraction = "plc", 0.0
        self.mesh = self.filling = self.error = None
        self.cancelled = False
        self.progress = Progress()
        self.begin = self.end = time.monotonic()
        self.thread = threading.Thread(target=self.run, name="DelaunayMesher", daemon=True)

    def start(self):
        self.begin = time.monotonic()
        self.thread.start()
        remember(self)

    def cancel(self):
        """Ask the thread to stop; it does within some ten milliseconds of the core's work."""
        self.cancelled = True

    @property
    def finished(self):
        return not self.thread.is_alive()

    @property
    def seconds(self):
        """Time since the start; of a finished run, its length."""
        return (self.end if self.finished else time.monotonic()) - self.begin

    def run(self):
        """In the thread: shape -> mesh -> what the document is to get, and the figures for the report."""
        try:
            mesh = self.task.mesh(self.report)
            self.proceed("write", 0.0)
            start = time.monotonic()
            measure = threading.Thread(target=lambda: mesh.quality, name="DelaunayMesher quality")
            measure.start()
            filling = fill(mesh, self.task.groups)
            taken = time.monotonic() - start
            mesh.seconds = {**mesh.seconds, "write": taken}
            mesh.total_seconds += taken
            self.proceed("quality", 0.0)
            measure.join()
            self.proceed("quality", 1.0)
            self.mesh, self.filling = mesh, filling
        except MeshError as error:
            self.error = error
        except Exception as error:
            FreeCAD.Console.PrintLog(traceback.format_exc())
            self.error = MeshError(self.stage, "internal", "%s: %s" % (type(error).__name__, error))
        self.end = time.monotonic()

    def report(self, stage, fraction):
        """Called by the core now and then; False stops it."""
        self.stage = stage
        self.fraction = self.progress(stage, fraction)
        return not self.cancelled

    def proceed(self, stage, fraction):
        """report() for this thread's own steps; raises MeshCancelled."""
        if not self.report(stage, fraction):
            raise MeshCancelled(stage)

    def target(self):
        """The mesh object, or None when it or its document has gone meanwhile."""
        document = FreeCAD.listDocuments().get(self.where[0])
        return document.getObject(self.where[1]) if document else None

    def store(self, target):
        """Put the finished mesh into the mesh object and show it: one step that can be undone.

        The mesh itself stays out of FreeCAD's transactions, which cannot bring an old one back.
        """
        target.Document.commitTransaction()  # a double click in FreeCAD's tree leaves one open
        with mesh_errors("write"), history.kept(target):
            for _ in put(target, self.filling):
                QtCore.QCoreApplication.processEvents(QtCore.QEventLoop.ExcludeUserInputEvents)
            with undo_step(target.Document, tr("Delaunay mesh run")):
                mesh_object.record(target, self.mesh, self.task)
                show_mesh_instead_of_part(target)
        self.mesh = self.filling = None
        target.recompute()


def show_mesh_instead_of_part(target):
    """Both at once would hide each other's faces."""
    target.ViewObject.show()
    if target.Shape and target.Shape.ViewObject:
        target.Shape.ViewObject.hide()
