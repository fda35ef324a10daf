"""FreeCAD's own mesh refinement on our mesh object, for selected faces, edges and vertices."""

import FreeCADGui

from .commands import body_of, is_our_mesh
from .start_mesh import panel_is_open, show_error
from .texts import tr

SHARE_OF_SIZE = 3.0  # a refinement starts with the mesh's size divided by this


def refine(selection):
    """Make a refinement of the selected elements (of one part with a mesh object); its panel opens."""
    if panel_is_open():
        return
    chosen = [item for item in selection if item.HasSubObjects and not is_our_mesh(item.Object)]
    if len(chosen) != 1:
        show_error(tr("Select faces, edges or vertices of one part."))
        return
    part = chosen[0].Object
    meshes = meshes_of(part) or meshes_of(body_of(part))
    if not meshes:
        show_error(tr("This part has no mesh object yet. Use 'Mesh this solid' first."))
        return
    # The last feature of a body has the body's elements under the same names.
    meshed = meshes[0].Shape
    create(meshes[0], meshed if getattr(meshed, "Tip", None) == part else part, chosen[0].SubElementNames)


def meshes_of(part):
    """The mesh objects of ours that mesh this object."""
    return [item for item in part.Document.Objects if is_our_mesh(item) and item.Shape == part]


def create(mesh, part, names):
    """The refinement object, undoable; returns it."""
    import ObjectsFem

    document = mesh.Document
    document.openTransaction(tr("Mesh refinement"))
    refinement = ObjectsFem.makeMeshRegion(document, mesh, starting_size(mesh, part))
    refinement.References = [(part, list(names))]
    document.commitTransaction()
    document.recompute()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.getDocument(document.Name).setEdit(refinement.Name)
    return refinement


def starting_size(mesh, part):
    """A size to start from in mm."""
    from ..document import estimate
    from ..document.placement import own_shape

    size = mesh.MaxSize.Value or estimate.automatic_size(own_shape(part))
    return estimate.two_digits(size / SHARE_OF_SIZE)
