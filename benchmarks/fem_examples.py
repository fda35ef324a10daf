"""FreeCAD's FEM examples with our mesh, with the mesh they ship and with Gmsh's, as a Markdown table.

    python3 benchmarks/fem_examples.py [--examples NAME ...] [--meshes ours stored gmsh]

Needs FreeCAD and CalculiX.  "gmsh" makes the references again that come from a fine mesh of Gmsh's: FreeCAD
calls Gmsh itself, so `gmsh` must be on the PATH.
"""

import argparse
import os
import sys
import tempfile

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [ROOT, os.path.join(ROOT, "tests", "document")]

from DelaunayMesher import document  # noqa: E402  finds FreeCAD

document.find_freecad()

import FreeCAD  # noqa: E402
from fem_examples import EXAMPLES, open_example, replace_mesh, solve  # noqa: E402


def make_mesh(kind, name, example, file, old, part):
    """The mesh object to solve with."""
    if kind == "ours":
        return replace_mesh(file, old, part, example.size, **example.options)
    if kind == "gmsh":
        from femmesh.gmshtools import GmshTools

        old.CharacteristicLengthMax = example.gmsh_size or example.size
        old.ElementOrder = "2nd"
        problem = GmshTools(old).create_mesh()
        if problem:
            print("%s: Gmsh says %s" % (name, problem.strip()[:200]), file=sys.stderr)
    return old


def run(kind, name):
    """(number of nodes, quantity) of an example with one kind of mesh."""
    example = EXAMPLES[name]
    file, old, part = open_example(name)
    try:
        mesh = make_mesh(kind, name, example, file, old, part)
        with tempfile.TemporaryDirectory() as folder:
            return mesh.FemMesh.NodeCount, example.quantity(solve(file, mesh, folder))
    except RuntimeError as error:
        return 0, str(error)[:60]
    finally:
        FreeCAD.closeDocument(file.Name)


def row(kind, name):
    example = EXAMPLES[name]
    nodes, value = run(kind, name)
    if isinstance(value, str):
        return "| %s | %s | - | no result: %s | - | |" % (name, kind, value)
    reference = np.atleast_1d(example.expected())
    off = 100 * np.abs(np.atleast_1d(value) / reference - 1).max()
    shown = " ".join("%.5g" % number for number in np.atleast_1d(value))
    source = "%s %s" % (" ".join("%.5g" % number for number in reference), example.source)
    return "| %s | %s | %d | %s | %s | %.2f %% |" % (name, kind, nodes, shown, source, off)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--examples", nargs="+", default=list(EXAMPLES), choices=list(EXAMPLES))
    parser.add_argument("--meshes", nargs="+", default=["ours"], choices=["ours", "stored", "gmsh"])
    chosen = parser.parse_args()
    rows = ["| example | mesh | nodes | value | reference | off |", "|---|---|---|---|---|---|"]
    for name in chosen.examples:
        rows += [row(kind, name) for kind in chosen.meshes]
        print(rows[-len(chosen.meshes) :], flush=True, file=sys.stderr)
    print("\n".join(rows))


if __name__ == "__main__":
    main()
