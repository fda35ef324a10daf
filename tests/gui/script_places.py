"""In FreeCAD's window: parts inside parts, links, bodies and compounds are meshed where FreeCAD looks for
their faces.
"""

import drive
import FreeCAD
import FreeCADGui
from drive import say, wait
from PySide import QtGui

from DelaunayMesher.document import add_mesh, run
from DelaunayMesher.document.references import refinement_objects

TURNED = FreeCAD.Placement(FreeCAD.Vector(100, 0, 0), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 90))


def make_assembly():
    """A box in a turned part, links to both, one of them in a moved part, a body and a compound there too."""
    document = FreeCAD.newDocument("Assembly")
    turned = document.addObject("App::Part", "Turned")
    turned.Placement = TURNED
    box = document.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 10, 20, 30
    box.Placement.Base = FreeCAD.Vector(0, 20, 0)
    turned.addObject(box)
    link = document.addObject("App::Link", "Link")
    link.setLink(box)
    link.Placement.Base = FreeCAD.Vector(0, 0, 300)
    link_to_part = document.addObject("App::Link", "LinkToPart")
    link_to_part.setLink(turned)
    link_to_part.Placement.Base = FreeCAD.Vector(0, 0, 700)
    moved = document.addObject("App::Part", "Moved")
    moved.Placement.Base = FreeCAD.Vector(0, 500, 0)
    inner = document.addObject("App::Link", "Inner")
    inner.setLink(box)
    inner.Placement.Base = FreeCAD.Vector(0, 0, 90)
    body = document.addObject("PartDesign::Body", "Body")
    body.addObject(document.addObject("PartDesign::AdditiveBox", "Block"))
    body.Placement.Base = FreeCAD.Vector(7, 0, 0)
    source = document.addObject("Part::Box", "Source")
    compound = document.addObject("Part::Compound", "Compound")
    compound.Links = [source]
    compound.Placement.Base = FreeCAD.Vector(0, 0, -50)
    for item in (inner, body, compound):
        moved.addObject(item)
    document.recompute()
    drive.view_all()
    return document


def mesh(document, chosen, element):
    """Select as a click in tree or view does, mesh from the panel; returns the mesh object."""
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(document.Name, chosen, element)
    wait(0.1)
    assert FreeCADGui.Command.get("DelaunayMesher_MeshSolid").isActive()
    FreeCADGui.runCommand("DelaunayMesher_MeshSolid")
    wait(0.2)
    panel = drive.panel()
    panel.options_box.fields["max_size"].write(5.0)
    drive.run(panel)
    assert panel.target.FemMesh.VolumeCount > 20, panel.run_box.log.toPlainText()
    assert panel.reject()
    wait(0.1)
    return panel.target


def corners(box):
    """Bounding box as numbers."""
    low, high = (box.XMin, box.YMin, box.ZMin), (box.XMax, box.YMax, box.ZMax)
    return [round(number, 6) + 0.0 for number in low + high]


def expected(own, everywhere):
    """FreeCAD 1.0 and later look at the place in the document, earlier ones at the object's own."""
    return everywhere if drive.version() >= (1, 0) else own


# A container's shape is that of its visible parts: it comes before the box, which a run hides.
CASES = (  # selected object, element below it, meshed object, own and global bounding box
    ("Turned", "", "Turned", [0, 20, 0, 10, 40, 30], [60, 0, 0, 80, 10, 30]),
    ("Link", "Face2", "Link", [0, 0, 300, 10, 20, 330], [0, 0, 300, 10, 20, 330]),
    ("LinkToPart", "", "LinkToPart", [0, 20, 700, 10, 40, 730], [0, 20, 700, 10, 40, 730]),
    ("Turned", "Box.Face1", "Box", [0, 20, 0, 10, 40, 30], [60, 0, 0, 80, 10, 30]),
    ("Moved", "Inner.Face1", "Inner", [0, 0, 90, 10, 20, 120], [0, 500, 90, 10, 520, 120]),
    ("Moved", "Body.Block.Face1", "Body", [7, 0, 0, 17, 10, 10], [7, 500, 0, 17, 510, 10]),
    ("Moved", "Compound.Face1", "Compound", [0, 0, -50, 10, 10, -40], [0, 500, -50, 10, 510, -40]),
)


