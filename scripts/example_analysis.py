"""The main job from beginning to end: a CAD part becomes a solved FEM analysis.

    freecadcmd scripts/example_analysis.py

Meshes the bracket, fixes its foot, pulls at its bore, solves with CalculiX through FreeCAD's own tools, and
writes example_output/ (summary.txt, report.json, bracket.png, bracket_solved.FCStd).  The last line is
EXAMPLE OK when all went well: freecadcmd's exit status says nothing.
"""

import json
import os
import sys
import time
import traceback

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [ROOT, os.path.join(ROOT, "scripts")]

import FreeCAD  # noqa: E402
import numpy as np  # noqa: E402
import ObjectsFem  # noqa: E402
import Part  # noqa: E402

from DelaunayMesher import document  # noqa: E402
from DelaunayMesher.quality import dihedral_angles  # noqa: E402

OUTPUT = os.path.join(ROOT, "example_output")
MAX_SIZE = float(os.environ.get("EXAMPLE_SIZE", "5.0"))  # mm
FORCE = 8000.0  # N
BORE_RADIUS = 13.0


def open_part():
    """The bracket in a document of its own."""
    file = document.find_freecad().openDocument(os.path.join(ROOT, "resources", "examples", "bracket.FCStd"))
    return file, file.getObject("Bracket")


def face_names(part, wanted):
    """Names of the faces for which `wanted` holds."""
    return ["Face%d" % (i + 1) for i, face in enumerate(part.Shape.Faces) if wanted(face)]


def load_case(file, part):
    """A new analysis with a solver, steel, a fixed foot and a force on the bore along x."""
    analysis = ObjectsFem.makeAnalysis(file, "Analysis")
    document.add_solver(analysis).GeometricalNonlinearity = "linear"
    material = ObjectsFem.makeMaterialSolid(file, "Steel")
    card = material.Material
    card.update(Name="Steel", YoungsModulus="210000 MPa", PoissonRatio="0.30", Density="7900 kg/m^3")
    material.Material = card
    fixed = ObjectsFem.makeConstraintFixed(file, "Foot")
    fixed.References = [(part, name) for name in face_names(part, lambda f: f.BoundBox.ZMax < 1e-6)]
    force = ObjectsFem.makeConstraintForce(file, "Pull")
    bore = lambda f: isinstance(f.Surface, Part.Cylinder) and abs(f.Surface.Radius - BORE_RADIUS) < 1e-6  # noqa: E731
    force.References = [(part, name) for name in face_names(part, bore)]
    force.Force = FORCE if FreeCAD.Version()[0] == "0" else "%g N" % FORCE
    force.Direction = (part, face_names(part, lambda f: f.BoundBox.XMax < 1e-6)[:1])
    force.Reversed = True
    for item in (material, fixed, force):
        analysis.addObject(item)
    file.recompute()
    return analysis


def node_fields(result, count):
    """(displacement (n, 3), von Mises (n,)) in the order of our points."""
    rows = np.array(result.NodeNumbers) - 1
    moved, stress = np.zeros((count, 3)), np.zeros(count)
    moved[rows] = [tuple(vector) for vector in result.DisplacementVectors]
    stress[rows] = result.vonMises
    return moved, stress


def summary(mesh, angles, seconds, moved, stress):
    """What a reader wants to know, as lines."""
    quality = mesh.quality
    rows = [
        ("nodes", "%d" % len(mesh.points)),
        ("tetrahedra", "%d of order %d" % (len(mesh.tets), mesh.order)),
        (
            "worst dihedral angles",
            "%.2f and %.2f degrees" % (quality["min_dihedral"], quality["max_dihedral"]),
        ),
        ("smallest angle of a tetrahedron", "%.1f degrees (median)" % np.median(angles)),
        ("below the target angle", "%d" % len(mesh.below_target)),
        *((stage, "%.2f s" % taken) for stage, taken in seconds.items()),
        ("largest displacement", "%.5f mm" % np.linalg.norm(moved, axis=1).max()),
        ("largest von Mises stress", "%.1f MPa" % stress.max()),
        ("written to example_output/", "bracket.png  report.json  bracket_solved.FCStd"),
    ]
    return "\n".join("%-34s %s" % row for row in rows) + "\n"


def main():
    os.makedirs(OUTPUT, exist_ok=True)
    file, part = open_part()
    analysis = load_case(file, part)
    start = time.perf_counter()
    target = document.add_mesh(part, analysis=analysis, max_size=MAX_SIZE, order=2)
    mesh = document.run(target)
    seconds = {**mesh.seconds, "meshing in all": time.perf_counter() - start}
    start = time.perf_counter()
    result = document.solve(target)
    seconds["CalculiX"] = time.perf_counter() - start
    moved, stress = node_fields(result, len(mesh.points))
    angles = dihedral_angles(mesh.points, mesh.tets).min(axis=1)

    from example_picture import picture

    report = {
        **mesh.report(),
        "largest_displacement": float(np.linalg.norm(moved, axis=1).max()),
        "largest_von_mises": float(stress.max()),
    }
    with open(os.path.join(OUTPUT, "report.json"), "w", encoding="utf-8") as stream:
        json.dump(report, stream, indent=2)
    title = "Mounting bracket: %d tetrahedra of order 2, %.0f N on the bore" % (len(mesh.tets), FORCE)
    middle = part.Shape.BoundBox.Center.y
    cut = (np.array([0.0, middle, 0.0]), np.array([0.0, -1.0, 0.0]))
    picture(os.path.join(OUTPUT, "bracket.png"), mesh, angles, moved, stress, cut, title)
    file.saveAs(os.path.join(OUTPUT, "bracket_solved.FCStd"))
    with open(os.path.join(OUTPUT, "summary.txt"), "w", encoding="utf-8") as stream:
        stream.write(summary(mesh, angles, seconds, moved, stress))


try:
    main()
    print("\nEXAMPLE OK", flush=True)
except Exception:  # freecadcmd would run the script a second time
    traceback.print_exc()
    print("EXAMPLE FAILED", flush=True)
