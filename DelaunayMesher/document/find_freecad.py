"""Makes FreeCAD's modules importable from a plain Python.

Inside FreeCAD (GUI or FreeCADCmd) nothing has to be done.  From a plain ``python3`` the folder that holds
``FreeCAD.so`` is looked for: the environment variable ``FREECAD_LIB``, then the usual places of the packages.
"""

import glob
import importlib
import os
import sys

from ..errors import MeshError

PLACES = (
    "/usr/lib/freecad-python3/lib",
    "/usr/lib/freecad/lib",
    "/usr/lib64/freecad/lib",
    "/usr/lib/freecad-daily/lib",
    "/usr/local/lib/freecad/lib",
    "/opt/freecad/lib",
    "/Applications/FreeCAD.app/Contents/Resources/lib",
    "C:/Program Files/FreeCAD*/bin",
)


def candidates():
    """Folders that may hold FreeCAD's Python modules, most wanted first."""
    patterns = [os.environ["FREECAD_LIB"]] if os.environ.get("FREECAD_LIB") else []
    patterns += [os.path.join(sys.prefix, "lib"), *PLACES]
    for pattern in patterns:
        for folder in sorted(glob.glob(pattern), reverse=True):
            if glob.glob(os.path.join(glob.escape(folder), "FreeCAD.*")):
                yield folder


def find_freecad():
    """Import and return the module ``FreeCAD``; MeshError (stage 'document') when there is none."""
    if "FreeCAD" in sys.modules:
        return sys.modules["FreeCAD"]
    try:
        return add_workbenches(importlib.import_module("FreeCAD"))
    except ImportError:
        pass
    reasons = []
    for folder in candidates():
        if folder not in sys.path:
            sys.path.append(folder)
        try:
            return add_workbenches(importlib.import_module("FreeCAD"))
        except ImportError as error:
            sys.path.remove(folder)
            reasons.append("%s: %s" % (folder, error))
    tried = "; ".join(reasons) if reasons else "no folder with FreeCAD's modules was found"
    raise MeshError(
        "document",
        "no_freecad",
        "CAD files and .FCStd, .med or .unv output need FreeCAD (%s). Install it, or set FREECAD_LIB to the "
        "folder that holds its modules." % tried,
    )


def add_workbenches(freecad):
    """Make the Python modules of FreeCAD's workbenches importable, as FreeCAD itself does when it starts."""
    for base in (freecad.getResourceDir(), freecad.getHomePath()):
        modules = os.path.join(base, "Mod")
        workbenches = sorted(glob.glob(os.path.join(glob.escape(modules), "*")))
        for folder in (os.path.join(base, "Ext"), *workbenches, modules):
            if os.path.isdir(folder) and folder not in sys.path:
                sys.path.append(folder)
    return freecad
