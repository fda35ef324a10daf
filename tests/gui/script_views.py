"""In FreeCAD's window: another view than the 3D view is active, or there is none."""

import drive
import FreeCAD
import FreeCADGui
from drive import say, wait, wait_until
from PySide import QtGui


def make_mesh():
    """A meshed box, and a spreadsheet whose view is open too."""
    document = FreeCAD.newDocument("Views")
    box = document.addObject("Part::Box", "Box")
    sheet = document.addObject("Spreadsheet::Sheet", "Sheet")
    document.recompute()
    panel = drive.open_panel(box)
    panel.options_box.fields["max_size"].write(3.0)
    target = drive.run(panel).target
    assert panel.reject()
    wait(0.2)
    scene = FreeCADGui.ActiveDocument.ActiveView.getSceneGraph()
    assert sheet.ViewObject.doubleClicked()
    wait(0.3)
    return target, scene


def views():
    """(area of all views, the spreadsheet's, the others)."""
    area = FreeCADGui.getMainWindow().findChild(QtGui.QMdiArea)
    sheets = [view for view in area.subWindowList() if "Sheet" in view.windowTitle()]
    return area, sheets[0], [view for view in area.subWindowList() if view not in sheets]


def to_spreadsheet():
    """The spreadsheet is what one looks at; FreeCAD itself shows the 3D view when a panel opens."""
    area, sheet, _ = views()
    area.setActiveSubWindow(sheet)
    wait(0.2)
    assert not hasattr(FreeCADGui.ActiveDocument.ActiveView, "getSceneGraph")


def close_3d_views():
    for view in views()[2]:
        view.close()
    wait(0.2)
    assert not FreeCADGui.ActiveDocument.mdiViewsOfType("Gui::View3DInventor")


def quality_is_drawn(target, scene):
    """Into the 3D view, although the spreadsheet is in front of it."""
    from DelaunayMesher.gui.task_quality import QualityPanel

    to_spreadsheet()
    children = scene.getNumChildren()
    drive.select(target)
    FreeCADGui.runCommand("DelaunayMesher_Quality")
    wait(0.2)
    assert QualityPanel.current.target == target and scene.getNumChildren() == children + 1
    QualityPanel.current.reject()
    wait(0.2)
    assert scene.getNumChildren() == children


def preview_is_drawn(target, scene):
    """Likewise."""
    assert target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    to_spreadsheet()
    children = scene.getNumChildren()
    assert "About" in preview()
    assert scene.getNumChildren() == children + 1
    drive.panel().preview.end()
    assert scene.getNumChildren() == children


def preview():
    """What the panel says after a preview."""
    panel = drive.panel()
    panel.options_box.preview_button.click()
    wait_until(lambda: panel.preview.job is None)
    say(panel.options_box.count.text())
    return panel.options_box.count.text()


def no_3d_view(target):
    """The preview and the quality command say that there is none."""
    close_3d_views()
    assert "3D view" in preview() and not drive.panel().options_box.preview_button.isChecked()
    drive.panel().reject()
    wait(0.2)
    close_3d_views()
    drive.select(target)
    text = drive.message_of(lambda: FreeCADGui.runCommand("DelaunayMesher_Quality"))
    say(text)
    assert "3D view" in text and not FreeCADGui.Control.activeDialog()


def main():
    drive.activate()
    target, scene = make_mesh()
    quality_is_drawn(target, scene)
    preview_is_drawn(target, scene)
    no_3d_view(target)


drive.start(main, "VIEWS")
