"""Convergence study: three problems with exact solutions, orders 1 and 2, our meshes beside Gmsh's.

    python3 benchmarks/convergence.py [--plot FILE.png] [--table FILE.md] [--rivals PYTHON_WITH_GMSH]

Needs FreeCAD (to make the CAD), CalculiX (ccx) and matplotlib.  Gmsh gets the same CAD and a size that gives
it about as many nodes as ours.  Every problem has an exact solution of three-dimensional elasticity, its
loads are integrated exactly on the facets, and the displacements that hold the part are the exact ones, so
that what is measured is the error of the mesh alone.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from typing import Any, Callable, Sequence

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, ROOT)

from DelaunayMesher import document  # noqa: E402

YOUNG, POISSON = 210000.0, 0.3
SHEAR = YOUNG / (2 * (1 + POISSON))
FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))  # outward
MIDDLE = {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9}

# Quadrature on a triangle, exact to the fourth degree: barycentric coordinates and weights.
_A, _B = 0.445948490915965, 0.091576213509771
PLACES = np.array([[1 - 2 * a if i == j else a for j in range(3)] for a in (_A, _B) for i in range(3)])
WEIGHTS = np.repeat([0.223381589678011, 0.109951743655322], 3) / 2


@dataclass
class Problem:
    """A part, where it is held (at its exact displacement) and loaded; `on` picks some of points (n, 3)."""

    name: str
    shape: Callable[[], Any]
    sizes: Sequence[float]  # of order 1, largest first; order 2 gets twice that
    held: Sequence[Any]  # (on, axes)
    loads: Sequence[Any]  # (on, traction): traction(points, normals) (n, 3)
    displacement: Callable[[np.ndarray], np.ndarray]
    stress: Callable[[np.ndarray], np.ndarray]  # the component of interest (n,)
    watched: Callable[[np.ndarray], np.ndarray]  # where the stress is compared
    component: Callable[[np.ndarray, np.ndarray], np.ndarray]  # (points, xx yy zz xy yz zx) -> (n,)


def plane(axis, value):
    return lambda points: np.abs(points[:, axis] - value) < 1e-6


def bore(radius):
    return lambda points: np.abs(np.hypot(points[:, 0], points[:, 1]) - radius) < 1e-6


# --- Cantilever: a round bar held at one end, sheared at the other (Saint-Venant).

LENGTH, RADIUS, END_FORCE = 100.0, 10.0, 1000.0
INERTIA = np.pi * RADIUS**4 / 4


def bar_displacement(points):
    x, y, z = points.T
    factor = END_FORCE / (YOUNG * INERTIA)
    warp = (3 + 2 * POISSON) * RADIUS**2 / 4 * x - x * (x**2 + y**2) / 4
    return factor * np.stack(
        [
            POISSON * (LENGTH - z) * (x**2 - y**2) / 2 + LENGTH * z**2 / 2 - z**3 / 6,
            POISSON * (LENGTH - z) * x * y,
            -x * (LENGTH * z - z**2 / 2) + warp,
        ],
        axis=1,
    )


def bar_traction(points, _):
    """Shear at the loaded end; its sum is END_FORCE along x."""
    x, y, _ = points.T
    factor = SHEAR * END_FORCE / (YOUNG * INERTIA)
    slope_x = (3 + 2 * POISSON) * RADIUS**2 / 4 - (3 * x**2 + y**2) / 4
    return factor * np.stack(
        [slope_x - POISSON * (x**2 - y**2) / 2, -x * y / 2 - POISSON * x * y, 0 * x], axis=1
    )


def bar_shape():
    import Part

    return Part.makeCylinder(RADIUS, LENGTH)


# --- Plate with a hole in plane strain under tension along x (Kirsch): stress factor 3.

HOLE, SIDE, THICKNESS, TENSION = 10.0, 40.0, 10.0, 100.0


def plate_stresses(points):
    """(n, 3): xx, yy, xy."""
    x, y, _ = points.T
    angle, ratio = np.arctan2(y, x), HOLE**2 / (x**2 + y**2)
    c2, c4, s2, s4 = np.cos(2 * angle), np.cos(4 * angle), np.sin(2 * angle), np.sin(4 * angle)
    return TENSION * np.stack(
        [
            1 - ratio * (1.5 * c2 + c4) + 1.5 * ratio**2 * c4,
            -ratio * (0.5 * c2 - c4) - 1.5 * ratio**2 * c4,
            -ratio * (0.5 * s2 + s4) + 1.5 * ratio**2 * s4,
        ],
        axis=1,
    )


def plate_displacement(points):
    x, y, _ = points.T
    angle, r = np.arctan2(y, x), np.hypot(x, y)
    kappa, a = 3 - 4 * POISSON, HOLE
    factor = TENSION * a / (8 * SHEAR)
    c, c3, s, s3 = np.cos(angle), np.cos(3 * angle), np.sin(angle), np.sin(3 * angle)
    return factor * np.stack(
        [
            r / a * (kappa + 1) * c + 2 * a / r * ((1 + kappa) * c + c3) - 2 * (a / r) ** 3 * c3,
            r / a * (kappa - 3) * s + 2 * a / r * ((1 - kappa) * s + s3) - 2 * (a / r) ** 3 * s3,
            0 * x,
        ],
        axis=1,
    )


def plate_traction(points, normals):
    xx, yy, xy = plate_stresses(points).T
    nx, ny, _ = normals.T
    return np.stack([xx * nx + xy * ny, xy * nx + yy * ny, 0 * nx], axis=1)


def plate_shape():
    import Part

    return Part.makeBox(SIDE, SIDE, THICKNESS).cut(Part.makeCylinder(HOLE, THICKNESS))


# --- Thick-walled pipe under pressure in plane strain, a quarter of it (Lame).

INNER, OUTER, PRESSURE = 10.0, 20.0, 100.0
LAME_A = PRESSURE * INNER**2 / (OUTER**2 - INNER**2)
LAME_B = LAME_A * OUTER**2


def pipe_displacement(points):
    x, y, _ = points.T
    r2 = x**2 + y**2
    radial_over_r = ((1 - 2 * POISSON) * LAME_A + LAME_B / r2) / (2 * SHEAR)
    return np.stack([radial_over_r * x, radial_over_r * y, 0 * x], axis=1)


def pipe_hoop(points):
    return LAME_A + LAME_B / (points[:, 0] ** 2 + points[:, 1] ** 2)


def hoop_of(points, stresses):
    """Hoop stress (n,) from xx yy zz xy yz zx."""
    angle = np.arctan2(points[:, 1], points[:, 0])
    s, c = np.sin(angle), np.cos(angle)
    return stresses[:, 0] * s**2 + stresses[:, 1] * c**2 - 2 * stresses[:, 3] * s * c


def pipe_shape():
    import FreeCAD
    import Part

    axis = FreeCAD.Vector(0, 0, 1)
    outside = Part.makeCylinder(OUTER, THICKNESS, FreeCAD.Vector(), axis, 90)
    return outside.cut(Part.makeCylinder(INNER, THICKNESS, FreeCAD.Vector(), axis, 90))


SLICE = [(plane(0, 0.0), [0]), (plane(1, 0.0), [1]), (plane(2, 0.0), [2]), (plane(2, THICKNESS), [2])]
PROBLEMS = [
    Problem(
        "cantilever",
        bar_shape,
        [8.0, 5.6, 4.0, 2.8],
        [(plane(2, 0.0), [0, 1, 2])],
        [(plane(2, LENGTH), bar_traction)],
        bar_displacement,
        lambda points: -END_FORCE * (LENGTH - points[:, 2]) * points[:, 0] / INERTIA,
        lambda points: (np.abs(points[:, 2] - LENGTH / 2) < LENGTH / 10) & bore(RADIUS)(points),
        lambda _, stresses: stresses[:, 2],
    ),
    Problem(
        "plate with hole",
        plate_shape,
        [4.0, 2.8, 2.0, 1.4],
        SLICE,
        [(plane(0, SIDE), plate_traction), (plane(1, SIDE), plate_traction)],
        plate_displacement,
        lambda points: plate_stresses(points)[:, 0],
        lambda points: bore(HOLE)(points) & (points[:, 0] < 0.05 * HOLE),
        lambda _, stresses: stresses[:, 0],
    ),
    Problem(
        "pipe under pressure",
        pipe_shape,
        [4.0, 2.8, 2.0, 1.4],
        SLICE,
        [(bore(INNER), lambda points, normals: -PRESSURE * normals)],
        pipe_displacement,
        pipe_hoop,
        bore(INNER),
        hoop_of,
    ),
]


# --- Finite elements


def boundary(tets):
    """Boundary triangles (f, 3 | 6), outward."""
    sides = [
        [*face, *(MIDDLE[tuple(sorted(pair))] for pair in zip(face, face[1:] + face[:1]))] for face in FACES
    ]
    columns = sides if tets.shape[1] == 10 else [side[:3] for side in sides]
    faces = np.concatenate([tets[:, side] for side in columns])
    _, first, count = np.unique(np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def shape_functions(place, nodes):
    """(values (nodes,), derivatives (nodes, 2)) of a triangle of 3 or 6 nodes."""
    slopes = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    if nodes == 3:
        return place, slopes
    values, derivatives = list(place * (2 * place - 1)), [slopes[i] * (4 * place[i] - 1) for i in range(3)]
    for i, j in ((0, 1), (1, 2), (2, 0)):
        values.append(4 * place[i] * place[j])
        derivatives.append(4 * (place[i] * slopes[j] + place[j] * slopes[i]))
    return np.array(values), np.array(derivatives)


def nodal_forces(points, faces, on, traction):
    """(n, 3) consistent forces of a traction on the facets whose corners are all picked by `on`."""
    forces = np.zeros_like(points)
    faces = faces[on(points)[faces[:, :3]].all(axis=1)]
    for place, weight in zip(PLACES, WEIGHTS):
        values, derivatives = shape_functions(place, faces.shape[1])
        tangents = np.einsum("fnc,nd->fdc", points[faces], derivatives)
        areas = np.cross(tangents[:, 0], tangents[:, 1])
        length = np.linalg.norm(areas, axis=1)[:, None]
        load = weight * length * traction(np.einsum("fnc,n->fc", points[faces], values), areas / length)
        for column, value in enumerate(values):
            np.add.at(forces, faces[:, column], value * load)
    return forces


def write_input(path, problem, points, tets):
    """CalculiX's input file; it reads 20 characters of a number."""
    exact = problem.displacement(points)
    faces = boundary(tets)
    forces = sum(nodal_forces(points, faces, on, traction) for on, traction in problem.loads)
    with open(path, "w") as out:
        out.write("*NODE, NSET=ALL\n")
        out.writelines("%d, %.12g, %.12g, %.12g\n" % (i, *p) for i, p in enumerate(points.tolist(), 1))
        out.write("*ELEMENT, TYPE=C3D%d, ELSET=BODY\n" % tets.shape[1])
        out.writelines("%d, %s\n" % (i, ", ".join(map(str, t))) for i, t in enumerate((tets + 1).tolist(), 1))
        out.write("*MATERIAL, NAME=STEEL\n*ELASTIC\n%g, %g\n" % (YOUNG, POISSON))
        out.write("*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n*STEP\n*STATIC\n*BOUNDARY\n")
        for on, axes in problem.held:
            for node in np.flatnonzero(on(points)).tolist():
                out.writelines("%d, %d, %d, %.12g\n" % (node + 1, a + 1, a + 1, exact[node, a]) for a in axes)
        out.write("*CLOAD\n")
        for node, axis in np.argwhere(forces).tolist():
            out.write("%d, %d, %.12g\n" % (node + 1, axis + 1, forces[node, axis]))
        out.write("*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n")


