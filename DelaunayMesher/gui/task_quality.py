"""The quality panel: distribution of a measure, the worst elements, a cut through the mesh.

Works on any FEM mesh of tetrahedra.  What our own report says about an element (why it is below the target,
on which CAD element it lies) is shown with it.
"""

import os

import FreeCAD
import FreeCADGui
import numpy as np
from PySide import QtCore, QtGui

from ..document.from_femmesh import FaceTable, cad_face_of, cad_faces, tetrahedra
from ..errors import MeshError
from ..report import write_report
from .commands import is_our_mesh
from .explain import explain
from .guards import patience
from .histogram import Histogram
from .measures import MEASURES
from .mesh_watch import MeshWatch
from .overlay import Overlay
from .run_box import number
from .start_mesh import show_error
from .texts import qt_icon, tr

WORST = 100  # rows of the table
ZOOM = 12.0  # height of the view over the longest edge of the element
REASONS = {
    "input_angle": "acute angle of the part",
    "size_floor": "smallest size reached",
    "fallback": "no better place found",
}
CUTS = (("No cut", None), ("Cut along X", 0), ("Cut along Y", 1), ("Cut along Z", 2))
SLIDER_STEPS = 200


def open_panel(target):
    """Show the panel of a mesh object, unless another panel is open."""
    from .start_mesh import panel_is_open

    if panel_is_open():
        return
    try:
        with patience("quality"):
            panel = QualityPanel(target)
    except MeshError as error:
        show_error(explain(error))
        return
    FreeCADGui.Control.showDialog(panel)


