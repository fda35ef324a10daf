"""FreeCAD's own supports and forces for selected faces; analysis, solver and material are made by the way."""

import FreeCADGui

from .commands import body_of
from .guards import undo_step
from .start_mesh import panel_is_open, show_error
from .texts import tr

STEEL = {"YoungsModulus": "210000 MPa", "PoissonRatio": "0.30", "Density": "7900 kg/m^3"}
FORCE = 1000.0  # N to start from


def fix(selection):
    """A fixed constraint on the selected faces, edges or vertices."""
    make(selection, "makeConstraintFixed", tr("Fixed faces"))


def load(selection):
    """A force on the selected faces, edges or vertices; FreeCAD's panel asks how large it is."""
    force = make(selection, "makeConstraintForce", tr("Force on faces"))
    if force is not None:
        force.Force = "%g N" % FORCE if hasattr(force.Force, "Unit") else FORCE
        FreeCADGui.getDocument(force.Document.Name).setEdit(force.Name)


def make(selection, maker, title):
    """The constraint, as one step to undo; None when there is nothing to put it on (the user is told)."""
    references = references_of(selection)
    if panel_is_open():
        return None
    if not references:
        show_error(tr("Select faces, edges or vertices of one part."))
        return None
    if any(item.isDerivedFrom("App::Link") for item, _ in references):  # before 1.0 it ends FreeCAD
        show_error(tr("FreeCAD cannot put loads and supports on links. Mesh and load a copy instead."))
        return None
    import ObjectsFem

    document = references[0][0].Document
    with undo_step(document, title):
        analysis = complete_analysis(document)
        constraint = getattr(ObjectsFem, maker)(document)
        constraint.References = references
        analysis.addObject(constraint)
        document.recompute()
    FreeCADGui.Selection.clearSelection()
    return constraint


def references_of(selection):
    """[(part, element names), ...] of what is selected; the last feature of a body stands for the body."""
    references = []
    for item in selection:
        if item.HasSubObjects and not item.Object.isDerivedFrom("Fem::FemMeshObject"):
            body = body_of(item.Object)
            part = body if getattr(body, "Tip", None) == item.Object else item.Object
            references.append((part, tuple(item.SubElementNames)))
    return references


def complete_analysis(document):
    """The active analysis with a solver and a material; what is missing is made."""
    import FemGui
    import ObjectsFem

    from ..document.calculix import add_solver
    from ..document.mesh_object import active_analysis

    analysis = active_analysis(document)
    if analysis is None:
        analysis = ObjectsFem.makeAnalysis(document, "Analysis")
        FemGui.setActiveAnalysis(analysis)
    if not any(item.isDerivedFrom("Fem::FemSolverObject") for item in analysis.Group):
        add_solver(analysis)
    if not any(item.isDerivedFrom("App::MaterialObjectPython") for item in analysis.Group):
        steel = ObjectsFem.makeMaterialSolid(document, "Material")
        steel.Material = {**steel.Material, **STEEL, "Name": "Steel"}
        steel.Label = tr("Steel (assumed)")
        analysis.addObject(steel)
    return analysis
