import ast
import pickle
import re
from pathlib import Path

from DelaunayMesher.errors import InputError, MeshCancelled, MeshError, entity_name, in_number

ROOT = Path(__file__).parent.parent


def test_names():
    assert entity_name(2, 11) == "Face12"
    assert entity_name(1, 0) == "Edge1"
    assert entity_name(3, 2) == "Solid2"
    assert entity_name(-1, -1) is None
    assert entity_name(2, -1) is None


def test_counts_are_singular_or_plural():
    for text, expected in (
        ("in 1 place(s) it is so", "in 1 place it is so"),
        ("in 21 place(s)", "in 21 places"),
        ("1 open edge(s), 0 boundary triangle(s)", "1 open edge, 0 boundary triangles"),
        ("1 solid(s) of its 12 face(s)", "1 solid of its 12 faces"),
        ("Face1 and 2 mm in 1 place(s)", "Face1 and 2 mm in 1 place"),
        ("Part(s) 1", "Part(s) 1"),
    ):
        assert in_number(text) == expected


def test_one_line_says_it_all():
    error = MeshError("boundary", "self_intersection", "two faces cross", (10.2, 4, 0), "Face12", "Face40")
    assert str(error) == "boundary: two faces cross [Face12, Face40] near (10.2, 4, 0) (self_intersection)"
    assert str(MeshError("plc", "empty", "nothing")) == "plc: nothing (empty)"
    named = MeshError("plc", "open", "a gap beside Face1 near (1, 2, 3)", (1, 2, 3), "Face1")
    assert str(named) == "plc: a gap beside Face1 near (1, 2, 3) (open)"


def test_statuses():
    assert (MeshError.status, MeshError.exit_code) == ("failed", 1)
    assert (InputError.status, InputError.exit_code) == ("failed", 2)
    assert (MeshCancelled.status, MeshCancelled.exit_code) == ("cancelled", 130)
    assert issubclass(MeshCancelled, MeshError)


def test_errors_travel_between_processes():
    error = pickle.loads(pickle.dumps(InputError("read", "bad_facet", "text", (1, 2, 3), "Face1")))
    assert type(error) is InputError
    assert error.as_dict()["place"] == (1.0, 2.0, 3.0)


def stages_raised():
    """Where errors come from: the first arguments in the Python and the C++ sources."""
    calls = ("MeshError", "InputError", "mesh_errors", "patience", "_stage")
    found = set()
    for path in ROOT.glob("DelaunayMesher/**/*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in calls:
                found |= {word.value for word in node.args[:1] if isinstance(word, ast.Constant)}
    for path in [*ROOT.glob("DelaunayMesher/core/**/*.cpp"), *ROOT.glob("DelaunayMesher/core/**/*.h")]:
        found |= set(re.findall(r'(?:Failure|begin|stop)\(\s*"(\w+)"', path.read_text(encoding="utf-8")))
    return found


def test_every_stage_has_a_name_in_the_window_and_is_documented():
    tree = ast.parse((ROOT / "DelaunayMesher" / "gui" / "explain.py").read_text(encoding="utf-8"))
    table = next(node.value for node in tree.body if isinstance(node, ast.Assign))
    named = set(ast.literal_eval(table))
    raised = stages_raised()
    assert {"options", "read", "plc", "boundary", "write", "solve"} <= raised
    assert raised - named == set()
    section = (ROOT / "docs" / "errors.md").read_text().split("## Stages")[1].split("##")[0]
    assert named == set(re.findall(r"`(\w+)`", section))


def test_every_reason_code_is_documented():
    text = (ROOT / "docs" / "errors.md").read_text()
    documented = set(re.findall(r"^\| `(\w+)`", text, re.MULTILINE))
    used = set()
    for path in [*ROOT.glob("DelaunayMesher/*.py"), *ROOT.glob("DelaunayMesher/document/*.py")]:
        source = path.read_text()
        used |= set(re.findall(r'(?:MeshError|InputError)\(\s*"\w+",\s*"(\w+)"', source))
        used |= set(
            re.findall(r'(?:refusal|unreadable|_unwritable)\([^()]*(?:\([^()]*\)[^()]*)*,\s*"(\w+)"', source)
        )
    for path in ROOT.glob("DelaunayMesher/core/**/*.cpp"):
        used |= set(re.findall(r'Failure\(\s*(?:"\w+"|\w+),\s*"(\w+)"', path.read_text()))
        if path.parent.name in ("plc", "sizing"):  # where the user's input is checked
            used |= set(re.findall(r'fail\(\s*"(\w+)"', path.read_text()))
    assert used - documented == set()
