"""The panel of a mesh object: its options above, running the mesher and CalculiX below.

Changes go into the document when the mesher starts or the panel closes.  Closing while the mesher runs stops
it first.  The old mesh stays until a new one is complete.
"""

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

from ..document import estimate, mesh_object
from ..document.calculix import extremes
from ..document.placement import own_shape
from ..document.properties import get_option, set_option
from ..errors import MeshError
from ..options import OPTIONS
from .guards import mesh_errors, undo_step
from .legend import Legend
from .mesh_job import MeshJob
from .option_fields import make_field
from .run_box import RunBox, number
from .size_preview import SizePreview
from .solve_job import SolveJob
from .texts import qt_icon, tr

POLL_MILLISECONDS = 50
FRAME_WIDTH = 70  # pixels of FreeCAD's frames and scroll bar beside our boxes


class MeshPanel:
    """What FreeCAD's task dialog wants: form, getStandardButtons, reject."""

    current = None  # the one that was opened last

    def __init__(self, target):
        MeshPanel.current = self
        self.target = target
        self.job = self.shown = None
        self.then_solve = False
        self.options_box = OptionsBox(target)
        self.run_box = RunBox()
        self.preview = SizePreview(target, self.options_box)
        self.form = [self.options_box, self.run_box]
        self.run_box.button.clicked.connect(self.start_or_cancel)
        self.run_box.solve_button.clicked.connect(self.mesh_and_solve)
        self.run_box.solve_button.setVisible(mesh_object.analysis_of(target) is not None)
        self.run_box.quality_button.clicked.connect(self.show_quality)
        self.run_box.results_button.clicked.connect(self.show_results)
        self.run_box.show_report(mesh_object.stored_report(target))
        self.timer = QtCore.QTimer(self.run_box)  # ends with the panel, however that is closed
        self.timer.setInterval(POLL_MILLISECONDS)
        self.timer.timeout.connect(self.poll)
        self.run_box.destroyed.connect(self.cancel)
        QtCore.QTimer.singleShot(0, lambda: widen_dock(self.options_box))

    def getStandardButtons(self):
        close = QtGui.QDialogButtonBox.Close
        return int(close) if FreeCAD.Version()[0] == "0" else close

    @property
    def running(self):
        return self.job is not None

    def start_or_cancel(self):
        if self.running:
            self.cancel()
        else:
            self.start()

    def start(self):
        """Write the options down and run the mesher on them."""
        self.run(MeshJob)

    def mesh_and_solve(self):
        """Solve the analysis; a mesh that is missing, or not of the part and options as they are now, is made
        first.
        """
        self.run(self.mesh_or_solve)

    def mesh_or_solve(self, target):
        """The first job of mesh_and_solve()."""
        self.then_solve = not mesh_object.is_current(target)
        return MeshJob(target) if self.then_solve else SolveJob(target)

    def run(self, make_job):
        """Start the job that make_job(mesh object) returns."""
        self.preview.end()
        self.options_box.store(self.target)
        self.run_box.begin()
        try:
            with mesh_errors("options"):
                self.job = make_job(self.target)
        except MeshError as error:
            self.then_solve = False
            self.run_box.fail(error)
            return
        self.options_box.setEnabled(False)
        self.job.start()
        self.timer.start()

    def cancel(self, *_):
        """Ask the run to stop; poll() notices when it has."""
        if self.job:
            self.job.cancel()

    def poll(self):
        """Show how far the run is; deal with its end."""
        job = self.job
        self.run_box.show_progress(job)
        if not job.finished:
            return
        self.timer.stop()
        self.job = None
        target = job.target()
        if target is None:
            return
        self.options_box.setEnabled(True)
        then_solve, self.then_solve = self.then_solve, False
        try:
            if job.error:
                raise job.error
            self.take(job, target)
        except MeshError as error:
            self.run_box.fail(error)
            return
        if then_solve:
            self.run(SolveJob)

    def take(self, job, target):
        """Put what a job made into the document and tell about it."""
        if isinstance(job, SolveJob):
            result = job.store(target)
            self.shown = job.shown
            self.run_box.show_solution(job, *extremes(result))
        else:
            self.run_box.take_over()
            job.store(target)
            self.run_box.succeed(job, mesh_object.stored_report(target))

    def follow(self, name):
        """A property of the mesh object has changed, by undo for instance."""
        if name == "Report" and not self.running:
            self.run_box.show_report(mesh_object.stored_report(self.target))
        self.options_box.follow(self.target, name)

    def show_quality(self):
        """Close this panel and open the one about quality, after the button has dealt with the click."""
        QtCore.QTimer.singleShot(0, self.change_to_quality)

    def change_to_quality(self):
        from . import task_quality

        target = self.target
        if self.reject():
            task_quality.open_panel(target)

    def show_results(self):
        """Close this panel and open FreeCAD's own for the result."""
        QtCore.QTimer.singleShot(0, self.change_to_results)

    def change_to_results(self):
        shown = self.shown
        if self.reject():
            FreeCADGui.getDocument(shown.Document.Name).setEdit(shown.Name)

    def reject(self):
        """Close button and Esc: stop the run first, close the second time."""
        if self.running:
            self.cancel()
            return False
        self.options_box.store(self.target)
        FreeCADGui.getDocument(self.target.Document.Name).resetEdit()
        return True


