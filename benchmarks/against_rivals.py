"""The eight parts of the tests at about 300,000 tetrahedra, all stages, beside Gmsh's HXT and Netgen.

    python3 -m venv ../rivals && ../rivals/bin/pip install gmsh netgen-mesher numpy
    /usr/bin/python3 benchmarks/against_rivals.py --rivals ../rivals/bin/python

Without --rivals only ours is measured.  Every run is a process of its own with one thread.  Time is processor
time of meshing alone: ours from the CAD solid to the finished arrays, a rival's with its geometry loaded.  On
each part the meshers take turns, and the best time of each counts; Netgen, which needs a minute for a part,
runs once and on the parts of --netgen only.  HXT gets the size at which it makes about as many tetrahedra as
ours, found by runs that are not counted; Netgen gets three quarters of our size, which makes 0.8 to 1.1 times
as many.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

from meshers import HXT, NETGEN, OURS, PLAIN, ROOT, run

sys.path.insert(0, os.path.join(ROOT, "tests", "document"))
FIRST_GUESS = {HXT: 0.82, NETGEN: 0.75}  # size setting over ours


def run_one(mesher, path, size):
    """Runs one mesher in this process and prints one line of JSON."""
    from DelaunayMesher import quality

    made = run(mesher, path, size)
    angles = quality.dihedral_angles(made.points, made.tets)
    least = angles.min(axis=1)
    row = {
        "tets": len(made.tets),
        "wall": made.wall,
        "processor": made.processor,
        "smallest": float(least.min()),
        "largest": float(angles.max()),
        "below 30": 100 * float((least < 30).mean()),
        "mean": float(least.mean()),
    }
    print(json.dumps(row))


def launch(mesher, path, size, options):
    """The row of one run in a process of its own; None when it failed or took too long."""
    python = options.rivals if mesher in (HXT, NETGEN) else sys.executable
    command = [python, os.path.abspath(__file__), "--run", mesher, path, repr(size)]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, check=True, timeout=options.timeout)
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as error:
        print("%s at size %g: %s" % (mesher, size, error), file=sys.stderr)
        return None
    return json.loads(done.stdout.decode().strip().splitlines()[-1])


def size_for(mesher, path, size, options, tries):
    """Size at which the mesher makes about options.tets tetrahedra."""
    for _ in range(tries):
        row = launch(mesher, path, size, options)
        if row is None or abs(row["tets"] / options.tets - 1) < 0.04:
            break
        size *= (row["tets"] / options.tets) ** (1 / 3)
    return size


def measure(part, path, size, options):
    """{mesher: its rows} on one part."""
    ours = size_for(PLAIN, path, size, options, 4)
    sizes = {OURS: ours, PLAIN: ours}
    if options.rivals:
        sizes[HXT] = size_for(HXT, path, FIRST_GUESS[HXT] * ours, options, 2)
    rows = {mesher: [] for mesher in sizes}
    for _ in range(options.repeat):
        for mesher, setting in sizes.items():
            rows[mesher].append(launch(mesher, path, setting, options))
    if options.rivals and part in options.netgen:
        rows[NETGEN] = [launch(NETGEN, path, FIRST_GUESS[NETGEN] * ours, options)]
    return {mesher: [row for row in found if row] for mesher, found in rows.items()}


def print_part(part, rows):
    speed = {
        name: max(row["tets"] / row["processor"] for row in found) for name, found in rows.items() if found
    }
    for name in speed:
        row = rows[name][0]
        print(
            "| %s | %s | %d | %.1f .. %.1f | %.3f %% | %.1f | %.1f k | %s |"
            % (
                part,
                name,
                row["tets"],
                row["smallest"],
                row["largest"],
                row["below 30"],
                row["mean"],
                speed[name] / 1000,
                "%.2f" % (speed[OURS] / speed[name]) if OURS in speed else "",
            ),
            flush=True,
        )


def print_table(options):
    from parts import PARTS

    print("| part | mesher | tetrahedra | angles | below 30 | mean smallest | tets/s | ours is faster by |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for part in options.parts or PARTS:
            shape = PARTS[part]()
            path = os.path.join(folder, part + ".step")
            shape.exportStep(path)
            print_part(part, measure(part, path, (8 * shape.Volume / options.tets) ** (1 / 3), options))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rivals", help="a Python that has gmsh, netgen and numpy")
    parser.add_argument("--parts", nargs="+", help="names of the tests' parts; all when left out")
    parser.add_argument("--netgen", nargs="*", default=["bracket", "torus", "plate"], help="parts for Netgen")
    parser.add_argument("--tets", type=int, default=300000)
    parser.add_argument("--repeat", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=300, help="seconds for each run")
    parser.add_argument("--run", nargs=3, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.run:
        run_one(options.run[0], options.run[1], float(options.run[2]))
        return
    import DelaunayMesher.document  # noqa: F401  (finds FreeCAD, which the parts need)

    print_table(options)


if __name__ == "__main__":
    main()
