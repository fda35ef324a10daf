"""Reference of FreeCAD's example material_nl_platewithhole, without any mesher: the quarter of the plate with
y > 0 and z > 0 in 20-node bricks of a ruled grid, solved by CalculiX.

    python3 benchmarks/plate_reference.py [--divisions 24]

Prints the largest displacement of the last increment.  Plate 400 x 200 x 10 mm with a hole of radius 50 mm,
held at x = -200 mm, pulled with 130 MPa at x = 200 mm; the quarter is symmetric at y = 0 and z = 5 mm.
"""

import argparse
import subprocess
import tempfile

import numpy as np

LENGTH, HALF, RADIUS, HALF_THICKNESS, PULL = 200.0, 100.0, 50.0, 5.0, 130.0
# Of the 27 nodes (i, j, k) of a brick, in halves, the 20 that CalculiX asks for, in its order.
CORNERS = [(0, 0), (2, 0), (2, 2), (0, 2)]
SIDES = [(1, 0), (2, 1), (1, 2), (0, 1)]
BRICK = [(*c, 0) for c in CORNERS] + [(*c, 2) for c in CORNERS]
BRICK += [(*c, 0) for c in SIDES] + [(*c, 2) for c in SIDES] + [(*c, 1) for c in CORNERS]


def round_hole(n):
    """(2 n + 1, 2 n + 1, 2): grid between the half hole and the square |x|, y < 100; denser at the hole."""
    along = np.linspace(0, 4, 2 * n + 1)[:, None]  # 0-1 right side, 1-3 top, 3-4 left
    outer = np.hstack([HALF * np.clip(2 - along, -1, 1), HALF * np.clip(np.minimum(along, 4 - along), 0, 1)])
    angle = np.pi * along / 4
    inner = RADIUS * np.hstack([np.cos(angle), np.sin(angle)])
    share = (np.linspace(0, 1, 2 * n + 1) ** 1.3)[None, :, None]
    share[:, 1::2] = (share[:, :-1:2] + share[:, 2::2]) / 2
    return inner[:, None] * (1 - share) + outer[:, None] * share


def block(first, n):
    """(2 m + 1, n / 2 + 1, 2): regular grid between x = first and first + 100."""
    x = np.linspace(first, first + 100, n + 1)
    y = np.linspace(0, HALF, n // 2 + 1)
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=2)


def bricks(grid, layers):
    """(b, 20, 3) node places of the bricks over a grid of halves, `layers` of them through the thickness."""
    heights = np.linspace(0, HALF_THICKNESS, 2 * layers + 1)
    found = []
    for i in range(0, grid.shape[0] - 1, 2):
        for j in range(0, grid.shape[1] - 1, 2):
            a, b, d = grid[i, j], grid[i + 2, j], grid[i, j + 2]
            turned = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]) < 0
            for k in range(0, 2 * layers, 2):
                places = [
                    (grid[i + (q if turned else p), j + (p if turned else q)], heights[k + r])
                    for p, q, r in BRICK
                ]
                found.append([(*xy, z) for xy, z in places])
    return np.array(found)


def write_input(path, divisions, layers):
    """CalculiX's input; returns the number of nodes."""
    grids = [round_hole(divisions), block(-200.0, divisions), block(100.0, divisions)]
    places = np.concatenate([bricks(grid, layers) for grid in grids])
    points, numbers = np.unique(places.reshape(-1, 3).round(7), axis=0, return_inverse=True)
    numbers = numbers.reshape(-1, 20)
    x, y, z = points.T
    with open(path, "w") as out:
        out.write("*NODE, NSET=ALL\n")
        out.writelines("%d, %.12g, %.12g, %.12g\n" % (i, *p) for i, p in enumerate(points.tolist(), 1))
        out.write("*ELEMENT, TYPE=C3D20R, ELSET=BODY\n")
        for i, row in enumerate((numbers + 1).tolist(), 1):
            text = [str(node) for node in [i, *row]]
            out.write("%s,\n%s\n" % (", ".join(text[:11]), ", ".join(text[11:])))
        for name, on in (("HELD", x == -LENGTH), ("MIDY", y == 0), ("MIDZ", z == HALF_THICKNESS)):
            out.write("*NSET, NSET=%s\n" % name)
            out.writelines("%d,\n" % (node + 1) for node in np.flatnonzero(on).tolist())
        out.write("*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n*PLASTIC\n240, 0\n270, 0.025\n")
        out.write("*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n*STEP, NLGEOM, INC=1000\n*STATIC\n")
        out.write("*BOUNDARY\nHELD, 1, 3\nMIDY, 2\nMIDZ, 3\n*DLOAD\n")
        for face, nodes in enumerate(((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)), 3):
            for brick in np.flatnonzero((x[numbers[:, nodes]] == LENGTH).all(axis=1)).tolist():
                out.write("%d, P%d, %g\n" % (brick + 1, face, -PULL))
        out.write("*NODE PRINT, NSET=ALL\nU\n*END STEP\n")
    return len(points)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--divisions", type=int, default=24, help="round the half hole, a multiple of 8")
    parser.add_argument("--layers", type=int, default=1, help="of bricks through half the thickness")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        nodes = write_input(folder + "/job.inp", chosen.divisions, chosen.layers)
        done = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True)
        if "*ERROR" in done.stdout:
            raise SystemExit(done.stdout[-800:])
        with open(folder + "/job.dat") as results:
            last = results.read().split("displacements")[-1]
    rows = [line.split() for line in last.splitlines()[1:] if len(line.split()) == 4]
    largest = max(np.linalg.norm([float(value) for value in row[1:]]) for row in rows)
    print("%d nodes, largest displacement %.5f mm" % (nodes, largest))


if __name__ == "__main__":
    main()