class QualityPanel:
    """What FreeCAD's task dialog wants, and what the widgets do."""

    current = None  # the one that is open

    def __init__(self, target):
        self.target = target
        self.read()
        self.overlay = Overlay(target.Document)
        self.was_visible = target.ViewObject.Visibility
        self.part = getattr(target, "Shape", None)
        self.build()
        self.show_measure()
        self.watch = MeshWatch(target, self.plot_box, self.read_again, self.reject)
        QualityPanel.current = self

    def read(self):
        """What is shown of the mesh."""
        fem_mesh = self.target.FemMesh
        self.mesh = tetrahedra(fem_mesh)
        self.report = report_of(self.target)
        self.reasons = {item["tet"]: item for item in self.report.get("below_target", ())}
        self.faces = cad_faces(fem_mesh)
        self.table_of_faces = None

    def read_again(self):
        """The mesh object has another mesh, after undo for instance."""
        with patience("quality"):
            self.read()
            self.show_measure()

    def build(self):
        self.plot_box, self.worst_box, self.cut_box = PlotBox(), WorstBox(), CutBox()
        self.form = [self.plot_box, self.worst_box, self.cut_box]
        self.plot_box.measure.currentIndexChanged.connect(self.show_measure)
        self.worst_box.table.itemSelectionChanged.connect(self.show_chosen)
        self.cut_box.changed = self.show_cut
        self.plot_box.destroyed.connect(self.clean)
        self.plot_box.export.clicked.connect(self.export)

    def getStandardButtons(self):
        close = QtGui.QDialogButtonBox.Close
        return int(close) if FreeCAD.Version()[0] == "0" else close

    @property
    def measure(self):
        return MEASURES[self.plot_box.measure.currentIndex()]

    def show_measure(self, *_):
        """Another measure was chosen, or there is another mesh."""
        self.values = self.measure.compute(self.mesh.points, self.mesh.tets)
        target = self.report.get("target_angle") if self.measure is MEASURES[0] else None
        self.plot_box.show(self.values, self.measure, target)
        self.rows = self.measure.order(self.values)[:WORST]
        self.worst_box.show(
            [
                (self.mesh.element[row], self.values[row], self.measure.unit, *self.remark(row))
                for row in self.rows
            ]
        )
        self.plot_box.export.setVisible(bool(self.report))
        self.cut_box.set_measure(self.measure, target)
        self.show_cut()

    def remark(self, row):
        """(CAD element or '', reason or '') of an element, from our report or from the groups of the mesh."""
        item = self.reasons.get(int(row))
        if item is not None:
            return item.get("face") or "", tr(REASONS.get(item["reason"], item["reason"]))
        return cad_face_of(self.target.FemMesh, int(self.mesh.element[row]), self.faces) or "", ""

    def show_chosen(self):
        """Zoom to the chosen row's element and select the CAD element it lies on."""
        chosen = self.worst_box.table.selectedItems()
        if not chosen:
            self.overlay.show_chosen(None)
            return
        row = self.rows[chosen[0].row()]
        corners = self.mesh.points[self.mesh.tets[row]]
        self.overlay.show_chosen(corners)
        self.overlay.zoom(corners.mean(axis=0), ZOOM * np.ptp(corners, axis=0).max())
        FreeCADGui.Selection.clearSelection()
        name = self.remark(row)[0]
        if self.part and name and not name.startswith("Solid"):
            FreeCADGui.Selection.addSelection(self.part.Document.Name, self.part.Name, name)

    def show_cut(self):
        """Draw the elements before the cut, or the bad ones only, instead of FreeCAD's mesh."""
        kept = self.kept()
        self.target.ViewObject.Visibility = kept is None
        if kept is None:
            self.overlay.show_surface(self.mesh.points, np.zeros((0, 3), dtype=int), np.zeros(0))
            self.cut_box.count.setText("")
            return
        if self.table_of_faces is None:
            self.table_of_faces = FaceTable(self.mesh.tets)
        faces, owner = self.table_of_faces.surface(kept)
        self.overlay.show_surface(self.mesh.points, faces, self.measure.goodness(self.values[owner]))
        self.cut_box.count.setText(tr("%s elements shown") % number(kept.sum()))

    def kept(self):
        """(t,) bool of the elements to draw; None when FreeCAD's mesh is to be seen as it is."""
        axis, share = self.cut_box.cut()
        threshold = self.cut_box.threshold()
        if not len(self.mesh.tets) or (axis is None and threshold is None):
            return None
        kept = np.ones(len(self.mesh.tets), dtype=bool)
        if axis is not None:
            along = self.mesh.points[self.mesh.tets, axis].mean(axis=1)
            kept &= along <= along.min() + share * (along.max() - along.min())
        if threshold is not None:
            kept &= self.measure.is_worse(self.values, threshold)
        return kept

    def export(self):
        """Save the report of our mesh as JSON."""
        name = os.path.join(os.path.expanduser("~"), "%s.json" % self.target.Label)
        path = QtGui.QFileDialog.getSaveFileName(
            FreeCADGui.getMainWindow(), tr("Save the report"), name, "JSON (*.json)"
        )[0]
        if not path:
            return
        try:
            write_report(path, self.report)
        except OSError as error:
            show_error(tr("The report was not saved: %s") % error)

    def reject(self):
        FreeCADGui.Control.closeDialog()
        return True

    def clean(self, *_):
        """The panel is gone, however it was closed: the view is as it was before, the arrays are let go."""
        QualityPanel.current = None
        self.watch.end()
        try:
            self.overlay.remove()
            self.target.ViewObject.Visibility = self.was_visible
        except (ReferenceError, RuntimeError):
            pass  # the document is gone as well


def report_of(target):
    """The report stored in a mesh object of ours; {} for others."""
    if not is_our_mesh(target):
        return {}
    from ..document.mesh_object import stored_report

    return stored_report(target)


class PlotBox(QtGui.QWidget):
    """Choice of the measure, histogram, figures."""

    def __init__(self):
        super().__init__()
        self.setWindowTitle(tr("Mesh quality"))
        self.setWindowIcon(qt_icon("mesh_quality"))
        self.measure = QtGui.QComboBox()
        self.measure.addItems([tr(measure.name) for measure in MEASURES])
        self.histogram = Histogram()
        self.figures = QtGui.QLabel()
        self.figures.setTextFormat(QtCore.Qt.RichText)
        self.export = QtGui.QPushButton(tr("Export report ..."))
        layout = QtGui.QVBoxLayout(self)
        layout.setContentsMargins(2, 2, 2, 2)
        for widget in (self.measure, self.histogram, self.figures, self.export):
            layout.addWidget(widget)

    def show(self, values, measure, target):
        self.histogram.show_values(values, measure, target)
        if not len(values):
            self.figures.setText(tr("no tetrahedra"))
            return
        worst = values.min() if measure.worst_is_small else values.max()
        low, high = np.percentile(values, (5, 95))
        lines = (
            tr("<b>%s</b> elements, worst <b>%.4g%s</b>") % (number(len(values)), worst, measure.unit),
            tr("mean %.4g%s, the worst 5 %% beyond %.4g%s")
            % (values.mean(), measure.unit, low if measure.worst_is_small else high, measure.unit),
        )
        self.figures.setText("<br>".join(lines))