def read_results(path, count):
    """{'DISP': (n, 3), 'STRESS': (n, 6)} from a .frd file."""
    results, target = {}, None
    with open(path) as lines:
        for line in lines:
            if line.startswith(" -4"):
                name, width = line.split()[1], {"DISP": 3, "STRESS": 6}
                target = results.setdefault(name, np.zeros((count, width[name]))) if name in width else None
            elif line.startswith(" -1") and target is not None:
                values = line[13:].rstrip("\n")
                row = [float(values[k : k + 12]) for k in range(0, 12 * target.shape[1], 12)]
                target[int(line[3:13]) - 1] = row
            elif line.startswith(" -3"):
                target = None
    return results


def errors(problem, points, tets):
    """(displacement, stress): root mean squares over the nodes, relative to the largest exact value."""
    with tempfile.TemporaryDirectory() as folder:
        write_input(os.path.join(folder, "job.inp"), problem, points, tets)
        done = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True)
        if done.returncode or "*ERROR" in done.stdout:
            raise RuntimeError(done.stdout[-500:])
        found = read_results(os.path.join(folder, "job.frd"), len(points))
    exact = problem.displacement(points)
    off = np.linalg.norm(found["DISP"] - exact, axis=1)
    watched = problem.watched(points)
    stress = problem.component(points, found["STRESS"])[watched] - problem.stress(points)[watched]
    return (
        np.sqrt((off**2).mean()) / np.linalg.norm(exact, axis=1).max(),
        np.sqrt((stress**2).mean()) / np.abs(problem.stress(points)).max(),
    )


