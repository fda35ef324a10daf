"""Ours, Gmsh's HXT and Netgen on one CAD file, one thread, each timed alike, for the benchmarks beside this.

Time is that of meshing alone: ours from the CAD solid in memory to the finished arrays, a rival's with its
geometry loaded.
"""

import math
import os
import sys
import time
from collections import namedtuple

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [ROOT]
PER_CIRCLE = 12
OURS, PLAIN, HXT, NETGEN = "ours", "ours, not optimised", "Gmsh HXT", "Netgen"

# points (n, 3) float64, tets (m, 4) int64, seconds on the wall and of the processor, seconds per stage (ours)
Run = namedtuple("Run", "points tets wall processor stages")


def timed(function):
    """(what the function returns, seconds on the wall, seconds of the processor)"""
    start = time.perf_counter(), time.process_time()
    result = function()
    return result, time.perf_counter() - start[0], time.process_time() - start[1]


def run_ours(path, size, optimise):
    """A Run of this project's mesher."""
    import DelaunayMesher
    from DelaunayMesher import document, extension

    shape = document.read_shape(path)
    extension.load()
    options = document.make_options(
        max_size=size, elements_per_circle=PER_CIRCLE, threads=1, optimise=optimise
    )
    mesh, wall, processor = timed(lambda: DelaunayMesher.mesh(shape, options))
    return Run(mesh.points, mesh.tets, wall, processor, mesh.seconds)


def run_hxt(path, size):
    """A Run of Gmsh with its HXT algorithm and the same size settings."""
    import gmsh

    gmsh.initialize()
    settings = {
        "General.Terminal": 0,
        "General.NumThreads": 1,
        "Mesh.MeshSizeMax": size,
        "Mesh.MeshSizeFromCurvature": PER_CIRCLE,
        "Mesh.Algorithm3D": 10,
    }
    for name, value in settings.items():
        gmsh.option.setNumber(name, value)
    gmsh.model.occ.importShapes(path)
    gmsh.model.occ.synchronize()
    _, wall, processor = timed(lambda: gmsh.model.mesh.generate(3))
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    index[tags.astype(np.int64)] = np.arange(len(tags))
    tets = index[gmsh.model.mesh.getElementsByType(4)[1].astype(np.int64)].reshape(-1, 4)
    return Run(coordinates.reshape(-1, 3), tets, wall, processor, {})


def run_netgen(path, size):
    """A Run of Netgen: largest size and elements per radian, all else as Netgen has it."""
    from netgen.occ import OCCGeometry

    geometry = OCCGeometry(path)
    curvature = PER_CIRCLE / (2 * math.pi)
    mesh, wall, processor = timed(lambda: geometry.GenerateMesh(maxh=size, curvaturesafety=curvature))
    points = np.array([point.p for point in mesh.Points()])
    tets = np.array([[vertex.nr - 1 for vertex in element.points] for element in mesh.Elements3D()])
    return Run(points, tets[:, [1, 0, 2, 3]], wall, processor, {})  # its tetrahedra are mirrored


def run(mesher, path, size):
    """A Run of OURS, PLAIN, HXT or NETGEN."""
    rivals = {HXT: run_hxt, NETGEN: run_netgen}
    return rivals[mesher](path, size) if mesher in rivals else run_ours(path, size, mesher == OURS)