def nodes_are_found(document, target):
    """FreeCAD's own search finds the nodes of a face."""
    try:
        from femmesh.meshtools import sub_shape_at_global_placement
    except ImportError:  # before 1.0
        face = (document.Box if target.Shape == document.Turned else target.Shape).Shape.getElement("Face1")
    else:
        if not hasattr(target.Shape, "getGlobalPlacement") or target.Shape.isDerivedFrom("App::Part"):
            return  # a link or a container: FreeCAD itself cannot look there
        face = sub_shape_at_global_placement(target.Shape, "Face1")
    assert len(target.FemMesh.getNodesByFace(face)) >= 8


def an_array_can_be_meshed(document):
    array = document.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount = document.Source, 3
    document.recompute()
    drive.select(array)
    wait(0.1)
    assert FreeCADGui.Command.get("DelaunayMesher_MeshSolid").isActive()
    document.removeObject(array.Name)


def loads_on_links_are_refused(document):
    """FreeCAD 0.20 would end here."""
    count = len(document.Objects)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(document.Name, "Link", "Face2")
    said = drive.message_of(lambda: FreeCADGui.runCommand("DelaunayMesher_Fix"))
    assert "links" in said and len(document.Objects) == count, said


def faces_in_a_meshed_container_can_be_refined(document):
    """A click selects the box, not the container that has the mesh."""
    box = document.addObject("Part::Box", "Part")
    container = document.addObject("App::Part", "Container")
    container.Placement = TURNED
    container.addObject(box)
    document.recompute()
    target = mesh(document, "Container", "")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(document.Name, "Container", "Part.Face1")
    wait(0.1)
    FreeCADGui.runCommand("DelaunayMesher_RefineFaces")
    wait(0.2)
    FreeCADGui.Control.closeDialog()
    before = target.FemMesh.VolumeCount
    (made,) = refinement_objects(target)
    made.CharacteristicLength = 0.5
    run(target)
    assert target.FemMesh.VolumeCount > 2 * before


def one_of_several_meshes_is_refined():
    """The selected one, or else that in the active analysis, or else the first; the report view names it."""
    document = FreeCAD.newDocument("Several")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    first, selected, analysed = (add_mesh(box) for _ in range(3))
    refined(box, None, first)
    drive.add_analysis(document).addObject(analysed)
    refined(box, None, analysed)
    refined(box, selected, selected)


def refined(box, selected, expected):
    """Refinement, size region and group at a vertex of the box are those of the expected mesh."""
    messages = FreeCADGui.getMainWindow().findChild(QtGui.QTextEdit, "Report view")
    for command in ("RefineFaces", "RefineHere", "Group"):
        messages.clear()
        drive.select(box, "Vertex1")
        if selected:
            FreeCADGui.Selection.addSelection(selected)
        FreeCADGui.runCommand("DelaunayMesher_" + command)
        wait(0.1)
        made = FreeCADGui.ActiveDocument.getInEdit().Object
        assert made in expected.ViewObject.Proxy.claimChildren()
        assert "%s belongs to %s, one of 3" % (made.Label, expected.Label) in messages.toPlainText()
        FreeCADGui.ActiveDocument.resetEdit()
        wait(0.1)


def main():
    drive.activate()
    document = make_assembly()
    for chosen, element, meshed, own, everywhere in CASES:
        target = mesh(document, chosen, element)
        found = corners(target.FemMesh.BoundBox)
        say(chosen, element, "->", target.Shape.Name, found)
        assert target.Shape.Name == meshed and found == expected(own, everywhere)
        nodes_are_found(document, target)
    drive.view_all()
    drive.picture("places")
    an_array_can_be_meshed(document)
    loads_on_links_are_refused(document)
    faces_in_a_meshed_container_can_be_refined(document)
    one_of_several_meshes_is_refined()


drive.start(main, "PLACES")
