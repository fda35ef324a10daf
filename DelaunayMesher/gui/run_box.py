"""The lower part of the mesh panel: button, progress, log, and what came out."""

from PySide import QtCore, QtGui

from ..errors import MeshCancelled
from .explain import explain, stage_name, with_labels
from .texts import qt_icon, tr

LOG_LINES = 500
BAD, WARN, GOOD = "#c0392b", "#b9770e", "#1e8449"


def number(value):
    """12 345 instead of 12345."""
    return "{:,d}".format(int(value)).replace(",", "\u202f")


class RunBox(QtGui.QWidget):
    """Shows a run; knows nothing about how it is done."""

    def __init__(self):
        super().__init__()
        self.setWindowTitle(tr("Run"))
        self.setWindowIcon(qt_icon("delaunay_mesher"))
        self.stage = None
        self.button = QtGui.QPushButton()
        self.button.setObjectName("MeshButton")
        self.button.setMinimumHeight(30)
        self.solve_button = QtGui.QPushButton(qt_icon("solve"), tr("Solve"))
        self.solve_button.setObjectName("SolveButton")
        self.solve_button.setMinimumHeight(30)
        self.solve_button.setToolTip(
            tr(
                "Solve the analysis with CalculiX and show the stresses; meshes first if there is no mesh of "
                "the part and options as they are now"
            )
        )
        self.bar = QtGui.QProgressBar()
        self.bar.setRange(0, 1000)
        self.status = QtGui.QLabel(tr("Ready"))
        self.time = QtGui.QLabel()
        self.log = QtGui.QPlainTextEdit()
        self.log.setReadOnly(True)
        self.log.setMaximumBlockCount(LOG_LINES)
        self.log.setMinimumHeight(60)
        self.log.setMaximumHeight(118)
        self.log.setPlaceholderText(tr("Messages of the mesher"))
        self.result = QtGui.QLabel()
        self.result.setObjectName("Result")
        self.result.setTextFormat(QtCore.Qt.RichText)
        self.result.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.result.setWordWrap(True)
        self.quality_button = QtGui.QPushButton(qt_icon("mesh_quality"), tr("Mesh quality ..."))
        self.results_button = QtGui.QPushButton(qt_icon("solve"), tr("Results ..."))
        self.results_button.setToolTip(tr("Close this panel and open FreeCAD's own for the results"))
        self.results_button.hide()
        self.arrange()
        self.idle()

    def arrange(self):
        outer = QtGui.QVBoxLayout(self)
        outer.setContentsMargins(2, 2, 2, 2)
        outer.setSpacing(5)
        line = QtGui.QHBoxLayout()
        line.addWidget(self.button, 1)
        line.addWidget(self.solve_button, 1)
        outer.addLayout(line)
        outer.addWidget(self.bar)
        line = QtGui.QHBoxLayout()
        line.addWidget(self.status, 1)
        line.addWidget(self.time)
        outer.addLayout(line)
        outer.addWidget(self.result)
        line = QtGui.QHBoxLayout()
        line.addWidget(self.quality_button, 1)
        line.addWidget(self.results_button, 1)
        outer.addLayout(line)
        outer.addWidget(self.log)

    def idle(self):
        self.bar.setRange(0, 1000)
        self.solve_button.setEnabled(True)
        self.button.setEnabled(True)
        self.button.setText(tr("Mesh"))
        self.button.setIcon(qt_icon("mesh_solid"))

    def begin(self):
        """A run starts."""
        self.stage = None
        self.log.clear()
        self.solve_button.setEnabled(False)
        self.bar.setValue(0)
        self.time.setText("")
        self.button.setText(tr("Cancel"))
        self.button.setIcon(self.style().standardIcon(QtGui.QStyle.SP_DialogCancelButton))

    def show_progress(self, job):
        """Stage, percentage and time of a run."""
        if job.fraction is None:
            self.bar.setRange(0, 0)  # busy, nobody knows how long
        else:
            self.bar.setValue(int(1000 * job.fraction))
        self.time.setText(tr("%.1f s") % job.seconds)
        if job.cancelled:
            self.button.setEnabled(False)
            self.status.setText(tr("Cancelling ..."))
        elif job.stage != self.stage:
            self.stage = job.stage
            self.status.setText(stage_name(job.stage))
            self.write("%6.2f s  %s" % (job.seconds, stage_name(job.stage)))

    def fail(self, error):
        """The run ended without a mesh, or without stresses."""
        self.idle()
        self.bar.setValue(0)
        solving = error.stage == "solve"
        if isinstance(error, MeshCancelled):
            self.status.setText(tr("Cancelled") if solving else tr("Cancelled; the old mesh was kept"))
            self.write(tr("Cancelled"), WARN)
            return
        had_mesh = bool(self.result.text())
        failed = tr("Failed; the old mesh was kept") if had_mesh else tr("Failed")
        self.status.setText(tr("Not solved") if solving else failed)
        self.write(explain(error), BAD)

    def take_over(self):
        """FreeCAD is going to copy and draw the mesh: the window stands still meanwhile."""
        self.bar.setValue(self.bar.maximum())
        self.status.setText(tr("FreeCAD takes the mesh over ..."))
        self.status.repaint()

    def succeed(self, job, report):
        """The run ended with a mesh."""
        self.idle()
        self.bar.setValue(self.bar.maximum())
        self.status.setText(tr("Done"))
        self.time.setText(tr("%.1f s") % job.seconds)
        self.log.clear()
        for stage, seconds in report.get("seconds", {}).items():
            if stage != "total":
                self.write("%6.2f s  %s" % (seconds, stage_name(stage)))
        for warning in report.get("warnings", ()):
            self.write(with_labels(warning), WARN)
        self.show_report(report)

    def show_solution(self, job, moved, stress):
        """CalculiX is done; lengths in mm, stress in MPa."""
        self.idle()
        self.bar.setValue(self.bar.maximum())
        self.status.setText(tr("Solved"))
        self.time.setText(tr("%.1f s") % job.seconds)
        self.write(tr("Largest displacement %.4g mm") % moved, GOOD)
        self.write(tr("Largest von Mises stress %.4g MPa (red)") % stress, GOOD)
        self.results_button.show()

    def show_report(self, report):
        """Result of this run or of an earlier one."""
        self.result.setVisible(bool(report))
        self.result.setText("<br>".join(result_lines(report)) if report else "")
        self.quality_button.setVisible(bool(report))

    def write(self, text, colour=None):
        """A line of the log."""
        if colour is None:
            self.log.appendPlainText(text)
            return
        safe = text.replace("&", "&amp;").replace("<", "&lt;")
        self.log.appendHtml('<span style="color:%s; white-space:pre-wrap">%s</span>' % (colour, safe))


def result_lines(report):
    """The figures of a mesh as rich text."""
    quality, below = report["quality"], report["below_target_count"]
    target = report["target_angle"]
    if below:
        verdict = tr("%s elements below %g\u00b0") % (number(below), target)
    else:
        verdict = tr("none below %g\u00b0") % target
    counts = number(report["tetrahedra"]), number(report["points"])
    return [
        tr("<b>%s</b> tetrahedra, <b>%s</b> nodes") % counts,
        tr("Dihedral angles <b>%.1f\u00b0</b> to <b>%.1f\u00b0</b>, ")
        % (quality["min_dihedral"], quality["max_dihedral"])
        + '<b style="color:%s">%s</b>' % (WARN if below else GOOD, verdict),
    ]
