"""In FreeCAD's window: preview of the sizes, preferences, a part inside a body, an expression."""

import drive
import FreeCAD
import FreeCADGui
import Mesh
from drive import say, wait, wait_until
from PySide import QtGui


def open_bracket():
    """The example part with its panel."""
    part = drive.open_bracket()
    return part, drive.open_panel(part)


def preview(part, panel):
    """The estimate agrees with the run; the view is restored when an option changes."""
    panel.options_box.preview_button.click()
    wait_until(lambda: panel.preview.overlay is not None)
    text = panel.options_box.count.text()
    say(text)
    estimate = int("".join(letter for letter in text if letter.isdigit()))
    assert not part.ViewObject.Visibility
    drive.picture("preview")
    panel.options_box.fields["growth"].write(0.3)
    wait(0.2)
    assert part.ViewObject.Visibility and panel.preview.overlay is None
    drive.run(panel)
    real = panel.target.FemMesh.VolumeCount
    say("estimated", estimate, "made", real)
    assert 0.8 * real < estimate < 1.2 * real
    drive.view_all()
    drive.picture("bracket")


def mesh_of_triangles():
    """An opened STL file has the panel and its preview as a solid has."""
    document = FreeCAD.newDocument("Triangles")
    item = document.addObject("Mesh::Feature", "Cube")
    item.Mesh = Mesh.createBox(10, 10, 10)
    panel = drive.open_panel(item)
    assert panel.target.Shape == item
    panel.options_box.fields["max_size"].write(2.0)
    preview(item, panel)
    assert not item.ViewObject.Visibility and panel.reject()
    wait(0.2)


def expression(panel):
    """A size that follows an expression of the document stays with it."""
    panel.reject()
    wait(0.2)
    target = panel.target
    target.setExpression("MaxSize", "2 mm + 4 mm")
    target.Document.recompute()
    target.ViewObject.Proxy.doubleClicked(target.ViewObject)
    wait(0.3)
    panel = drive.panel()
    assert abs(panel.options_box.fields["max_size"].value() - 6.0) < 1e-9
    panel.options_box.fields["seed"].write(7)
    assert panel.reject()
    wait(0.2)
    assert target.ExpressionEngine and abs(target.MaxSize.Value - 6.0) < 1e-9 and target.Seed == 7


def preferences(part):
    """What is set there is what new meshes start with."""
    from DelaunayMesher.gui import colours
    from DelaunayMesher.gui.preferences import PreferencesPage

    page = PreferencesPage()
    page.loadSettings()
    fields = {field.option.name: field for field in page.fields}
    assert fields["order"].value() == 2
    fields["order"].set(1)
    fields["growth"].set(0.5)
    chosen = QtGui.QColor(10, 20, 30)
    page.colours["ColourBad"].setProperty("color", chosen)
    page.saveSettings()
    scale = colours.quality_scale()
    assert colours.packed(scale[0][1]) == 10 << 24 | 20 << 16 | 30 << 8 | 255 and len(scale) == 2
    assert colours.size_scale() == colours.SIZES
    target = drive.open_panel(part).target
    assert target.ElementOrder == "1st" and abs(target.Growth - 0.5) < 1e-9
    drive.panel().reject()
    wait(0.2)
    page.loadSettings()
    assert fields["order"].value() == 1
    fields["order"].set(2)
    fields["growth"].set(0.35)
    assert page.colours["ColourBad"].property("color") == chosen
    default = QtGui.QColor.fromRgbF(*colours.DEFAULTS["ColourBad"])
    page.colours["ColourBad"].setProperty("color", default)
    page.saveSettings()
    assert colours.quality_scale() == colours.QUALITY


def body_with_box():
    """A PartDesign body is a part like any other."""
    document = FreeCAD.newDocument("Bodies")
    body = document.addObject("PartDesign::Body", "Body")
    box = document.addObject("PartDesign::AdditiveBox", "Block")
    body.addObject(box)
    document.recompute()
    panel = drive.open_panel(body)
    drive.run(panel)
    say("body:", panel.target.Summary)
    assert panel.target.FemMesh.VolumeCount > 1000 and panel.target.Shape == body
    panel.reject()
    wait(0.2)
    drive.select(box, "Face1", "Face2")  # a click in the view selects the feature, not the body
    FreeCADGui.runCommand("DelaunayMesher_RefineFaces")
    wait(0.3)
    refinement = (panel.target.MeshRegionList or panel.target.MeshRefinementList)[0]
    assert refinement.References[0][0] == body, refinement.References
    FreeCADGui.ActiveDocument.resetEdit()
    wait(0.2)


def main():
    drive.activate()
    mesh_of_triangles()
    part, panel = open_bracket()
    preview(part, panel)
    expression(panel)
    preferences(part)
    body_with_box()


drive.start(main, "PREVIEW")
