"""Refinements and groups of our mesh object from a selection: FreeCAD's own for faces, edges and vertices,
and a size region round a selected place.
"""

import FreeCADGui

from .commands import is_our_mesh
from .guards import undo_step
from .start_mesh import panel_is_open, show_error, show_status
from .texts import tr

SIZES_TO_RADIUS = 3.0  # radius of a new size region in its sizes
SHARE_OF_SIZE = 3.0  # a refinement starts with the mesh's size divided by this


def refine(selection):
    """Make a refinement of the selected elements (of one part with a mesh object); its panel opens."""
    create(selection, tr("Mesh refinement"), new_refinement)


def group(selection):
    """Make a mesh group of the selected elements, likewise."""
    create(selection, tr("Mesh group"), new_group)


def refine_here(selection):
    """Make a size region round a selected vertex, or where something was clicked; its panel opens."""
    if panel_is_open():
        return
    chosen, mesh = selected_elements(selection)
    if mesh is None:
        return
    from ..document.size_region import add_size_region
    from ..sizing import Region

    size = starting_size(mesh, mesh.Shape)
    document = mesh.Document
    with undo_step(document, tr("Size region")):
        place = place_of(chosen, mesh.Shape)
        region = add_size_region(mesh, Region.ball(place, SIZES_TO_RADIUS * size, size))
    edit(region, mesh, chosen.Object)


def place_of(chosen, part):
    """The selected place in the coordinates of the mesh."""
    from ..document.placement import mesh_frame, shape_to_mesh
    from ..document.references import find_element

    name = chosen.SubElementNames[0]
    if name.startswith("Vertex"):
        shape = shape_to_mesh(part)
        return shape.getElement(find_element(chosen.Object, name, part, shape)).Point
    return mesh_frame(part).inverse().multVec(chosen.PickedPoints[0])


def selected_elements(selection):
    """(the selection of faces, edges or vertices of one part, its mesh object); the user is told when there
    is none, and the mesh object is None then.
    """
    chosen = [item for item in selection if item.HasSubObjects and not is_our_mesh(item.Object)]
    if len(chosen) != 1:
        show_error(tr("Select faces, edges or vertices of one part."))
        return None, None
    meshes = meshes_of(chosen[0].Object)
    if not meshes:
        show_error(tr("This part has no mesh object yet. Use 'Mesh this solid' first."))
        return None, None
    return chosen[0], wanted_mesh(meshes, selection)


def meshes_of(part):
    """The mesh objects of ours for this object, then those for the body and containers that it is in."""
    meshes = []
    while part is not None:
        meshes += [item for item in part.Document.Objects if is_our_mesh(item) and item.Shape == part]
        part = part.getParentGeoFeatureGroup()
    return meshes


def wanted_mesh(meshes, selection):
    """Of several: one that is selected too, or else is in the active analysis, or else the first."""
    from ..document.mesh_object import active_analysis

    selected = [item.Object for item in selection]
    analysis = active_analysis(meshes[0].Document)
    analysed = analysis.Group if analysis else []
    return max(meshes, key=lambda mesh: (mesh in selected, mesh in analysed))


def create(selection, title, new):
    """Let new(mesh object, part) refer to the selected elements, as one step to undo; its panel opens."""
    if panel_is_open():
        return
    chosen, mesh = selected_elements(selection)
    if mesh is None:
        return
    # The last feature of a body has the body's elements under the same names.
    part, document = chosen.Object, mesh.Document
    part = mesh.Shape if getattr(mesh.Shape, "Tip", None) == part else part
    with undo_step(document, title):
        made = new(mesh, part)
        made.References = [(part, list(chosen.SubElementNames))]
    edit(made, mesh, chosen.Object)


def edit(made, mesh, part):
    """Open the panel of what was made; the status bar says whose it is when the part has several meshes."""
    document = made.Document
    document.recompute()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.getDocument(document.Name).setEdit(made.Name)
    count = len(meshes_of(part))
    if count > 1:
        text = tr("%s belongs to %s, one of %d meshes of this part; it can be dragged to another")
        show_status(text % (made.Label, mesh.Label, count))


def new_refinement(mesh, part):
    """FreeCAD's mesh refinement."""
    import ObjectsFem

    return ObjectsFem.makeMeshRegion(mesh.Document, mesh, starting_size(mesh, part))


def new_group(mesh, part):
    """FreeCAD's mesh group."""
    import ObjectsFem

    return ObjectsFem.makeMeshGroup(mesh.Document, mesh)


def starting_size(mesh, part):
    """A size to start from in mm."""
    from ..document import estimate
    from ..document.placement import own_shape

    size = mesh.MaxSize.Value or estimate.automatic_size(own_shape(part))
    return estimate.two_digits(size / SHARE_OF_SIZE)
