"""The FreeCAD side: CAD shapes in, FEM mesh objects out.  Needs FreeCAD, never its window.

from DelaunayMesher import document
mesh = document.add_mesh(part, max_size=5.0, order=2)
document.run(mesh)
"""

from ..options import make_options
from .find_freecad import find_freecad

find_freecad()

from .calculix import add_solver, solve  # noqa: E402
from .fcstd import write_fcstd  # noqa: E402
from .femmesh import fem_mesh  # noqa: E402
from .mesh_object import add_mesh, mesh_shape, run  # noqa: E402
from .plc_from_shape import convert, plc_from_shape  # noqa: E402
from .read_shape import read_shape  # noqa: E402
from .size_region import add_size_region  # noqa: E402

__all__ = [
    "add_mesh",
    "add_size_region",
    "add_solver",
    "convert",
    "fem_mesh",
    "find_freecad",
    "make_options",
    "mesh_shape",
    "plc_from_shape",
    "read_shape",
    "run",
    "solve",
    "write_fcstd",
]
