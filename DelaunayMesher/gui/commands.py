"""The commands: what each is called, when it can be used, what it does with the selection."""

import FreeCAD
import FreeCADGui

from .texts import icon, tr


class MeshSolid:
    """Make a mesh object for the selected solid or mesh of triangles and open its panel; on a mesh object,
    open its panel.
    """

    def GetResources(self):
        return {
            "Pixmap": icon("mesh_solid"),
            "MenuText": tr("Mesh this solid"),
            "ToolTip": tr(
                "Tetrahedral FEM mesh of the selected solid, or of a closed mesh of triangles, by Delaunay "
                "refinement. It goes into the active analysis, if there is one"
            ),
        }

    def IsActive(self):
        return selected_part() is not None or selected_mesh() is not None

    def Activated(self):
        from . import start_mesh

        mesh = selected_mesh()
        if mesh is not None:
            start_mesh.edit(mesh)
        else:
            start_mesh.create(selected_part())


class RefineFaces:
    """Make a FreeCAD mesh refinement on our mesh for the selected faces, edges or vertices."""

    def GetResources(self):
        return {
            "Pixmap": icon("refine_faces"),
            "MenuText": tr("Refine selected faces"),
            "ToolTip": tr(
                "Smaller elements at the selected faces, edges or vertices of a part that has a mesh object"
            ),
        }

    def IsActive(self):
        return has_elements()

    def Activated(self):
        from . import refine_faces

        refine_faces.refine(FreeCADGui.Selection.getSelectionEx())


class RefineHere:
    """Make a size region round a selected vertex or place."""

    def GetResources(self):
        return {
            "Pixmap": icon("size_region"),
            "MenuText": tr("Refine here"),
            "ToolTip": tr(
                "Smaller elements inside a sphere, box or cylinder round the selected vertex, or where the "
                "part was clicked"
            ),
        }

    def IsActive(self):
        return has_elements()

    def Activated(self):
        from . import refine_faces

        refine_faces.refine_here(FreeCADGui.Selection.getSelectionEx())


class GroupElements:
    """Make a FreeCAD mesh group of our mesh from the selected faces, edges or vertices."""

    def GetResources(self):
        return {
            "Pixmap": icon("mesh_group"),
            "MenuText": tr("Mesh group"),
            "ToolTip": tr(
                "A named group of the mesh at the selected faces, edges or vertices of a part that has a "
                "mesh object"
            ),
        }

    def IsActive(self):
        return has_elements()

    def Activated(self):
        from . import refine_faces

        refine_faces.group(FreeCADGui.Selection.getSelectionEx())


class ShowQuality:
    """Open the quality panel of the selected mesh object."""

    def GetResources(self):
        return {
            "Pixmap": icon("mesh_quality"),
            "MenuText": tr("Mesh quality"),
            "ToolTip": tr("Distribution of the dihedral angles and the worst elements of the selected mesh"),
        }

    def IsActive(self):
        mesh = selected_fem_mesh()
        return mesh is not None and mesh.FemMesh.VolumeCount > 0

    def Activated(self):
        from . import task_quality

        task_quality.open_panel(selected_fem_mesh())


class Fix:
    """FreeCAD's fixed constraint on the selected faces."""

    def GetResources(self):
        return {
            "Pixmap": icon("fix"),
            "MenuText": tr("Fix selected faces"),
            "ToolTip": tr(
                "A fixed constraint on the selected faces, edges or vertices. Without an active analysis one "
                "is made, with a solver, and steel as material"
            ),
        }

    def IsActive(self):
        return has_elements()

    def Activated(self):
        from . import load_case

        load_case.fix(FreeCADGui.Selection.getSelectionEx())


class Load:
    """FreeCAD's force constraint on the selected faces."""

    def GetResources(self):
        return {
            "Pixmap": icon("force"),
            "MenuText": tr("Force on selected faces"),
            "ToolTip": tr(
                "A force on the selected faces, edges or vertices. Without an active analysis one is made, "
                "with a solver, and steel as material"
            ),
        }

    def IsActive(self):
        return has_elements()

    def Activated(self):
        from . import load_case

        load_case.load(FreeCADGui.Selection.getSelectionEx())


