"""Gmsh's mesh of a BREP file with about a given number of nodes: FILE ORDER NODES FIRST_SIZE OUTPUT.npz

Run by convergence.py with a Python that has gmsh.  The output has points (n, 3) and tets (t, 4 | 10) in VTK
order.
"""

import sys

import gmsh
import numpy as np


def mesh(path, order, size):
    """(points, tets) at one size everywhere."""
    gmsh.clear()
    gmsh.model.occ.importShapes(path)
    gmsh.model.occ.synchronize()
    for option, value in (("MeshSizeMax", size), ("MeshSizeMin", size), ("ElementOrder", order)):
        gmsh.option.setNumber("Mesh." + option, value)
    gmsh.model.mesh.generate(3)
    tags, places, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    _, nodes = gmsh.model.mesh.getElementsByType(4 if order == 1 else 11)
    tets = row[nodes.astype(np.int64)].reshape(-1, 4 if order == 1 else 10)
    if order == 2:
        tets = tets[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]
    used, tets = np.unique(tets, return_inverse=True)
    return places.reshape(-1, 3)[used], tets.reshape(-1, 4 if order == 1 else 10)


def main():
    path, order, wanted, size, output = sys.argv[1], *map(float, sys.argv[2:5]), sys.argv[5]
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    best = None
    for _ in range(5):
        points, tets = mesh(path, int(order), size)
        if best is None or abs(len(points) - wanted) < abs(len(best[0]) - wanted):
            best = points, tets
        size *= (len(points) / wanted) ** (1 / 3)
    np.savez(output, points=best[0], tets=best[1])


if __name__ == "__main__":
    main()