def meshes(problem, order, size, rivals):
    """[(mesher, points, tets), ...] of one size."""
    shape = problem.shape()
    options = document.make_options(max_size=size, order=order, elements_per_circle=6)
    mesh = document.mesh_shape(shape, options)
    result = [("DelaunayMesher", mesh.points, mesh.tets)]
    if rivals:
        with tempfile.TemporaryDirectory() as folder:
            cad, output = os.path.join(folder, "part.brep"), os.path.join(folder, "mesh.npz")
            shape.exportBrep(cad)
            script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "gmsh_equal_nodes.py")
            command = [rivals, script, cad, str(order), str(len(mesh.points)), str(size), output]
            subprocess.run(command, check=True, capture_output=True)
            arrays = np.load(output)
            result.append(("Gmsh", arrays["points"], arrays["tets"]))
    return result


def study(rivals):
    """[(problem, order, mesher, nodes, displacement error, stress error), ...]."""
    rows = []
    for problem in PROBLEMS:
        for order in (1, 2):
            for size in problem.sizes:
                for mesher, points, tets in meshes(problem, order, size * order, rivals):
                    row = (problem.name, order, mesher, len(points), *errors(problem, points, tets))
                    rows.append(row)
                    print("%s, order %d, %s: %d nodes, %.3g %.3g" % row, flush=True)
    return rows