class WorstBox(QtGui.QWidget):
    """Table of the worst elements."""

    def __init__(self):
        super().__init__()
        self.setWindowTitle(tr("Worst elements"))
        self.setWindowIcon(qt_icon("delaunay_mesher"))
        self.table = QtGui.QTableWidget(0, 4)
        self.table.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
        self.table.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
        self.table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        # Headers of our own: PySide 6 now and then takes those that Qt makes for plain widgets.
        rows = QtGui.QHeaderView(QtCore.Qt.Vertical, self.table)
        columns = QtGui.QHeaderView(QtCore.Qt.Horizontal, self.table)
        self.table.setVerticalHeader(rows)
        self.table.setHorizontalHeader(columns)
        rows.hide()
        rows.setDefaultSectionSize(22)
        columns.setStretchLastSection(True)
        self.table.setHorizontalHeaderLabels([tr("Element"), tr("Value"), tr("On"), tr("Reason")])
        self.table.setMinimumHeight(170)
        self.table.setToolTip(tr("Click a row to see the element"))
        layout = QtGui.QVBoxLayout(self)
        layout.setContentsMargins(2, 2, 2, 2)
        layout.addWidget(self.table)

    def show(self, rows):
        """rows: (element, value, unit, CAD element, reason)."""
        self.table.clearSelection()
        self.table.setRowCount(len(rows))
        for row, (element, value, unit, place, reason) in enumerate(rows):
            texts = ("%d" % element, "%.4g%s" % (value, unit), place or tr("inside"), reason)
            for column, text in enumerate(texts):
                self.table.setItem(row, column, QtGui.QTableWidgetItem(text))
        self.table.resizeColumnsToContents()


class CutBox(QtGui.QWidget):
    """Which elements are drawn: before a cut, below a threshold."""

    def __init__(self):
        super().__init__()
        self.setWindowTitle(tr("Look inside"))
        self.setWindowIcon(qt_icon("mesh_object"))
        self.changed = lambda: None
        self.axis = QtGui.QComboBox()
        self.axis.addItems([tr(text) for text, _ in CUTS])
        self.slider = QtGui.QSlider(QtCore.Qt.Horizontal)
        self.slider.setRange(0, SLIDER_STEPS)
        self.slider.setValue(SLIDER_STEPS // 2)
        self.slider.setEnabled(False)
        self.bad_only = QtGui.QCheckBox(tr("Only below"))
        self.limit = QtGui.QDoubleSpinBox()
        self.count = QtGui.QLabel()
        grid = QtGui.QGridLayout(self)
        grid.setContentsMargins(2, 2, 2, 2)
        grid.addWidget(self.axis, 0, 0)
        grid.addWidget(self.slider, 0, 1)
        grid.addWidget(self.bad_only, 1, 0)
        grid.addWidget(self.limit, 1, 1)
        grid.addWidget(self.count, 2, 0, 1, 2)
        self.axis.currentIndexChanged.connect(self.on_change)
        self.slider.valueChanged.connect(self.on_change)
        self.bad_only.toggled.connect(self.on_change)
        self.limit.valueChanged.connect(self.on_change)

    def on_change(self, *_):
        self.slider.setEnabled(self.axis.currentIndex() > 0)
        self.changed()

    def set_measure(self, measure, target):
        """Fit the threshold to a measure."""
        self.limit.blockSignals(True)
        self.limit.setRange(measure.low, measure.high)
        self.limit.setSuffix(measure.unit)
        self.limit.setSingleStep((measure.high - measure.low) / 40.0)
        middle = measure.low + (0.4 if measure.worst_is_small else 0.6) * (measure.high - measure.low)
        self.limit.setValue(target or middle)
        self.limit.blockSignals(False)
        self.bad_only.setText(tr("Only below") if measure.worst_is_small else tr("Only above"))

    def cut(self):
        """(axis or None, share of the extent along it)."""
        return CUTS[self.axis.currentIndex()][1], self.slider.value() / float(SLIDER_STEPS)

    def threshold(self):
        """The limit, or None when all elements are wanted."""
        return self.limit.value() if self.bad_only.isChecked() else None
