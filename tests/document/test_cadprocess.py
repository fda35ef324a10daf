"""CAD read by a process of its own."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import Part
import pytest
from FreeCAD import Vector
from parts import BRACKET

from DelaunayMesher import document, pipeline
from DelaunayMesher.cadprocess import CadProcess
from DelaunayMesher.errors import InputError, MeshError
from DelaunayMesher.options import MeshOptions

ROOT = Path(__file__).parent.parent.parent


def test_same_mesh_as_in_this_process():
    options = MeshOptions(max_size=8, optimise=False)
    with CadProcess(BRACKET) as source:
        apart = pipeline.run(source, options)
    here = pipeline.run(BRACKET, options)
    assert apart.points.tobytes() == here.points.tobytes()
    assert apart.tets.tobytes() == here.tets.tobytes()
    assert list(apart.seconds) == list(here.seconds)
    assert apart.shape is None and here.shape is not None


@pytest.mark.parametrize(
    "place, solids", [((10, 10, 0), [[1], [2]]), ((10, 0, 0), [])], ids=["sharing an edge", "sharing a face"]
)
def test_solids_apart(tmp_path, place, solids):
    """Two boxes in one PLC: what shares an edge comes apart, what shares a face does not."""
    path, options = str(tmp_path / "two.brep"), MeshOptions(max_size=4)
    first, second = Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, Vector(*place))
    first.generalFuse([second])[0].exportBrep(path)
    converted = document.convert(document.read_shape(path), options)
    assert len(converted.plcs) == 1
    here = converted.apart(converted.plcs[0])
    with CadProcess(path) as source:
        source.wait()
        os.remove(path)  # it is not read twice
        plcs = source.convert(options)
        assert len(plcs) == 1 and plcs[0].solid_count == 2
        there = source.apart(plcs[0])
        assert list(map(id, source.plcs)) == list(map(id, there or plcs))  # a later call counts these
        if there:
            assert source.process.wait(timeout=20) == 0  # nothing is left to take apart
    for pieces in (here, there):
        assert [piece.solid_numbers.tolist() for piece in pieces] == solids
    for own, sent in zip(here, there):
        assert own.points.tobytes() == sent.points.tobytes()
        assert own.triangles.tobytes() == sent.triangles.tobytes()


def test_the_process_ends_when_nothing_can_be_taken_apart():
    with CadProcess(BRACKET) as source:
        source.wait()
        plc = source.convert(MeshOptions(max_size=8))[0]
        assert source.process.wait(timeout=20) == 0
        assert source.apart(plc) == []


def test_errors_come_back(tmp_path):
    (tmp_path / "bad.step").write_text("what is this")
    Part.makePlane(1, 1).exportBrep(str(tmp_path / "plane.brep"))
    for name, kind, stage in (("bad.step", InputError, "read"), ("plane.brep", MeshError, "plc")):
        with CadProcess(str(tmp_path / name)) as source, pytest.raises(kind) as caught:
            pipeline.run(source, MeshOptions())
        assert caught.value.stage == stage


def test_a_crash_is_an_unreadable_file():
    with CadProcess(BRACKET) as source:
        source.process.send_signal(signal.SIGKILL)
        with pytest.raises(InputError) as caught:
            pipeline.run(source, MeshOptions())
    assert caught.value.code == "unreadable" and BRACKET in str(caught.value)


def test_the_command_line_does_not_hold_freecad(tmp_path):
    report = tmp_path / "a.json"
    command = [sys.executable, "-m", "DelaunayMesher", BRACKET, "-o", str(tmp_path / "a.vtu")]
    subprocess.run([*command, "--report", str(report), "--max-size", "8"], cwd=ROOT, check=True, timeout=120)
    assert os.path.getsize(tmp_path / "a.vtu") > 0
    assert json.loads(report.read_text())["peak_bytes"] < 70e6
