"""The compiled core, loaded on first use."""

import importlib.util
import os
import sys
from importlib.machinery import PathFinder

from . import __version__
from .errors import MeshError

NAME = "DelaunayMesher._core"
REPOSITORY = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
COMPILED = os.path.join(REPOSITORY, "compiled")  # not on sys.path: the package in there has no window


def load():
    """The module DelaunayMesher._core; MeshError telling what to do when it is missing or does not load.

    A clone comes without its compiled part, which is then taken from a wheel of the same version, installed
    into the clone's folder `compiled` or elsewhere on sys.path.
    """
    try:
        from . import _core
    except ImportError as error:
        _core = _load_from_wheel()
        if _core is None:
            raise MeshError(
                "extension",
                "no_extension",
                "the compiled part of DelaunayMesher is missing or was built for another Python (%s). "
                "In %s run 'bash scripts/setup.sh', or, with FreeCAD's version of Python, "
                "'python -m pip install --upgrade --no-deps --target compiled .'" % (error, REPOSITORY),
            ) from None
    return _core


def _load_from_wheel():
    """The core of another copy of this package, or None."""
    if NAME in sys.modules:
        return sys.modules[NAME]
    for folder in (COMPILED, *sys.path):
        spec = PathFinder.find_spec(NAME, [os.path.join(folder, "DelaunayMesher")])
        if spec is None or spec.loader is None:
            continue
        try:
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
        except ImportError:  # built for another Python
            continue
        if module.__version__ == __version__:
            sys.modules[NAME] = module
            return module
    return None
