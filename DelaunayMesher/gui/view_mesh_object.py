"""How the mesh object looks and behaves in the tree.

The class has to stay at the top of this module: saved documents find it by its name.
"""

import FreeCADGui

from ..document.stateless import Stateless
from .texts import icon, tr

CHILD_LISTS = {
    "Fem::MeshRegion": ("MeshRegionList", "MeshRefinementList"),
    "Fem::MeshGroup": ("MeshGroupList",),
    "Fem::MeshBoundaryLayer": ("MeshBoundaryLayerList",),
    "Fem::MeshSizeRegion": ("SizeRegionList",),
}
OTHER_REFINEMENTS = ("MeshRefinementList", "MeshRegionList")  # of later FreeCAD: distance, shape, ...


class VPMeshDelaunay(Stateless):
    """View provider proxy: icon, panel on double click, refinements and groups as children."""

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        self.ViewObject = view
        self.Object = view.Object

    def getIcon(self):
        return icon("mesh_object")

    def updateData(self, target, name):
        """An open panel shows the options and the figures that undo, redo or a script has brought."""
        panel = open_panel(target)
        if panel:
            panel.follow(name)

    def onChanged(self, view, name):
        """Nothing follows from view properties."""

    def setEdit(self, view, mode=0):
        from . import task_mesh_object

        if mode != 0:
            return None
        FreeCADGui.Control.showDialog(task_mesh_object.MeshPanel(view.Object))
        return True

    def unsetEdit(self, view, mode=0):
        FreeCADGui.Control.closeDialog()
        return True

    def doubleClicked(self, view):
        from . import start_mesh

        start_mesh.edit(view.Object)
        return True

    def setupContextMenu(self, view, menu):
        from . import start_mesh, task_quality

        menu.addAction(tr("Edit mesh")).triggered.connect(lambda *_: start_mesh.edit(view.Object))
        quality = menu.addAction(tr("Mesh quality"))
        quality.triggered.connect(lambda *_: task_quality.open_panel(view.Object))
        quality.setEnabled(view.Object.FemMesh.VolumeCount > 0)

    def claimChildren(self):
        children = []
        for names in CHILD_LISTS.values():
            for name in names:
                children += [item for item in getattr(self.Object, name, ()) if item not in children]
        return children

    def onDelete(self, view, subelements):
        """Refinements and groups mean nothing without their mesh: ask."""
        children = self.claimChildren()
        if not children:
            return True
        from PySide import QtGui

        text = tr("These objects refer to the mesh and would lose it:")
        text += "\n\n" + "\n".join(item.Label for item in children)
        text += "\n\n" + tr("Delete the mesh all the same?")
        box = QtGui.QMessageBox
        answer = box.warning(
            FreeCADGui.getMainWindow(), tr("Delaunay Mesher"), text, box.Yes | box.No, box.No
        )
        return answer == box.Yes

    def canDragObjects(self):
        return True

    def canDropObjects(self):
        return True

    def canDragObject(self, item):
        return bool(list_name(self.Object, item))

    def canDropObject(self, item):
        return bool(list_name(self.Object, item))

    def dragObject(self, view, item):
        """Take a child out of every list it is in."""
        for names in CHILD_LISTS.values():
            for name in names:
                held = getattr(self.Object, name, [])
                if item in held:
                    setattr(self.Object, name, [other for other in held if other != item])

    def dropObject(self, view, item):
        """Put an object into the list for its kind."""
        name = list_name(self.Object, item)
        if name and item not in getattr(self.Object, name):
            setattr(self.Object, name, getattr(self.Object, name) + [item])


def open_panel(target):
    """The panel that edits this mesh object at the moment, or None."""
    edited = FreeCADGui.getDocument(target.Document.Name).getInEdit()
    if edited is None or edited.Object != target:
        return None
    from . import task_mesh_object

    return task_mesh_object.MeshPanel.current


def list_name(mesh, item):
    """Name of the property of `mesh` that holds objects like `item`; None when none does."""
    kind = getattr(getattr(item, "Proxy", None), "Type", "")
    names = CHILD_LISTS.get(kind)
    if names is None:
        refines = kind.startswith("Fem::Mesh") and hasattr(item, "References")
        names = OTHER_REFINEMENTS if refines else ()
    return next((name for name in names if hasattr(mesh, name)), None)
