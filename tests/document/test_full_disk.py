"""What is written when the disk is full: nothing, and the old file stays."""

import json
import resource
import signal
import subprocess
import sys
from pathlib import Path

import FreeCAD
import pytest

from DelaunayMesher.__main__ import main
from DelaunayMesher.document.fcstd import save
from DelaunayMesher.errors import InputError

ROOT = Path(__file__).parent.parent.parent
STL = str(ROOT / "resources" / "examples" / "bracket.stl")


@pytest.mark.parametrize(
    "ending, share", [(".unv", 0.5), (".med", 0.5), (".med", 0.999), (".FCStd", 0.5), (".vtk", 0.5)]
)
def test_an_old_file_stays_when_there_is_no_room_for_the_new(tmp_path, ending, share):
    """Played with a limit for the length of a file, in a process of its own."""
    pytest.importorskip("meshio") if ending == ".vtk" else None
    path, report = tmp_path / ("a" + ending), tmp_path / "a.json"
    command = [STL, "-o", str(path), "--max-size", "8", "--quiet", "--report", str(report)]
    assert main(command) == 0
    limit = int(path.stat().st_size * share)
    path.write_text("an old mesh")
    report.unlink()
    done = subprocess.run(
        [sys.executable, "-m", "DelaunayMesher", *command],
        cwd=ROOT,
        capture_output=True,
        timeout=120,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )
    assert path.read_text() == "an old mesh"
    if ending == ".med" and done.returncode == -signal.SIGABRT:
        return  # the HDF5 of Debian sid (FreeCAD 1.1) aborts the program
    assert done.returncode in (1, 2)  # HDF5 ends the program with 1 when it could not close a .med file
    assert b"Traceback" not in done.stderr
    assert json.loads(report.read_text())["error"]["code"] == "unwritable"
    assert sorted(item.name for item in tmp_path.iterdir()) == sorted([path.name, report.name])


@pytest.mark.parametrize(
    "error, words",
    [
        (OSError("no space left"), "no space left"),
        (RuntimeError("output file not good"), "output file not good"),
        (FreeCAD.Base.FreeCADError({"swhat": "not good"}), "out.FCStd: not good"),
        (None, "could not be completed"),
    ],
)
def test_freecads_own_words_when_it_cannot_save(tmp_path, error, words):
    class Full:
        def saveAs(self, path):
            if error:
                raise error
            Path(path).write_bytes(b"PK, and the rest is missing")

    with pytest.raises(InputError, match=words) as caught:
        save(Full(), str(tmp_path / "out.FCStd"))
    assert (caught.value.stage, caught.value.code) == ("write", "unwritable")
    assert not list(tmp_path.iterdir())