class OptionsBox(QtGui.QWidget):
    """All options of the mesh object; the rarely used ones are folded away."""

    def __init__(self, target):
        super().__init__()
        self.setWindowTitle(tr("Mesh of %s") % target.Shape.Label if target.Shape else target.Label)
        self.setWindowIcon(qt_icon("mesh_solid"))
        self.shape = own_shape(target.Shape) if target.Shape else None
        self.fields = {option.name: make_field(option) for option in OPTIONS}
        self.count = QtGui.QLabel()
        self.count.setWordWrap(True)
        self.count.setObjectName("Estimate")
        self.preview_button = QtGui.QPushButton(tr("Preview sizes"))
        self.preview_button.setCheckable(True)
        self.preview_button.setToolTip(
            tr("Show on the part how large the elements will be, and estimate their number")
        )
        self.legend = Legend()
        self.label_width = max(field.label.sizeHint().width() for field in self.fields.values())
        outer = QtGui.QVBoxLayout(self)
        outer.setContentsMargins(2, 2, 2, 2)
        outer.setSpacing(4)
        for option_group in ("Size", "Elements"):
            outer.addWidget(self.group(option_group))
        self.more = QtGui.QToolButton()
        self.more.setText(tr("More options"))
        self.more.setCheckable(True)
        self.more.setAutoRaise(True)
        self.more.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
        self.advanced = self.group("Run")
        self.more.toggled.connect(self.fold)
        outer.addWidget(self.more)
        outer.addWidget(self.advanced)
        self.fold(False)
        for field in self.fields.values():
            field.set(get_option(target, field.option))
            field.bind(target)
            field.listeners.append(self.on_change)
        self.on_change()

    def group(self, name):
        """Box with the options of one group of the table."""
        box = QtGui.QGroupBox(tr(name))
        grid = QtGui.QGridLayout(box)
        grid.setColumnStretch(1, 1)
        grid.setColumnMinimumWidth(0, self.label_width)
        grid.setVerticalSpacing(4)
        grid.setContentsMargins(6, 4, 6, 6)
        fields = [field for field in self.fields.values() if field.option.group == name]
        for row, field in enumerate(fields):
            field.add_to(grid, row)
        if name == "Size":
            below = len(fields)
            line = QtGui.QHBoxLayout()
            line.addWidget(self.count, 1)
            line.addWidget(self.preview_button)
            grid.addLayout(line, below, 0, 1, 3)
            grid.addWidget(self.legend, below + 1, 0, 1, 3)
        return box

    def fold(self, open_):
        self.advanced.setVisible(open_)
        self.more.setArrowType(QtCore.Qt.DownArrow if open_ else QtCore.Qt.RightArrow)

    def on_change(self):
        """Automatic values and the estimate follow the fields; a shown preview is no longer true."""
        self.preview_button.setChecked(False)
        if self.shape is None or self.shape.isNull():
            return
        largest = self.fields["max_size"].value() or estimate.automatic_size(self.shape)
        if largest <= 0:
            return
        self.fields["max_size"].show_automatic(largest)
        self.fields["min_size"].show_automatic(largest / estimate.MIN_FRACTION)
        if not self.shape.Solids:
            self.count.setText("")
            return
        count = estimate.two_digits(estimate.uniform_count(self.shape, largest))
        self.count.setText(tr("At least %s tetrahedra, more round curves and walls") % number(count))

    def follow(self, target, name):
        """Show the option that this property of the mesh object holds; expressions show themselves."""
        for field in self.fields.values():
            if field.option.property_name == name and is_changed(field, target):
                field.set(get_option(target, field.option))

    def store(self, target):
        """Write changed values into the mesh object, as one step that can be undone."""
        changed = [field for field in self.fields.values() if is_changed(field, target)]
        if not changed:
            return
        with undo_step(target.Document, "Mesh options"):
            for field in changed:
                set_option(target, field.option, field.value())


def is_changed(field, target):
    """Whether a field is to be written down; an expression of the document stays in charge."""
    if field.is_bound_to_expression(target):
        return False
    return differs(field.value(), get_option(target, field.option))


def differs(shown, stored):
    """Whether a field was changed; the rounding of the display does not count."""
    if isinstance(shown, float) and isinstance(stored, float):
        return abs(shown - stored) > 1e-9 * max(abs(shown), abs(stored))
    return shown != stored


def widen_dock(box):
    """Make FreeCAD's side panel wide enough for a box that has just been shown there.

    Not by box.parentWidget(): PySide takes our widgets for deleted once such a chain of parents is gone.
    """
    window = FreeCADGui.getMainWindow()
    wanted = box.minimumSizeHint().width() + FRAME_WIDTH
    for dock in window.findChildren(QtGui.QDockWidget):
        if dock.isAncestorOf(box) and not dock.isFloating() and dock.width() < wanted:
            window.resizeDocks([dock], [wanted], QtCore.Qt.Horizontal)