def write_table(rows, path):
    with open(path, "w") as out:
        out.write("| problem | order | mesher | nodes | displacement | stress |\n|---|---|---|---|---|---|\n")
        out.writelines(
            "| %s | %d | %s | %d | %.3g %% | %.3g %% |\n" % (*r[:4], 100 * r[4], 100 * r[5]) for r in rows
        )


def draw(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, len(PROBLEMS), figsize=(11, 6.5), sharex="col")
    for column, problem in enumerate(PROBLEMS):
        for line, (quantity, place) in enumerate((("displacement", 4), ("stress", 5))):
            plot = axes[line][column]
            for mesher, style in (("DelaunayMesher", "o-"), ("Gmsh", "s--")):
                for order, colour in ((1, "tab:orange"), (2, "tab:blue")):
                    mine = [r for r in rows if r[:3] == (problem.name, order, mesher)]
                    if mine:
                        label = "%s, order %d" % (mesher, order)
                        plot.loglog([r[3] for r in mine], [100 * r[place] for r in mine], style, color=colour)
                        plot.lines[-1].set_label(label)
            plot.grid(True, which="both", alpha=0.3)
            plot.set_title(problem.name if line == 0 else None)
            plot.set_xlabel("nodes" if line else None)
            if column == 0:
                plot.set_ylabel("error of the %s [%%]" % quantity)
    axes[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--plot", default="convergence.png")
    parser.add_argument("--table", default="convergence.md")
    parser.add_argument("--rivals", help="a Python that has gmsh")
    chosen = parser.parse_args()
    rows = study(chosen.rivals)
    write_table(rows, chosen.table)
    draw(rows, chosen.plot)


if __name__ == "__main__":
    main()
