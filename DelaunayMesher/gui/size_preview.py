"""Preview of the size field: computed in a thread, shown on the part's surface until an option changes."""

import threading

import FreeCAD
import numpy as np
from PySide import QtCore

from ..document import mesh_object
from ..document import preview as computation
from ..document.estimate import two_digits
from ..errors import MeshError
from .colours import size_scale
from .explain import explain
from .guards import mesh_errors
from .mesh_job import remember
from .overlay import Overlay
from .run_box import number
from .texts import tr

POLL_MILLISECONDS = 50


class PreviewJob:
    """The computation in a thread; `result` or `error` once it is finished.  It is forgotten, not stopped."""

    def __init__(self, target):
        with mesh_errors("options"):
            self.task = mesh_object.collect(target)
            self.task.detach()
        self.result = self.error = None
        self.thread = threading.Thread(target=self.run, name="DelaunayMesher preview", daemon=True)
        self.thread.start()
        remember(self)

    def cancel(self):
        """The size field cannot be stopped; it takes a second or two."""

    def run(self):
        try:
            with mesh_errors("sizing"):
                self.result = computation.preview(self.task.shape, self.task.options, self.task.keep)
        except MeshError as error:
            self.error = error

    @property
    def finished(self):
        return not self.thread.is_alive()


class SizePreview:
    """Follows the preview button of an options box."""

    def __init__(self, target, box):
        self.target, self.box = target, box
        self.job = self.overlay = None
        self.hidden = []
        self.timer = QtCore.QTimer(box)
        self.timer.setInterval(POLL_MILLISECONDS)
        self.timer.timeout.connect(self.poll)
        box.preview_button.toggled.connect(self.toggle)
        box.destroyed.connect(self.clean)

    def toggle(self, on):
        if not on:
            self.forget()
            return
        self.box.store(self.target)
        try:
            self.job = PreviewJob(self.target)
        except MeshError as error:
            self.fail(error)
            return
        self.box.count.setText(tr("Computing the sizes ..."))
        self.timer.start()

    def poll(self):
        job = self.job
        if job is None or not job.finished:
            return
        self.timer.stop()
        self.job = None
        try:
            if job.error:
                raise job.error
            with mesh_errors("view"):
                self.show(job.result)
        except MeshError as error:
            self.fail(error)

    def fail(self, error):
        self.box.preview_button.setChecked(False)
        self.box.count.setText(explain(error))

    def show(self, preview):
        """The sizes as colours, on a logarithmic scale, instead of part and mesh."""
        low, high = preview.sizes.min(), preview.sizes.max()
        shares = np.log(preview.sizes / low) / max(np.log(high / low), 1e-9)
        if high < 1.01 * low:
            shares[:] = 1.0
        self.overlay = Overlay(self.target.Document)
        faces = preview.triangles
        self.overlay.show_surface(
            preview.points, faces, shares[faces].mean(axis=1), size_scale(), with_edges=False
        )
        for item in (self.target, self.target.Shape):
            if item is not None and item.ViewObject.Visibility:
                self.hidden.append(item)
                item.ViewObject.hide()
        self.box.count.setText(tr("About %s tetrahedra") % number(two_digits(preview.count)))
        self.box.legend.show_range(as_length(low), as_length(high))

    def end(self):
        """Leave the preview, if it is on."""
        self.box.preview_button.setChecked(False)

    def forget(self):
        """The preview is no longer wanted: the view is as before."""
        self.timer.stop()
        self.job = None
        self.box.legend.hide()
        self.clean()

    def clean(self, *_):
        """Take the picture away; also called when the panel is gone."""
        hidden, self.hidden = self.hidden, []
        overlay, self.overlay = self.overlay, None
        try:
            if overlay:
                overlay.remove()
            for item in hidden:
                item.ViewObject.show()
        except (ReferenceError, RuntimeError):
            pass  # the document is gone as well


def as_length(size):
    """A size in the user's units."""
    return FreeCAD.Units.Quantity(float("%.3g" % size), FreeCAD.Units.Length).UserString
