"""These tests need FreeCAD; without it none of them is collected, and pytest's header says so."""

from DelaunayMesher.document.find_freecad import find_freecad
from DelaunayMesher.errors import MeshError

try:
    find_freecad()
    collect_ignore_glob = []
except MeshError as error:
    MISSING = str(error)
    collect_ignore_glob = ["test_*.py"]

    def pytest_report_header():
        return "tests/document is left out: " + MISSING
