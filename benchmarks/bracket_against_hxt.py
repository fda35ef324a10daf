"""The example bracket at about 100,000 tetrahedra: all stages of ours beside Gmsh's HXT, in the same run.

    python3 -m venv ../rivals && ../rivals/bin/pip install gmsh numpy
    /usr/bin/python3 benchmarks/bracket_against_hxt.py --gmsh ../rivals/bin/python

Every repetition runs each mesher once, each in a process of its own with one thread, so that a busy machine
is busy for all; the best time of each counts.  Time is that of meshing alone: ours from the CAD solid to the
finished arrays, Gmsh's generate(3) with its geometry loaded.  Processor time suffers less from others.
At the same size setting HXT's edges are a fifth longer, so it runs a second time with a setting that gives it
about as many tetrahedra.
"""

import argparse
import json
import os
import platform
import subprocess
import sys

from meshers import HXT, OURS, PLAIN, ROOT, run

PART = os.path.join(ROOT, "resources", "examples", "bracket.step")
HXT_FINER = "Gmsh HXT, finer"
MESHERS = (OURS, PLAIN, HXT, HXT_FINER)
FINER = 0.79  # size setting of HXT for about as many tetrahedra as ours


def run_one(mesher, size):
    """Runs one mesher in this process and prints one line of JSON."""
    import numpy as np

    from DelaunayMesher import quality

    made = run(HXT, PART, FINER * size) if mesher == HXT_FINER else run(mesher, PART, size)
    angles = quality.dihedral_angles(made.points, made.tets)
    row = {
        "tets": len(made.tets),
        "wall": made.wall,
        "processor": made.processor,
        "stages": made.stages,
        "smallest": float(angles.min()),
        "largest": float(angles.max()),
        "mean": float(angles.min(axis=1).mean()),
        "below 20": int((angles.min(axis=1) < 20).sum()),
        "edge": float(np.median(quality.edge_lengths(made.points, made.tets)) / size),
    }
    print(json.dumps(row))


def repeat(options):
    """{mesher: list of rows}, the meshers taking turns."""
    rows = {mesher: [] for mesher in MESHERS}
    for _ in range(options.repeat):
        for mesher in MESHERS:
            python = options.gmsh if mesher in (HXT, HXT_FINER) else sys.executable
            command = [python, __file__, "--run", mesher, "--size", repr(options.size)]
            done = subprocess.run(command, stdout=subprocess.PIPE, check=True, timeout=options.timeout)
            rows[mesher].append(json.loads(done.stdout.decode().strip().splitlines()[-1]))
    return rows


def print_table(rows, size):
    load = "%.1f" % os.getloadavg()[0] if hasattr(os, "getloadavg") else "?"
    print("bracket, size %g mm, one thread, %s, %s cores, load %s, best of %d"
          % (size, platform.machine(), os.cpu_count(), load, len(rows[OURS])))  # fmt: skip
    print()
    heads = "mesher|tetrahedra|seconds|processor s|tets/s|dihedral angles|mean smallest|below 20|edge / h"
    print("| %s |" % heads.replace("|", " | "))
    print("|---|---|---|---|---|---|---|---|---|")
    for mesher, found in rows.items():
        wall, processor = min(row["wall"] for row in found), min(row["processor"] for row in found)
        row = found[0]
        print("| %s | %d | %.2f | %.2f | %d k | %.1f .. %.1f | %.1f | %d | %.2f |" % (
            mesher, row["tets"], wall, processor, row["tets"] / wall / 1000, row["smallest"], row["largest"],
            row["mean"], row["below 20"], row["edge"],
        ))  # fmt: skip
    print()
    for clock in ("wall", "processor"):
        speed = {name: max(row["tets"] / row[clock] for row in found) for name, found in rows.items()}
        for rival in (HXT, HXT_FINER):
            ratios = ["%s %.2f" % (name, speed[name] / speed[rival]) for name in MESHERS[:2]]
            print("tets/s over those of %s (%s time): %s" % (rival, clock, ", ".join(ratios)))
    stages = rows[OURS][0]["stages"]
    best = {stage: min(row["stages"][stage] for row in rows[OURS]) for stage in stages}
    print("stages of ours, s: " + ", ".join("%s %.3f" % item for item in best.items()))
    plain = rows[PLAIN]
    refined = max(row["tets"] / row["stages"]["refinement"] for row in plain)
    print("refinement alone: %d k tets/s" % (refined / 1000))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--gmsh", default=sys.executable, help="a Python that has gmsh and numpy")
    parser.add_argument("--size", type=float, default=2.55, help="element size in mm")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--timeout", type=float, default=120, help="seconds for each run")
    parser.add_argument("--run", choices=MESHERS, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.run:
        run_one(options.run, options.size)
    else:
        print_table(repeat(options), options.size)


main()
