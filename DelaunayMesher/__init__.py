"""Tetrahedral meshes of CAD solids, for finite element analysis.

    import DelaunayMesher
    mesh = DelaunayMesher.mesh("part.step", max_size=2.0, order=2)
    mesh.write("part.inp")

Lengths in mm, angles in degrees. Importing this needs neither FreeCAD nor the compiled core.
"""

import importlib

__version__ = "0.1.0"

_WHERE = {
    "MeshOptions": "options",
    "Region": "sizing",
    "Mesh": "result",
    "Plc": "plc",
    "MeshError": "errors",
    "InputError": "errors",
    "MeshCancelled": "errors",
}

__all__ = ["__version__", "delaunay", "mesh", *_WHERE]


def __getattr__(name):
    if name not in _WHERE:
        raise AttributeError("module 'DelaunayMesher' has no attribute %r" % name)
    value = getattr(importlib.import_module("." + _WHERE[name], __name__), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *_WHERE})


def mesh(source, options=None, report=None, **overrides):
    """Tetrahedral Mesh of `source`: a Part shape, a Plc, a file name, or (points, triangles) of a closed
    surface.

    options: MeshOptions or None; overrides: single options on top, mesh(shape, max_size=2.0, order=2).
    report: callable (stage, fraction) -> bool, False cancels. Raises MeshError with the stage, place and
    CAD element; InputError (a MeshError) for wrong options and unreadable files; MeshCancelled.
    """
    from .options import make_options
    from .pipeline import run

    return run(source, make_options(options, **overrides), report)


def delaunay(points, threads=1):
    """Delaunay triangulation (t, 4) int32 of points (n, 3) float64, all positively oriented (VTK order).

    Exact predicates; cospherical points are resolved by symbolic perturbation. Of equal points the later ones
    belong to no tetrahedron. Raises MeshError when all points lie in one plane or are not finite.
    """
    import numpy as np

    from . import extension
    from .errors import MeshError

    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError("kernel", "bad_array", "points must be (n, 3), not %s" % (points.shape,))
    if not np.isfinite(points).all():
        raise MeshError("kernel", "not_finite", "a point has a coordinate that is no number")
    return extension.load().delaunay(points, int(threads))
