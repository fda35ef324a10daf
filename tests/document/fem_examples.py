"""FreeCAD's own FEM examples with our mesh in place of theirs, solved by CalculiX.

Each example has one quantity to compare and a reference that owes nothing to our meshes: a formula, or the
number that another mesher's fine mesh gives (`source` says which; benchmarks/fem_examples.py makes these
numbers again).  The examples' own mesh objects are replaced before anything is solved.
"""

import os
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, Callable, Dict, Sequence

import FreeCAD
import numpy as np
from femtools.ccxtools import FemToolsCcx

from DelaunayMesher import document
from DelaunayMesher.sizing import Region

GRAVITY = 9810.0  # mm/s^2, as FreeCAD writes it


@dataclass
class Solution:
    """points (n, 3) and displacements (n, 3) in mm of the last increment or first mode; frequencies in Hz."""

    points: np.ndarray
    displacements: np.ndarray
    frequencies: Sequence[float] = ()


def largest_displacement(solution):
    return np.linalg.norm(solution.displacements, axis=1).max()


def upright_frequencies(solution):
    """Modes 1, 3 and 4; mode 2 is sideways, and how firmly an edge holds a beam then depends on the mesh."""
    return np.array(solution.frequencies)[[0, 2, 3]]


def ovalisation(solution):
    """How much a ring becomes an ellipse: amplitude of cos 2 phi in the radial displacement of all its nodes.

    Rigid motions do not count; they depend on the mesh where a part is held at one edge.
    """
    x, y, z = solution.points.T
    angle, radius = np.arctan2(y, x), np.hypot(x, y)
    radial = (solution.displacements[:, 0] * x + solution.displacements[:, 1] * y) / radius
    waves = [np.ones_like(x)] + [wave(n * angle) for n in (1, 2, 3, 4) for wave in (np.cos, np.sin)]
    height = z / np.ptp(z)
    terms = np.linalg.lstsq(np.stack([w * h for w in waves for h in (1.0, height)], 1), radial, rcond=None)[0]
    return terms[6]


def cantilever():
    """Timoshenko's beam: 8 m, 1 m x 1 m, 9 MN at the end."""
    length, side, force, young, poisson = 8000.0, 1000.0, 9e6, 210000.0, 0.3
    shear = young / (2 * (1 + poisson))
    return force * length**3 / (3 * young * side**4 / 12) + force * length / (5 / 6 * shear * side**2)


def hinged_beam():
    """Timoshenko's beam: 3 m, 50 mm high, hinged at both ends; one, two and three half waves in Hz."""
    length, height, young, density, poisson = 3000.0, 50.0, 200000.0, 7.9e-9, 0.3
    wave, gyration = np.array([1, 2, 3]) * np.pi / length, height**2 / 12
    rigid = wave**4 * young * gyration / density
    softer = 1 + wave**2 * gyration * (1 + 2 * (1 + poisson) / (5 / 6))
    return np.sqrt(rigid / softer) / (2 * np.pi)


def own_weight():
    """Timoshenko's beam: 32 m, 1 m x 1 m of steel."""
    length, side, young, poisson = 32000.0, 1000.0, 210000.0, 0.3
    load, shear = 7.9e-9 * GRAVITY * side**2, young / (2 * (1 + poisson))
    return load * length**4 / (8 * young * side**4 / 12) + load * length**2 / (2 * 5 / 6 * shear * side**2)


def twisted_tube():
    """Saint-Venant's torsion of a tube, radii 4 and 5 mm, by shear spread evenly over the outside."""
    length, inner, outer, force, shear = 50.0, 4.0, 5.0, 2500.0, 210000.0 / 2.6
    polar = np.pi / 2 * (outer**4 - inner**4)
    return force * outer * length / (2 * shear * polar) * outer


@dataclass(frozen=True)
class Example:
    """`names`: of the module, in older and newer versions of FreeCAD.  size in mm: `options` refine it."""

    names: Sequence[str]
    size: float
    reference: Any
    source: str
    quantity: Callable[[Solution], Any] = largest_displacement
    options: Dict[str, Any] = field(default_factory=dict)
    gmsh_size: float = 0.0  # of the mesh that gave the reference
    newer: Any = None  # (reference, source) from FreeCAD 1.0 on, where the example has another load

    def expected(self):
        """The reference for the FreeCAD that runs."""
        return self.newer[0] if self.newer and FreeCAD.Version()[0] != "0" else self.reference


