"""From the click to the finished FEM object in FreeCAD's window: our panel beside FreeCAD's Gmsh with HXT.

    apt-get install gmsh xvfb
    /usr/bin/python3 benchmarks/click_to_mesh.py

The example bracket in one FreeCAD under Xvfb; the two take turns and start from an empty mesh object each
time.  Gmsh is driven as FreeCAD's panel does (GmshTools), with 12 elements per circle and FreeCAD's number of
threads; its size is chosen so that it makes about as many elements as ours.  The time ends when the object
is drawn; processor time suffers less from other programs.  A timer of 40 ms tells how long the window stood
still.
"""

import argparse
import json
import os
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [ROOT, os.path.join(ROOT, "tests", "gui")]

FINER = {1: 0.79, 2: 0.79}  # size setting of Gmsh over ours
TICK = 40  # milliseconds
OPTIONS = "CLICK_TO_MESH"  # environment variable that tells the window what to do


def in_window():
    """Inside FreeCAD: one line of JSON for each run."""
    import drive

    options = json.loads(os.environ[OPTIONS])
    part = drive.open_bracket()
    for order in options["orders"]:
        for _ in range(options["repeat"]):
            for name, mesher in (("ours", ours), ("Gmsh HXT", gmsh)):
                target, finish = mesher(part, options["size"], order)
                row = measured(target, finish)
                row.update(mesher=name, order=order, elements=target.FemMesh.VolumeCount)
                drive.say("ROW", json.dumps(row))
                part.Document.removeObject(target.Name)
                part.ViewObject.show()
                drive.wait(0.3)


def measured(target, finish):
    """Runs `finish`; how long that took until the window had drawn it, and how the window felt."""
    import drive
    import FreeCADGui
    from PySide import QtCore

    ticks = []
    timer = QtCore.QTimer()
    timer.timeout.connect(lambda: ticks.append(time.monotonic()))
    timer.start(TICK)
    drive.wait(0.1)
    begin, used = time.monotonic(), processor_seconds()
    stages = finish()
    FreeCADGui.updateGui()
    seconds, used = time.monotonic() - begin, processor_seconds() - used
    drive.wait(0.1)
    ticks = [tick for tick in ticks if tick >= begin - 0.05]
    pauses = sorted((b - a for a, b in zip(ticks, ticks[1:])), reverse=True)
    return {"seconds": seconds, "processor": used, "stages": stages, "pauses": pauses[:4]}


def wait_in_qt(condition):
    """As when nobody drives the window: Qt's own loop, and Python's lock is left to the mesher's thread."""
    from PySide import QtCore

    loop, timer = QtCore.QEventLoop(), QtCore.QTimer()
    timer.timeout.connect(lambda: condition() and loop.quit())
    timer.start(TICK)
    loop.exec_()
    timer.stop()


def processor_seconds():
    """Of FreeCAD and of the programs that it has run."""
    return sum(os.times()[:4])


def ours(part, size, order):
    """(mesh object, what the click on Mesh starts)"""
    import drive

    panel = drive.open_panel(part)
    panel.options_box.fields["max_size"].write(size)
    panel.options_box.fields["order"].set(order)

    def finish():
        panel.run_box.button.click()
        wait_in_qt(lambda: not panel.running)
        return json.loads(panel.target.Report)["seconds"]

    return panel.target, finish


def gmsh(part, size, order):
    """(mesh object, what FreeCAD's panel does on Apply)"""
    import FreeCADGui
    import ObjectsFem
    from femmesh.gmshtools import GmshTools

    if FreeCADGui.Control.activeDialog():
        FreeCADGui.ActiveDocument.resetEdit()
    target = ObjectsFem.makeMeshGmsh(part.Document, "Gmsh")
    setattr(target, "Part" if hasattr(target, "Part") else "Shape", part)
    target.CharacteristicLengthMax = size * FINER[order]
    target.MeshSizeFromCurvature = 12
    target.ElementOrder = {1: "1st", 2: "2nd"}[order]
    target.Algorithm3D = "HXT"
    target.SecondOrderLinear = False

    def finish():
        tool = GmshTools(target)
        steps, begin = {}, time.monotonic()
        for name, step in (
            ("prepare", tool.update_mesh_data),
            ("prepare", tool.get_tmp_file_paths),
            ("prepare", tool.get_gmsh_command),
            ("prepare", tool.write_gmsh_input_files),
            ("gmsh", tool.run_gmsh_with_geo),
            ("read and assign", tool.read_and_set_new_mesh),
        ):
            step()
            steps[name] = time.monotonic() - begin - sum(steps.values()) + steps.get(name, 0)
        part.ViewObject.hide()
        return steps

    return target, finish


def main():
    import window

    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--size", type=float, default=1.47, help="element size in mm; 1.47: 500 thousand")
    parser.add_argument("--orders", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    os.environ[OPTIONS] = json.dumps(vars(options))
    with tempfile.TemporaryDirectory() as folder:
        home, output = os.path.join(folder, "home"), os.path.join(folder, "output")
        os.makedirs(output)
        printed = window.run_in_window(os.path.abspath(__file__), home, output, seconds=1800)
    if "CLICKS OK" not in printed:
        sys.exit(printed[-3000:])
    rows = [json.loads(line[4:]) for line in printed.splitlines() if line.startswith("ROW ")]
    for order in options.orders:
        report(order, [row for row in rows if row["order"] == order])


def report(order, rows):
    """The best run of each, and how they compare by both clocks."""
    rows.sort(key=lambda row: row["seconds"])
    for name in ("ours", "Gmsh HXT"):
        row = next(row for row in rows if row["mesher"] == name)
        stages = ", ".join("%s %.2f" % item for item in row["stages"].items() if item[1] >= 0.005)
        pauses = " ".join("%.2f" % pause for pause in row["pauses"])
        print("order %d, %s: %d elements, %.2f s, processor %.2f s; longest pauses of the window %s s (%s)"
              % (order, name, row["elements"], row["seconds"], row["processor"], pauses, stages))  # fmt: skip
    for clock in ("seconds", "processor"):
        speed = {}
        for row in rows:
            speed[row["mesher"]] = max(speed.get(row["mesher"], 0.0), row["elements"] / row[clock])
        print("order %d, elements per second (%s), ours over Gmsh: %.2f"
              % (order, clock, speed["ours"] / speed["Gmsh HXT"]))  # fmt: skip


if OPTIONS in os.environ and "OUTPUT" in os.environ:
    import drive

    drive.start(in_window, "CLICKS")
else:
    main()