class Solve:
    """Solve the analysis of a mesh object in its panel."""

    def GetResources(self):
        return {
            "Pixmap": icon("solve"),
            "MenuText": tr("Solve"),
            "ToolTip": tr(
                "Solve the analysis with CalculiX and show the stresses; meshes first if there is no mesh of "
                "the part and options as they are now"
            ),
        }

    def IsActive(self):
        return mesh_to_solve() is not None

    def Activated(self):
        from . import start_mesh

        start_mesh.solve(mesh_to_solve())


COMMANDS = {
    "DelaunayMesher_MeshSolid": MeshSolid(),
    "DelaunayMesher_RefineFaces": RefineFaces(),
    "DelaunayMesher_RefineHere": RefineHere(),
    "DelaunayMesher_Group": GroupElements(),
    "DelaunayMesher_Quality": ShowQuality(),
    "DelaunayMesher_Fix": Fix(),
    "DelaunayMesher_Force": Load(),
    "DelaunayMesher_Solve": Solve(),
}
NAMES = list(COMMANDS)
ANALYSIS = ("DelaunayMesher_Fix", "DelaunayMesher_Force", "DelaunayMesher_Solve")
MESHING = [name for name in NAMES if name not in ANALYSIS]
WITH_SHAPE = ("Part::Feature", "App::Part")
IN_FEM = MESHING  # FEM has its own for the rest


def register():
    """Make the commands known to FreeCAD."""
    for name, command in COMMANDS.items():
        FreeCADGui.addCommand(name, command)


def has_elements():
    """Whether faces, edges or vertices are selected."""
    return any(selection.HasSubObjects for selection in FreeCADGui.Selection.getSelectionEx())


def selected_objects():
    """The selected objects of the active document."""
    return FreeCADGui.Selection.getSelection() if FreeCAD.ActiveDocument else []


def is_our_mesh(item):
    """Whether a document object is a mesh object of this workbench."""
    return getattr(getattr(item, "Proxy", None), "Type", "") == "Fem::FemMeshDelaunay"


def selected_mesh():
    """The only selected mesh object of ours, or None."""
    meshes = [item for item in selected_objects() if is_our_mesh(item)]
    return meshes[0] if len(meshes) == 1 else None


def mesh_to_solve():
    """The selected mesh object of ours that is in an analysis, or the only one in the active analysis."""
    mesh = selected_mesh()
    if mesh is not None:
        in_analysis = any(user.isDerivedFrom("Fem::FemAnalysis") for user in mesh.InList)
        return mesh if in_analysis else None
    if FreeCAD.ActiveDocument is None:
        return None
    import FemGui

    analysis = FemGui.getActiveAnalysis()
    if analysis is None or analysis.Document != FreeCAD.ActiveDocument:
        return None
    meshes = [item for item in analysis.Group if is_our_mesh(item)]
    return meshes[0] if len(meshes) == 1 else None


def selected_fem_mesh():
    """The only selected FEM mesh, whoever made it, or None."""
    meshes = [item for item in selected_objects() if item.isDerivedFrom("Fem::FemMeshObject")]
    return meshes[0] if len(meshes) == 1 else None


def selected_part():
    """The only selected object with a shape or a mesh of triangles, or None.  Whether it can be meshed is
    found out later.
    """
    items = selected_objects()
    if len(items) != 1 or items[0].isDerivedFrom("Fem::FemMeshObject"):
        return None
    return body_of(items[0]) if is_part(items[0]) or items[0].isDerivedFrom("Mesh::Feature") else None


def body_of(item):
    """The body of a PartDesign feature (a click in the view selects the feature); else the item itself."""
    parent = item.getParentGeoFeatureGroup() if hasattr(item, "getParentGeoFeatureGroup") else None
    return parent if parent is not None and parent.isDerivedFrom("PartDesign::Body") else item


def is_part(item):
    """Whether an object has a shape: a feature, a body, a part container, or links to one."""
    linked = getattr(item, "LinkedObject", None)
    if linked is not None:
        return is_part(linked)
    if item.TypeId == "App::LinkGroup":
        return any(is_part(element) for element in item.ElementList)
    return any(item.isDerivedFrom(kind) for kind in WITH_SHAPE)
