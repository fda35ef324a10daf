"""Whether the compiled part is there, and what to do when it is not."""

import os
import platform
import sys

from .texts import tr

STABLE_SINCE = 12  # the wheel of Python 3.12 serves all later versions


def problem():
    """'' when the compiled part loads, else instructions for this very FreeCAD."""
    from .. import extension
    from ..errors import MeshError

    try:
        extension.load()
    except MeshError as error:
        return instructions(error)
    return ""


def instructions(error):
    """Text that tells how to get the compiled part."""
    from ..extension import COMPILED, REPOSITORY

    python = "%d.%d" % sys.version_info[:2]
    wheel = "delaunaymesher-...-cp3%d-....whl" % min(sys.version_info[1], STABLE_SINCE)
    lines = [
        tr("The compiled part of Delaunay Mesher could not be loaded."),
        "",
        tr("This FreeCAD uses Python %s on %s %s; the part has to be made for it.")
        % (python, platform.system(), platform.machine()),
        "",
        tr("On Debian, run in a terminal, then start FreeCAD again:"),
        "    bash '%s'" % os.path.join(REPOSITORY, "scripts", "setup.sh"),
        "",
        tr("Elsewhere, with a Python of this version and a C++ compiler:"),
        '    python%s -m pip install --upgrade --no-deps --target "%s" "%s"' % (python, COMPILED, REPOSITORY),
        tr("or without a compiler, with a wheel for this system instead of the last name: %s") % wheel,
        "",
        tr("Details: %s") % error.message,
    ]
    return "\n".join(lines)
