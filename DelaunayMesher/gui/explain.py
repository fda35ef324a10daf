"""Stages and errors in the words that the window uses."""

from .texts import tr

STAGES = {
    "options": "Options",
    "document": "FreeCAD",
    "extension": "Compiled part",
    "read": "Reading",
    "plc": "Reading the shape",
    "sizing": "Size field",
    "curves": "Curves",
    "surfaces": "Surfaces",
    "boundary": "Boundary recovery",
    "refinement": "Refinement",
    "optimisation": "Optimisation",
    "order": "Second order",
    "certificate": "Certificate",
    "write": "FEM mesh",
    "quality": "Quality figures",
    "kernel": "Triangulation",
    "check": "Check of the mesh",
    "view": "3D view",
    "solve": "CalculiX",
}


def stage_name(stage):
    """What people read for a stage of the pipeline."""
    return tr(STAGES.get(stage, stage))


def explain(error):
    """A MeshError for people: the stage by its name, options as the panel calls them."""
    return stage_name(error.stage) + with_labels(str(error)[len(error.stage) :])


def with_labels(text):
    """The text with the options as the panel calls them instead of the command line."""
    from ..options import OPTIONS

    for option in OPTIONS:
        text = text.replace("--" + option.name.replace("_", "-"), "\u201c%s\u201d" % tr(option.label))
    return text
