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


def qualities(name, scales, seeds, optimise):
    """[(number of tetrahedra, quality summary)] of one part."""
    from parts import PARTS, SIZES  # needs FreeCAD, which importing document has found

    shape = PARTS[name]()
    found = []
    for scale in scales:
        options = document.make_options(max_size=scale * SIZES[name], optimise=optimise)
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

    print("| part | optimised | meshes | tetrahedra | below 20 | smallest | largest | mean smallest |")
    print("|---|---|---|---|---|---|---|---|")
    for name in PARTS:
        for optimise in (False, True):
            found = qualities(name, options.scales, options.seeds, optimise)
            tets = sum(count for count, _ in found)
            below = sum(quality["below"]["20"] for _, quality in found)
            smallest = min(quality["min_dihedral"] for _, quality in found)
            largest = max(quality["max_dihedral"] for _, quality in found)
            mean = sum(count * quality["mean_min_dihedral"] for count, quality in found) / tets
            row = (name, "yes" if optimise else "no", len(found), tets, below, smallest, largest, mean)
            print("| %s | %s | %d | %d | %d | %.2f | %.2f | %.1f |" % row, flush=True)


main()
