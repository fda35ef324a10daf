"""Dihedral angles of the eight parts of the tests, at several sizes and seeds, before and after optimisation.

/usr/bin/python3 benchmarks/angles.py [--scales 1 0.8 0.6 0.45] [--seeds 3]
"""

import argparse
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [ROOT, os.path.join(ROOT, "tests", "document")]

import DelaunayMesher  # noqa: E402
from DelaunayMesher import document  # noqa: E402

PER_CIRCLE = 12  # at scale 1


def qualities(name, scales, seeds, optimise):
    """[(number of tetrahedra, quality summary)] of one part."""
    from parts import PARTS, SIZES  # needs FreeCAD, which importing document has found

    shape = PARTS[name]()
    found = []
    for scale in scales:
        # Where curvature sets the size, as round the plate's holes, max_size alone would change nothing.
        options = document.make_options(
            max_size=scale * SIZES[name], elements_per_circle=PER_CIRCLE / scale, optimise=optimise
        )
        plc = document.convert(shape, options).plc
        for seed in range(1, seeds + 1):
            mesh = DelaunayMesher.mesh(plc, options, seed=seed)
            found.append((len(mesh.tets), mesh.quality))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--scales", type=float, nargs="+", default=[1.0, 0.8, 0.6, 0.45])
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    from parts import PARTS

    heads = "part|optimised|meshes|tetrahedra|below 20|below 30|smallest|largest|mean smallest".split("|")
    print("| %s |" % " | ".join(heads))
    print("|---" * len(heads) + "|")
    for name in PARTS:
        for optimise in (False, True):
            found = qualities(name, options.scales, options.seeds, optimise)
            tets = sum(count for count, _ in found)
            below, sharp = (sum(quality["below"][limit] for _, quality in found) for limit in ("20", "30"))
            smallest = min(quality["min_dihedral"] for _, quality in found)
            largest = max(quality["max_dihedral"] for _, quality in found)
            mean = sum(count * quality["mean_min_dihedral"] for count, quality in found) / tets
            row = (name, "yes" if optimise else "no", len(found), tets, below, 100 * sharp / tets)
            print("| %s | %s | %d | %d | %d | %.3f %%" % row, end=" ")
            print("| %.2f | %.2f | %.1f |" % (smallest, largest, mean), flush=True)


main()
