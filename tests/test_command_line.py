import json
import os
import shutil
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from sample_surfaces import box, write_stl

import DelaunayMesher
from DelaunayMesher.__main__ import main, parser
from DelaunayMesher.options import OPTIONS

ROOT = Path(__file__).parent.parent


@pytest.fixture
def part(tmp_path):
    path = tmp_path / "part.stl"
    write_stl(path, *box(high=(10, 10, 10)))
    return path


def run(*arguments):
    command = [sys.executable, "-m", "DelaunayMesher", *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)


def test_every_flag_of_the_contract():
    flags = (
        "--max-size --min-size --growth --elements-per-circle --size-at --order --target-angle --no-optimise"
    )
    known = {flag for action in parser()._actions for flag in action.option_strings}
    assert set((flags + " --seed --threads --report --quiet -o").split()) <= known
    assert {option.flag for option in OPTIONS} <= known


def test_a_reader_that_stops_early_stops_nothing(part, tmp_path):
    command = [sys.executable, "-m", "DelaunayMesher", part, "-o", tmp_path / "a.vtu"]
    with subprocess.Popen(
        [*map(str, command), "--report", str(tmp_path / "a.json")],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        process.stdout.close()
        assert process.stderr.read() == ""
    assert process.returncode == 0
    assert json.loads((tmp_path / "a.json").read_text())["status"] == "ok"


def test_mesh_and_report(part, tmp_path):
    meshio = pytest.importorskip("meshio")
    done = run(
        part, "-o", tmp_path / "a.vtu", "--max-size", "3", "--report", tmp_path / "a.json", "--seed", "7"
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    mesh = meshio.read(tmp_path / "a.vtu")
    assert [cells.type for cells in mesh.cells] == ["tetra", "triangle"]
    assert set(mesh.cell_data["solid"][0]) == {1} and set(mesh.cell_data["face"][1]) == {1, 2, 3, 4, 5, 6}
    report = json.loads((tmp_path / "a.json").read_text())
    assert report["status"] == "ok" and report["seed"] == 7
    assert report["points"] == len(mesh.points) and report["tetrahedra"] == len(mesh.cells[0].data)
    assert list(report["seconds"])[:2] == ["total", "read"] and "write" in report["seconds"]
    assert report["peak_bytes"] > 1e6
    assert report["quality"]["min_dihedral"] > 15
    assert set(report["quality"]["below"]) == {"5", "10", "15", "20", "30"}
    assert report["below_target"] == [] and report["warnings"] == []


def test_reading_and_writing_are_in_the_total(part, tmp_path, monkeypatch, capsys):
    from DelaunayMesher import meshfile, pipeline

    def slow(real, *arguments):
        time.sleep(0.3)
        return real(*arguments)

    for module, name in ((pipeline, "read_surface"), (meshfile, "write_mesh")):
        monkeypatch.setattr(module, name, partial(slow, getattr(module, name)))
    assert main([str(part), "-o", str(tmp_path / "a.vtu"), "--report", str(tmp_path / "a.json")]) == 0
    total, *stages = json.loads((tmp_path / "a.json").read_text())["seconds"].values()
    assert total == pytest.approx(sum(stages), abs=0.25)
    assert "\n%.3f s: read " % total in capsys.readouterr().out


def test_second_order_quiet_and_sizes(part, tmp_path):
    meshio = pytest.importorskip("meshio")
    arguments = [
        "--order",
        "2",
        "--quiet",
        "--size-at",
        "Face1=1",
        "--size-at",
        "Vertex8=0.5",
        "--no-optimise",
    ]
    done = run(part, "-o", tmp_path / "a.inp", *arguments)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert [cells.type for cells in meshio.read(tmp_path / "a.inp").cells] == ["tetra10"]


def test_same_seed_same_file(part, tmp_path):
    for name in ("a.vtk", "b.vtk"):
        assert main([str(part), "-o", str(tmp_path / name), "--quiet"]) == 0
    assert (tmp_path / "a.vtk").read_bytes() == (tmp_path / "b.vtk").read_bytes()


@pytest.mark.parametrize(
    "extra",
    [
        ["--max-size", "0"],
        ["--max-size", "x"],
        ["--order", "3"],
        ["--size-at", "Face1"],
        ["--size-at", "Face99=1"],
        ["--size-at", "Nose1=1"],
        ["--size-at", "Face1=-1"],
        ["--no-such-option"],
        ["--report", "no/such/folder/a.json"],
        ["-o", "a.nothing"],
        ["-o", "no/such/folder/a.vtu"],
    ],
)
def test_wrong_usage(part, tmp_path, extra):
    done = run(part, "-o", tmp_path / "a.vtu", *extra)
    assert done.returncode == 2
    assert done.stderr and "Traceback" not in done.stderr
    assert not (tmp_path / "a.vtu").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["part.mesh", "-o", "part.mesh"],
        ["part.mesh", "-o", "link.mesh"],
        ["part.mesh", "-o", "folder/../part.mesh"],
        ["part.mesh", "-o", "a.vtu", "--report", "part.mesh"],
        ["part.mesh", "-o", "a.vtu", "--report", "folder/../a.vtu"],
        ["part.FCStd", "-o", "part.FCStd"],
    ],
)
def test_no_file_replaces_another_of_the_same_run(tmp_path, monkeypatch, capsys, arguments):
    monkeypatch.chdir(tmp_path)
    for name in ("part.mesh", "part.FCStd"):
        Path(name).write_text("what somebody has made")
    os.symlink("part.mesh", "link.mesh")
    os.mkdir("folder")
    before = sorted(os.listdir("."))
    assert main(arguments) == 2
    assert "would replace" in capsys.readouterr().err
    assert sorted(os.listdir(".")) == before
    for name in ("part.mesh", "part.FCStd"):
        assert Path(name).read_text() == "what somebody has made"


