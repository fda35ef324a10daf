"""Reading CAD files, and which objects of a document count."""

import FreeCAD
import Part
import pytest
from parts import BRACKET

from DelaunayMesher.document import read_shape
from DelaunayMesher.errors import InputError


@pytest.fixture
def document():
    document = FreeCAD.newDocument("parts")
    yield document
    FreeCAD.closeDocument(document.Name)


def saved(document, folder):
    document.recompute()
    path = str(folder / "parts.FCStd")
    document.saveCopy(path)
    return path


@pytest.mark.parametrize("ending", ["step", "stp", "iges", "igs", "brep"])
def test_formats(tmp_path, ending):
    path = str(tmp_path / ("box." + ending))
    Part.makeBox(10, 20, 30).exportBrep(path) if ending == "brep" else None
    if ending in ("step", "stp"):
        Part.makeBox(10, 20, 30).exportStep(path)
    elif ending in ("iges", "igs"):
        Part.makeBox(10, 20, 30).exportIges(path)
    assert abs(read_shape(path).BoundBox.DiagonalLength - 1400**0.5) < 1e-6


def test_the_bracket_in_both_formats():
    step, native = read_shape(BRACKET), read_shape(BRACKET.replace(".step", ".FCStd"))
    assert step.Volume == pytest.approx(native.Volume, rel=1e-8)
    assert len(step.Faces) == len(native.Faces)


def test_tools_of_a_cut_do_not_count(document, tmp_path):
    box, hole = document.addObject("Part::Box", "Box"), document.addObject("Part::Cylinder", "Hole")
    hole.Radius = 2
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = box, hole
    path = saved(document, tmp_path)
    assert read_shape(path).Volume == pytest.approx(cut.Shape.Volume)


def test_several_solids_make_a_compound(document, tmp_path):
    document.addObject("Part::Box", "One")
    other = document.addObject("Part::Box", "Two")
    other.Placement.Base.x = 50
    assert len(read_shape(saved(document, tmp_path)).Solids) == 2
    other.Visibility = False
    assert len(read_shape(saved(document, tmp_path)).Solids) == 1


def test_solids_that_only_take_a_place_or_a_number_from_another_use_nothing_up(document, tmp_path):
    one, two, three = (document.addObject("Part::Box", name) for name in ("One", "Two", "Three"))
    two.setExpression("Length", "One.Length")
    two.Placement.Base.x = 50
    setattr(three, "Support" if hasattr(three, "Support") else "AttachmentSupport", [(one, "Face6")])
    three.MapMode = "FlatFace"
    assert len(read_shape(saved(document, tmp_path)).Solids) == 3


@pytest.mark.parametrize("shown", [True, False])
def test_an_array_of_links_counts_once(document, tmp_path, shown):
    box, links = document.addObject("Part::Box", "Box"), document.addObject("App::Link", "Links")
    links.LinkedObject, links.ElementCount, links.ShowElement = box, 3, shown
    box.Visibility = False
    document.recompute()
    places = [FreeCAD.Placement(FreeCAD.Vector(0, 30 * k, 0), FreeCAD.Rotation()) for k in range(3)]
    if shown:
        for element, place in zip(links.ElementList, places):
            element.Placement = place
    else:
        links.PlacementList = places
    shape = read_shape(saved(document, tmp_path))
    assert len(shape.Solids) == 3 and shape.BoundBox.YMax == pytest.approx(70)


def test_what_a_hidden_container_holds_is_hidden(document, tmp_path):
    part, box = document.addObject("App::Part", "Part"), document.addObject("Part::Box", "Inside")
    part.addObject(box)
    part.Visibility = False
    outside = document.addObject("Part::Box", "Outside")
    outside.Placement.Base.x = 50
    assert read_shape(saved(document, tmp_path)).BoundBox.XMin == pytest.approx(50)


def test_a_body_counts_once(document, tmp_path):
    body = document.addObject("PartDesign::Body", "Body")
    box = body.newObject("PartDesign::AdditiveBox", "Box")
    box.Length = box.Width = box.Height = 10
    assert read_shape(saved(document, tmp_path)).Volume == pytest.approx(1000)


def test_an_outer_placement_moves_the_shape(document, tmp_path):
    part = document.addObject("App::Part", "Part")
    part.Placement.Base.x = 100
    part.addObject(document.addObject("Part::Box", "Box"))
    assert read_shape(saved(document, tmp_path)).BoundBox.XMin == pytest.approx(100)


def test_an_open_document_stays_open(document, tmp_path):
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    document.saveAs(str(tmp_path / "open.FCStd"))
    assert read_shape(document.FileName).Volume == pytest.approx(1000)
    assert document.getObject("Box") == box


def test_the_active_document_stays_active(document, tmp_path):
    FreeCAD.setActiveDocument(document.Name)
    read_shape(BRACKET.replace(".step", ".FCStd"))
    assert FreeCAD.ActiveDocument == document
    (tmp_path / "broken.FCStd").write_text("nothing of the kind")
    with pytest.raises(InputError):
        read_shape(tmp_path / "broken.FCStd")
    assert FreeCAD.ActiveDocument == document


def test_what_cannot_be_read(tmp_path):
    with pytest.raises(InputError, match="no file"):
        read_shape(tmp_path / "none.step")
    with pytest.raises(InputError, match="no CAD file"):
        read_shape(tmp_path / "part.txt")
    for name in ("broken.step", "broken.brep", "broken.FCStd", "broken.iges"):
        (tmp_path / name).write_text("nothing of the kind")
        with pytest.raises(InputError) as caught:
            read_shape(tmp_path / name)
        assert "{" not in str(caught.value)  # words, not what FreeCAD packs them in


def test_a_document_without_a_solid(document, tmp_path):
    document.addObject("Part::Plane", "Plane")
    with pytest.raises(InputError, match="no object with a solid"):
        read_shape(saved(document, tmp_path))
