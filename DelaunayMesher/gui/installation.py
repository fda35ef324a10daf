"""Whether the compiled part is there, and what to do when it is not."""

import os
import platform
import sys

from .texts import RESOURCES, tr


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
    folder = os.path.dirname(RESOURCES)
    python = "%d.%d" % sys.version_info[:2]
    lines = [
        tr("The compiled part of Delaunay Mesher could not be loaded."),
        "",
        tr("This FreeCAD uses Python %s on %s %s; the part has to be made for it.")
        % (python, platform.system(), platform.machine()),
        "",
        tr("On Debian, run in a terminal, then start FreeCAD again:"),
        "    bash '%s'" % os.path.join(folder, "scripts", "setup.sh"),
        "",
        tr(
            "Elsewhere, install the wheel for this Python and this system into a folder beside the workbench:"
        ),
        "    python -m pip install --no-deps --target '%s-core' DelaunayMesher-...-cp%s-....whl"
        % (folder, python.replace(".", "")),
        "",
        tr("Details: %s") % error.message,
    ]
    return "\n".join(lines)
