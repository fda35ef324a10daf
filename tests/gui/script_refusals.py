"""In FreeCAD's window: what cannot be meshed is refused in words that say what to do; nothing is lost."""

import drive
import FreeCAD
import FreeCADGui
import Part
from drive import say, wait

COMMAND = "DelaunayMesher_MeshSolid"


def objects_without_a_solid():
    """A message box at once, and no mesh object."""
    document = FreeCAD.newDocument("Parts")
    box = Part.makeBox(10, 10, 10)
    for name, shape, words in (
        ("Line", Part.makeLine((0, 0, 0), (1, 1, 0)), "extrude"),
        ("Face", box.Faces[0], "close it"),
        ("OpenShell", Part.Shell(box.Faces[:5]), "close it"),
        ("ClosedShell", box.Shells[0], "they close"),
        ("Empty", Part.Shape(), "recompute"),
    ):
        part = document.addObject("Part::Feature", name)
        part.Shape = shape
        refused(part, words)
    assert not [item for item in document.Objects if item.isDerivedFrom("Fem::FemMeshObject")]
    assert not document.UndoCount


def refused(item, *words):
    drive.select(item)
    assert FreeCADGui.Command.get(COMMAND).isActive()
    text = drive.message_of(lambda: FreeCADGui.runCommand(COMMAND))
    say(text)
    assert all(word in text for word in (item.Label, *words))
    assert not FreeCADGui.Control.activeDialog()


def broken_solid():
    """A solid with a hole in its surface: the panel names faces and a place."""
    document = FreeCAD.newDocument("Broken")
    part = document.addObject("Part::Feature", "Broken")
    part.Shape = Part.Solid(Part.Shell(Part.makeBox(10, 10, 10).Faces[:5]))
    panel = drive.run(drive.open_panel(part))
    text = panel.run_box.log.toPlainText().splitlines()[-1]
    say(text)
    assert text.startswith("Reading the shape:") and "Face1" in text and "near (" in text
    assert panel.run_box.status.text() == "Failed"
    panel.reject()
    wait(0.2)


def too_many_elements():
    """Refused before anything is made; the old mesh stays."""
    document = FreeCAD.newDocument("Huge")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    panel = drive.open_panel(box)
    panel.options_box.fields["max_size"].write(3.0)
    target = drive.run(panel).target
    count = target.FemMesh.VolumeCount
    panel.options_box.fields["max_size"].write(0.01)
    drive.run(panel)
    text = panel.run_box.log.toPlainText().splitlines()[-1]
    say(text)
    assert "\u201cMax elements\u201d" in text and "--" not in text
    assert target.FemMesh.VolumeCount == count > 0
    assert "kept" in panel.run_box.status.text()
    panel.reject()
    wait(0.2)


def thin_wall():
    """The warning says which field of the panel lifts the limit."""
    document = FreeCAD.newDocument("Foil")
    box = document.addObject("Part::Box", "Foil")
    box.Height = 0.05
    document.recompute()
    panel = drive.open_panel(box)
    panel.options_box.fields["max_size"].write(10.0)
    drive.run(panel)
    text = panel.run_box.log.toPlainText().splitlines()[-1]
    say(text)
    assert "so thin" in text and "\u201cMin size\u201d" in text and "--" not in text
    panel.reject()
    wait(0.2)


def refinement_without_a_mesh():
    """The user is told to make the mesh first."""
    document = FreeCAD.newDocument("NoMesh")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    for command in ("RefineFaces", "RefineHere", "Group"):
        drive.select(box, "Face1")
        text = drive.message_of(lambda name=command: FreeCADGui.runCommand("DelaunayMesher_" + name))
        assert "Mesh this solid" in text


def main():
    drive.activate()
    assert not FreeCADGui.Command.get(COMMAND).isActive()
    objects_without_a_solid()
    broken_solid()
    too_many_elements()
    thin_wall()
    refinement_without_a_mesh()


drive.start(main, "REFUSALS")
