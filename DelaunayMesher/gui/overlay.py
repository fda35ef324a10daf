"""Elements drawn into the 3D view beside FreeCAD's own objects: a cut through the mesh, a chosen element."""

import FreeCADGui
import numpy as np
from pivy import coin

from ..errors import MeshError
from .colours import palette, quality_scale, stored_colour
from .texts import tr

COLOURS = 64


class Overlay:
    """A branch of the scene of one view; remove() takes it away again.  MeshError without a 3D view."""

    def __init__(self, document):
        self.view = view_of(document)
        self.root = coin.SoSeparator()
        self.surface = coin.SoSeparator()
        self.chosen = coin.SoAnnotation()  # drawn over everything, or an inner element would not be seen
        for node in (self.surface, self.chosen):
            self.root.addChild(node)
        self.view.getSceneGraph().addChild(self.root)

    def remove(self):
        self.view.getSceneGraph().removeChild(self.root)

    def show_surface(self, points, faces, shares, stops=None, with_edges=True):
        """Faces (f, 3) coloured by shares (f,) in 0..1, as quality unless `stops` says otherwise."""
        self.surface.removeAllChildren()
        if not len(faces):
            return
        colours = coin.SoMaterial()
        colours.diffuseColor.setValues(0, COLOURS, palette(COLOURS, stops or quality_scale()))
        binding = coin.SoMaterialBinding()
        binding.value = coin.SoMaterialBinding.PER_FACE_INDEXED
        used, compact = np.unique(faces, return_inverse=True)
        shape = coin.SoIndexedFaceSet()
        rows = with_ends(compact.reshape(-1, 3))
        shape.coordIndex.setValues(0, len(rows), rows)
        index = np.clip(np.nan_to_num(shares) * COLOURS, 0, COLOURS - 1).astype(int).tolist()
        shape.materialIndex.setValues(0, len(index), index)
        offset = coin.SoPolygonOffset()
        for node in (coordinates(points[used]), colours, binding, flat(), offset, shape):
            self.surface.addChild(node)
        if with_edges:
            self.surface.addChild(edges(compact.reshape(-1, 3), (0.1, 0.1, 0.1), 1))

    def show_chosen(self, corners):
        """One element, corners (4, 3), over everything else; None for none."""
        self.chosen.removeAllChildren()
        if corners is None:
            return
        faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
        material = coin.SoMaterial()
        material.diffuseColor = colour = stored_colour("ColourChosen")
        material.transparency = 0.5
        shape = coin.SoIndexedFaceSet()
        rows = with_ends(faces)
        shape.coordIndex.setValues(0, len(rows), rows)
        for node in (coordinates(corners), material, shape, edges(faces, colour, 3)):
            self.chosen.addChild(node)

    def zoom(self, centre, size):
        """Look at a place from the present direction, `size` mm high."""
        camera = self.view.getCameraNode()
        direction = camera.orientation.getValue().multVec(coin.SbVec3f(0, 0, -1)).getValue()
        away = 10.0 * size
        if hasattr(camera, "height"):
            camera.height = size
        else:
            away = size / (2.0 * np.tan(camera.heightAngle.getValue() / 2.0))
        camera.position.setValue(*(np.asarray(centre) - away * np.array(direction)))
        camera.focalDistance = away


def view_of(document):
    """The document's 3D view: the active one, or the first when a spreadsheet or a drawing is active."""
    window = FreeCADGui.getDocument(document.Name)
    views = [window.ActiveView, *window.mdiViewsOfType("Gui::View3DInventor")]
    found = next((view for view in views if hasattr(view, "getSceneGraph")), None)
    if found is None:
        text = tr("%s has no 3D view to draw into; open one in the menu View") % document.Label
        raise MeshError("view", "no_view", text)
    return found


def coordinates(points):
    """Coordinates node of points (n, 3)."""
    node = coin.SoCoordinate3()
    node.point.setValues(0, len(points), np.asarray(points, dtype=float).tolist())
    return node


def with_ends(faces):
    """Flat list of corner numbers, each polygon ended by -1."""
    return np.hstack([faces, np.full((len(faces), 1), -1)]).ravel().tolist()


def edges(faces, colour, width):
    """The edges of triangles, as a branch that uses the coordinates before it."""
    pairs = np.unique(np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    branch = coin.SoSeparator()
    style = coin.SoDrawStyle()
    style.lineWidth = width
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    base = coin.SoBaseColor()
    base.rgb = colour
    lines = coin.SoIndexedLineSet()
    rows = with_ends(pairs)
    lines.coordIndex.setValues(0, len(rows), rows)
    one_colour = coin.SoMaterialBinding()
    one_colour.value = coin.SoMaterialBinding.OVERALL
    for node in (style, light, one_colour, base, lines):
        branch.addChild(node)
    return branch


def flat():
    """Facets lit from both sides, not smoothed."""
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.creaseAngle = 0.0
    return hints