def test_unreadable_input(tmp_path):
    (tmp_path / "bad.stl").write_text("what is this")
    (tmp_path / "a.doc").write_text("letter")
    for name in ("missing.stl", "missing.step", "bad.stl", "a.doc"):
        done = run(tmp_path / name, "-o", tmp_path / "a.vtu")
        assert done.returncode == 2, name
        assert name in done.stderr and "Traceback" not in done.stderr


def test_no_mesh(tmp_path):
    points, triangles = box()
    write_stl(tmp_path / "open.stl", points, triangles[:-1])
    done = run(tmp_path / "open.stl", "-o", tmp_path / "a.vtu", "--report", tmp_path / "a.json")
    assert done.returncode == 1
    assert "open_edge" in done.stderr and "near (" in done.stderr
    report = json.loads((tmp_path / "a.json").read_text())
    assert report["status"] == "failed" and report["error"]["code"] == "open_edge"
    for seed, reported in (("7", 7), ("1e2", 100), ("seven", None)):
        run(tmp_path / "open.stl", "-o", tmp_path / "a.vtu", "--report", tmp_path / "a.json", "--seed", seed)
        assert json.loads((tmp_path / "a.json").read_text())["seed"] == reported
    done = run(tmp_path / "open.stl")
    assert done.returncode == 2


def test_below_target_is_status_3(part, tmp_path, monkeypatch):
    from DelaunayMesher import pipeline

    real = pipeline.run

    def one_bad_element(*arguments):
        mesh = real(*arguments)
        place = [0.0, 0.0, 0.0]
        mesh.below_target = [{"tet": 0, "angle": 9.0, "reason": reason, "entity": "Face1", "place": place}]
        return mesh

    monkeypatch.setattr(pipeline, "run", one_bad_element)
    arguments = [str(part), "-o", str(tmp_path / "a.vtu"), "--quiet", "--report", str(tmp_path / "a.json")]
    reason = "fallback"
    assert main(arguments) == 3
    assert json.loads((tmp_path / "a.json").read_text())["below_target"][0]["face"] == "Face1"
    reason = "input_angle"
    assert main(arguments) == 0


def test_interrupt(part, tmp_path):
    command = [
        sys.executable,
        "-m",
        "DelaunayMesher",
        str(part),
        "-o",
        str(tmp_path / "a.vtu"),
        "--max-size",
        "0.12",
    ]
    # A shell that runs this in the background has its children ignore the signal.
    process = subprocess.Popen(
        command,
        cwd=ROOT,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    time.sleep(2.0)
    assert process.poll() is None, "the mesh was done before it could be interrupted"
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "cancelled" in errors and "Traceback" not in errors
    assert not os.path.exists(tmp_path / "a.vtu")


def test_version_and_quick_import():
    assert run("--version").stdout.split()[-1] == DelaunayMesher.__version__
    code = "import sys, DelaunayMesher; print('numpy' in sys.modules, 'FreeCAD' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.stdout.split() == ["False", "False"]


def test_missing_extension_says_what_to_do(monkeypatch):
    monkeypatch.setitem(sys.modules, "DelaunayMesher._core", None)
    monkeypatch.delattr(DelaunayMesher, "_core", raising=False)
    with pytest.raises(DelaunayMesher.MeshError) as caught:
        DelaunayMesher.delaunay(np.zeros((4, 3)))
    assert "setup.sh" in str(caught.value)


@pytest.mark.parametrize("folder", ["wheel", "mod/compiled"])
def test_extension_from_a_wheel_elsewhere(tmp_path, folder):
    """A copy of the package without its compiled part uses that of an installed wheel: one on the search
    path, or the one in the copy's own folder.
    """
    shutil.copytree(
        ROOT / "DelaunayMesher", tmp_path / "mod" / "DelaunayMesher", ignore=shutil.ignore_patterns("_core*")
    )
    (tmp_path / folder / "DelaunayMesher").mkdir(parents=True)
    for path in (ROOT / "DelaunayMesher").glob("_core*"):
        shutil.copy(path, tmp_path / folder / "DelaunayMesher")
    code = "import DelaunayMesher as d; print(len(d.delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])))"
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([str(tmp_path / "mod"), str(tmp_path / "wheel")]),
    }
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.stdout.split() == ["1"], done.stderr