EXAMPLES = {
    example.names[0]: example
    for example in (
        Example(["ccx_cantilever_faceload"], 500.0, cantilever(), "Timoshenko"),
        Example(["boxanalysis_static"], 1.5, 0.09551, "Gmsh", gmsh_size=0.7),
        Example(
            ["constraint_contact_solid_solid"],
            20.0,
            0.02389,
            "Gmsh",
            gmsh_size=10.0,
            newer=(29.77, "stored mesh"),
        ),
        Example(["constraint_section_print"], 8.0, 9.825, "Gmsh", gmsh_size=4.0),
        Example(["thermomech_bimetall", "thermomech_bimetal"], 2.5, 5.703, "Gmsh", gmsh_size=1.2),
        Example(["frequency_beamsimple"], 50.0, hinged_beam(), "Timoshenko", upright_frequencies),
        Example(["material_multiple_bendingbeam_fiveboxes"], 3.0, 1.0386, "Gmsh", gmsh_size=1.5),
        Example(["constraint_selfweight_cantilever"], 500.0, own_weight(), "Timoshenko"),
        Example(["constraint_tie"], 80.0, -0.2397, "Gmsh", ovalisation, gmsh_size=40.0),
        Example(["constraint_transform_torque"], 2.0, twisted_tube(), "Saint-Venant"),
        Example(
            ["material_nl_platewithhole"],
            20.0,
            1.732,
            "20-node bricks",
            options={"regions": [Region.box((-60, -100, 0), (60, 100, 10), 7.0)]},
        ),
    )
}


def open_example(name):
    """(document, its mesh object, its part) of an example; the document is to be closed."""
    for module in EXAMPLES[name].names:
        try:
            setup = import_module("femexamples." + module).setup
            break
        except ImportError:
            continue
    else:
        raise ImportError("this FreeCAD has none of the examples %s" % (EXAMPLES[name].names,))
    file = setup(solvertype="ccxtools")
    mesh = next(item for item in file.Analysis.Group if item.isDerivedFrom("Fem::FemMeshObject"))
    return file, mesh, getattr(mesh, "Part", None) or mesh.Shape


def replace_mesh(file, old, part, size, **regions):
    """Our mesh of second order in the analysis instead of the example's; returns its document object."""
    mesh = document.add_mesh(part, analysis=file.Analysis, max_size=size, order=2)
    file.Analysis.removeObject(old)
    file.removeObject(old.Name)
    document.run(mesh, **regions)
    return mesh


def write_input(file, folder):
    """FemToolsCcx that has written CalculiX's input into an existing folder."""
    solver = next(item for item in file.Analysis.Group if item.isDerivedFrom("Fem::FemSolverObjectPython"))
    tool = FemToolsCcx(file.Analysis, solver)
    tool.update_objects()
    tool.setup_working_dir(str(folder))
    tool.setup_ccx()
    problems = tool.check_prerequisites()
    if problems:
        raise RuntimeError(problems)
    tool.purge_results()
    tool.write_inp_file()
    return tool


def solve(file, mesh, folder):
    """Solution of the analysis with the mesh that is in it; RuntimeError when CalculiX finds none."""
    os.makedirs(str(folder), exist_ok=True)
    tool = write_input(file, folder)
    tool.ccx_run()
    tool.load_results()
    results = [item for item in file.Analysis.Group if item.isDerivedFrom("Fem::FemResultObject")]
    if not results or not results[-1].DisplacementVectors:
        raise RuntimeError("CalculiX found no result: see %s" % folder)
    nodes = mesh.FemMesh.Nodes
    first = results[0] if results[0].EigenmodeFrequency else results[-1]
    return Solution(
        np.array([tuple(nodes[number]) for number in first.NodeNumbers]),
        np.array([tuple(vector) for vector in first.DisplacementVectors]),
        [item.EigenmodeFrequency for item in results],
    )


def solve_with_our_mesh(name, folder, size=None):
    """(quantity, mesh summary) of an example."""
    example = EXAMPLES[name]
    file, old, part = open_example(name)
    try:
        mesh = replace_mesh(file, old, part, size or example.size, **example.options)
        return example.quantity(solve(file, mesh, folder)), mesh.FemMesh.NodeCount
    finally:
        FreeCAD.closeDocument(file.Name)
