"""What refinement alone reaches: angles, tries, sizes and counts on eight parts without sharp edges, no
optimisation, one thread. k tets/s: all stages, processor time.

    /usr/bin/python3 benchmarks/refinement.py [--tets 30000] [--seeds 10] [--target 20] [--parts box gear]
    /usr/bin/python3 benchmarks/refinement.py --graded     # 20 : 1 from a face, an edge, a point
"""

import argparse
import itertools
import math
import os
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [ROOT, os.path.join(ROOT, "tests", "document")]

import numpy as np  # noqa: E402

import DelaunayMesher  # noqa: E402
from DelaunayMesher import document, quality  # noqa: E402

GROWTHS = (0.1, 0.2, 0.3, 0.4)
GRADING = 20  # largest size over the smallest in the graded runs


def box_with_holes():
    import Part
    from FreeCAD import Vector

    box = Part.makeBox(30, 30, 30)
    upright = Part.makeCylinder(5, 30, Vector(10, 10, 0))
    across = Part.makeCylinder(4, 30, Vector(22, 0, 20), Vector(0, 1, 0))
    return box.cut(Part.makeCompound([upright, across])).removeSplitter().Solids[0]


def ellipsoid():
    import Part
    from FreeCAD import Matrix

    stretch = Matrix()
    stretch.A22, stretch.A33 = 0.7, 0.5
    return Part.makeSphere(10).transformGeometry(stretch).Solids[0]


def gear(teeth=10, inner=15.0, outer=20.0, width=12.0, rounding=1.2):
    """A spur gear whose teeth are rounded at tip and root, with a bore."""
    import Part
    from FreeCAD import Vector

    corners = []
    for tooth in range(teeth):
        for turn, radius in ((-0.32, inner), (-0.17, outer), (0.17, outer), (0.32, inner)):
            angle = 2 * math.pi * (tooth + turn) / teeth
            corners.append(Vector(radius * math.cos(angle), radius * math.sin(angle), 0))
    body = Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(Vector(0, 0, width))
    upright = [edge for edge in body.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.99]
    body = body.makeFillet(rounding, upright)
    return body.cut(Part.makeCylinder(6, width)).removeSplitter().Solids[0]


def parts():
    """{name: function that makes the shape}"""
    from parts import PARTS, blade

    return {
        "box": PARTS["box"],
        "box with holes": box_with_holes,
        "ellipsoid": ellipsoid,
        "torus": PARTS["torus"],
        "bracket": PARTS["bracket"],
        "gear": gear,
        "plate with 49 holes": PARTS["plate"],
        "blade": blade,
    }


def options_for(size, **more):
    return document.make_options(max_size=size, optimise=False, threads=1, **more)


def size_for(shape, wanted):
    """max_size at which the part gets about `wanted` tetrahedra, or as few as its curvature allows."""
    size = (8 * shape.Volume / wanted) ** (1 / 3)
    for _ in range(4):
        got = len(DelaunayMesher.mesh(shape, options_for(size)).tets)
        if abs(got / wanted - 1) < 0.03:
            break
        size *= (got / wanted) ** (1 / 3)
    return size


def relative_edges(mesh, plc):
    """Lengths of the edges over the size wanted at their middles."""
    from DelaunayMesher import extension
    from DelaunayMesher.pipeline import options_for_core

    pairs = mesh.tets[:, list(quality.EDGES)].reshape(-1, 2)
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    a, b = mesh.points[pairs[:, 0]], mesh.points[pairs[:, 1]]
    core_options = options_for_core(mesh.options, plc)
    wanted = extension.load().sizes(plc.as_dict(), plc.geometry, core_options, (a + b) / 2)
    return np.linalg.norm(a - b, axis=1) / wanted


def run(plc, options, sized):
    """One row of figures of one mesh."""
    start = time.process_time()
    mesh = DelaunayMesher.mesh(plc, options)
    seconds = time.process_time() - start
    angles = quality.dihedral_angles(mesh.points, mesh.tets)
    statistics = mesh.statistics
    row = {
        "tets": len(mesh.tets),
        "min": angles.min(),
        "max": angles.max(),
        "below": int((angles.min(axis=1) < options.target_angle).sum()),
        "relaxed": statistics["refinement_relaxed"],
        "constrained": statistics["refinement_constrained"],
        "tries": statistics["refinement_tries"] / max(1, statistics["refinement_sites"]),
        "predicted": statistics["predicted_tetrahedra"] / len(mesh.tets),
        "speed": len(mesh.tets) / seconds,
    }
    if sized:
        edges = relative_edges(mesh, plc)
        row["median"], row["p99"] = np.median(edges), np.quantile(edges, 0.99)
    return row


HEAD = (
    "part | tetrahedra | seeds | smallest | largest | below target | relaxed | constrained | tries per site "
    "| predicted / got | median edge / h | 99 % of edges below | k tets/s"
)


def print_rows(name, rows):
    def over(key, choose):
        return choose([row[key] for row in rows])

    sized = rows[0]
    print(
        "| %s | %d | %d | %.2f | %.2f | %d | %d | %d | %.2f | %.2f | %.2f | %.2f | %d |"
        % (
            name,
            over("tets", np.mean),
            len(rows),
            over("min", min),
            over("max", max),
            over("below", sum),
            over("relaxed", sum),
            over("constrained", sum),
            over("tries", np.mean),
            over("predicted", np.mean),
            sized["median"],
            sized["p99"],
            over("speed", np.median) / 1000,
        ),
        flush=True,
    )


def uniform(chosen, options):
    for name in chosen:
        shape = parts()[name]()
        size = size_for(shape, options.tets)
        plc = document.convert(shape, options_for(size)).plc
        rows = []
        for seed in range(1, options.seeds + 1):
            rows.append(run(plc, options_for(size, seed=seed, target_angle=options.target), seed == 1))
        print_rows(name, rows)


def graded(chosen, options):
    for name, growth in itertools.product(chosen, GROWTHS):
        shape = parts()[name]()
        largest = shape.BoundBox.DiagonalLength / 8
        for source in ("Face1", "Edge1", "point"):
            sizes = {} if source == "point" else {source: largest / GRADING}
            given = {"sizes": sizes, "growth": growth, "target_angle": options.target}
            if source == "point":
                centre = shape.BoundBox.Center
                given.update(size_points=[tuple(centre)], size_values=[largest / GRADING])
            plc = document.convert(shape, options_for(largest, **given)).plc
            rows = []
            for seed in range(1, options.seeds + 1):
                rows.append(run(plc, options_for(largest, seed=seed, **given), seed == 1))
            print_rows("%s, %s, growth %g" % (name, source, growth), rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--tets", type=int, default=30000)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--target", type=float, default=20)
    parser.add_argument("--graded", action="store_true")
    parser.add_argument("--parts", nargs="+", help="some of: " + ", ".join(parts()))
    options = parser.parse_args()
    chosen = options.parts or list(parts())
    print("| %s |" % HEAD)
    print("|---" * len(HEAD.split("|")) + "|")
    (graded if options.graded else uniform)(chosen, options)


main()
