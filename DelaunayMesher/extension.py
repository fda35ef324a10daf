"""The compiled core, loaded on first use."""

from .errors import MeshError


def load():
    """The module DelaunayMesher._core; MeshError telling what to do when it is missing or does not load."""
    try:
        from . import _core
    except ImportError as error:
        raise MeshError(
            "extension",
            "no_extension",
            "the compiled part of DelaunayMesher is missing or was built for another Python (%s). Run 'bash "
            "scripts/setup.sh' in the repository, or install a wheel with 'pip install DelaunayMesher'"
            % error,
        ) from None
    return _core
