"""In FreeCAD's window: a size region round a vertex, its panel, drag and drop, undo, saved and reopened."""

import os
import zipfile

import drive
import FreeCAD
import FreeCADGui
from drive import say, wait

VIEWS = ["VPMeshDelaunay", "VPSizeRegion"]


def make_mesh():
    """A box in a moved part, meshed from the panel."""
    document = FreeCAD.newDocument("Part")
    moved = document.addObject("App::Part", "Moved")
    moved.Placement.Base = FreeCAD.Vector(100, 0, 0)
    box = document.addObject("Part::Box", "Box")
    moved.addObject(box)
    document.recompute()
    drive.view_all()
    drive.select(box)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.3)
    drive.panel().options_box.fields["max_size"].write(2.0)
    run_panel()
    target = drive.panel().target
    assert drive.panel().reject()
    wait(0.2)
    box.ViewObject.show()
    return box, target


def run_panel():
    panel = drive.panel()
    drive.run(panel)
    say(panel.target.Summary)


def refine_here(box, target):
    """The command makes a region at the vertex, where the mesh is; the panel changes it."""
    from DelaunayMesher.gui.task_size_region import SizeRegionPanel

    vertex = next(i for i, v in enumerate(box.Shape.Vertexes, 1) if v.Point == FreeCAD.Vector(10, 10, 10))
    drive.select(box, "Vertex%d" % vertex)
    FreeCADGui.runCommand("DelaunayMesher_RefineHere")
    wait(0.3)
    region = target.SizeRegionList[0]
    x = 110 if drive.version() >= (1, 0) else 10
    assert (region.Point - FreeCAD.Vector(x, 10, 10)).Length < 1e-9, region.Point
    assert FreeCADGui.ActiveDocument.getInEdit().Object == region
    panel = SizeRegionPanel.current
    panel.fields["Radius"].setProperty("rawValue", 3.0)
    panel.fields["Size"].setProperty("rawValue", 0.4)
    wait(0.1)
    assert (region.Radius.Value, region.Size.Value) == (3.0, 0.4)
    assert abs(region.ViewObject.Proxy.sphere.radius.getValue() - 3.0) < 1e-6
    target.ViewObject.hide()
    drive.view_all()
    drive.picture("region")
    panel.kind.setCurrentIndex(1)
    assert region.Kind == "Box" and not panel.fields["Radius"].isVisible()
    assert panel.fields["SecondPoint.x"].isVisible()
    panel.kind.setCurrentIndex(0)
    assert panel.accept()
    wait(0.2)
    return region


def cancel_takes_back(region):
    """Double click opens the panel; Cancel restores what was there."""
    from DelaunayMesher.gui.task_size_region import SizeRegionPanel

    assert region.ViewObject.Proxy.doubleClicked(region.ViewObject)
    wait(0.2)
    panel = SizeRegionPanel.current
    assert panel.target == region
    panel.fields["Point.y"].setProperty("rawValue", 77.0)
    assert region.Point.y == 77.0
    assert panel.reject()
    wait(0.2)
    assert region.Point.y == 10.0 and not FreeCADGui.Control.activeDialog()


def drag_and_drop(target, region):
    """It is a child of the mesh object, can be dragged out and dropped again."""
    view = target.ViewObject
    assert region in view.Proxy.claimChildren() and view.Proxy.canDragObject(region)
    view.Proxy.dragObject(view, region)
    assert target.SizeRegionList == []
    assert view.Proxy.canDropObject(region)
    view.Proxy.dropObject(view, region)
    assert target.SizeRegionList == [region]


def finer(target):
    before = target.FemMesh.VolumeCount
    assert target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.2)
    run_panel()
    say("tetrahedra before and after:", before, target.FemMesh.VolumeCount)
    assert target.FemMesh.VolumeCount > 3 * before
    drive.view_all()
    drive.picture("finer")
    assert drive.panel().reject()
    wait(0.2)


def reopen(document, names):
    """Saved and opened again, the region is there and is drawn; undo has worked before."""
    path = os.path.join(drive.OUTPUT, "region.FCStd")
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    document = FreeCAD.openDocument(path)
    wait(0.2)
    target, region = (document.getObject(name) for name in names)
    assert target.SizeRegionList == [region]
    assert type(region.ViewObject.Proxy).__name__ == "VPSizeRegion"
    assert abs(region.ViewObject.Proxy.sphere.radius.getValue() - 3.0) < 1e-6
    FreeCAD.closeDocument(document.Name)
    return path


def open_without_views(path, names):
    """A document that FreeCADCmd has saved, or the command line, gets the views and the panel."""
    bare = os.path.join(drive.OUTPUT, "bare.FCStd")
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(bare, "w") as new:
        for name in old.namelist():
            if name != "GuiDocument.xml":
                new.writestr(name, old.read(name))
    document = FreeCAD.openDocument(bare)
    wait(0.2)
    target, region = (document.getObject(name) for name in names)
    assert [type(item.ViewObject.Proxy).__name__ for item in (target, region)] == VIEWS
    assert target.ViewObject.Visibility and region.ViewObject.Visibility
    drive.view_all()
    drive.picture("without_views")
    drive.select(target)
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.2)
    assert FreeCADGui.ActiveDocument.getInEdit().Object == target and drive.panel().target == target
    assert drive.panel().reject()
    wait(0.2)
    cancel_takes_back(region)


def main():
    drive.activate()
    box, target = make_mesh()
    region = refine_here(box, target)
    cancel_takes_back(region)
    drag_and_drop(target, region)
    finer(target)
    names = target.Name, region.Name
    open_without_views(reopen(target.Document, names), names)


drive.start(main, "REGION")
