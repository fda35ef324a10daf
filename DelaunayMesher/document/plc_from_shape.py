"""CAD shape -> PLC: closed, oriented, labelled triangles with the exact geometry of every face and edge.

Idea: OCC's own tessellation closes where surface meshers that work in (u, v) fail, so it serves as the map;
the core puts every node on the exact surface.  Its deflection follows the wanted element size.  Precondition:
at least one solid.  Postcondition: the triangles enclose every solid; every segment is an edge of a triangle;
seams of closed surfaces are no segments (unless asked for).  Cost: 2 to 10 microseconds per triangle beside
OCC's own time. Limits: self-intersections are left to the core to find.
"""

import numpy as np
import Part

from ..errors import MeshError, entity_name, in_number
from ..sizing import AUTOMATIC_FRACTION
from .cad_elements import CadElements
from .closed import open_triangles, solid_volumes
from .filling import fill
from .sewing import free_edges
from .shape_plc import ShapePlc, face_names
from .sheets import part_sheets
from .stitching import stitch
from .tessellation import tessellate

LINEAR_SHARE = 0.02  # of the element size
WALL_SHARE = 0.1  # of the thickness of the thinnest solid
SMALLEST_SHARE = 0.08  # of the smallest size that the user gives anywhere
COARSEST, FINEST = 1.0 / 1250.0, 1.0 / 3000.0  # linear deflection over the diagonal; OCC is slow below
ANGULAR, FINEST_ANGULAR = 0.3, 0.15  # radians
OTHER = 0.1  # of a volume: more than facets change
PLACES = 3  # free edges whose place a message has
FLAT = 1e-14  # volume over the diagonal's cube: none but rounding
# Tried in turn until the triangles close: (factor on the linear, factor on the angular deflection).
ATTEMPTS = ((1.0, 1.0), (0.25, 0.7), (0.06, 0.4), (0.06, 4.0), (4.0, 1.6))


def plc_from_shape(shape, options=None, keep=()):
    """The Plc of a Part shape; see convert().  Raises MeshError (stage 'plc'), also when it needs several."""
    converted = convert(shape, options, keep)
    if len(converted.plcs) > 1:
        raise MeshError(
            "plc",
            "several_parts",
            "the shape has %d solids or groups of solids that share no face; convert() gives a PLC of each"
            % len(converted.plcs),
        )
    return converted.plcs[0]


def convert(shape, options=None, keep=()):
    """ShapePlc of a Part shape.

    options: a MeshOptions (max_size, elements_per_circle and the names in sizes are used) or None.
    keep: names of elements ('Edge3', 'Vertex1') that stay: seams and smooth vertices become features,
    tiny faces and edges are not absorbed.
    """
    check_solid(shape)
    keep = set(keep) | set(getattr(options, "sizes", None) or ())
    cad = CadElements(shape)
    if not np.isfinite(cad.diagonal):
        raise MeshError("plc", "not_finite", "the shape has no finite extent")
    linear, angular = deflections(cad.diagonal, options)
    tried = []
    for linear_factor, angular_factor in ATTEMPTS:
        mesh, fault = attempt(cad, linear * linear_factor, angular * angular_factor)
        if not fault:
            mesh = finer_for_walls(mesh, linear * linear_factor, angular)
            return outward_plc(mesh, cad.sides, keep, [])
        tried.append(Mended(mesh, fault))
        if tried[-1].clean or not shape.isValid():  # invalid: another tessellation will not mend it
            break
    best = min(tried, key=lambda mended: (mended.left, not mended.clean))
    mesh, sides, warnings = best.result(shape)
    return outward_plc(mesh, sides, keep, warnings + volume_warnings(mesh, sides))


def outward_plc(mesh, sides, keep, warnings):
    """ShapePlc of a closed tessellation, thin solids made thick again, all turned outward."""
    mesh = part_sheets(mesh, sides)
    return ShapePlc(mesh, outward(mesh, sides, warnings), keep, warnings)


def attempt(cad, linear, angular):
    """(Tessellation, fault): fault is None when the triangles enclose every solid."""
    mesh = tessellate(cad, linear, angular)
    return mesh, fault_of(mesh, cad.sides)


def fault_of(mesh, sides):
    """(rows of triangles, edges) that have no neighbour, or None."""
    rows, edges = open_triangles(mesh.triangles, sides[mesh.triangle_face], len(mesh.points))
    return (rows, edges) if len(rows) else None


class Mended:
    """A tessellation with gaps, mended: `left` open edges, `clean` if none and nothing crosses."""

    def __init__(self, mesh, fault):
        self.before, self.fault = mesh, fault
        mesh, sides = stitch(mesh, mesh.cad.sides)
        self.mesh, self.filled, clean = fill(mesh, sides)
        self.sides = sides
        self.still = fault_of(self.mesh, sides)
        self.left = len(self.still[0]) if self.still else 0
        self.clean = clean and not self.left

    def result(self, shape):
        """(Tessellation, sides, warnings); solids that are still open are left out if there are others."""
        mesh, sides, warnings = self.mesh, self.sides, []
        if self.filled:
            names = face_names(self.filled)
            warnings.append("OpenCASCADE left gaps in the triangles of %s; they were filled" % names)
        if self.still:
            broken = np.unique(sides[mesh.triangle_face[self.still[0]]])
            broken = broken[broken > 0]
            if len(broken) == len(mesh.cad.solids):
                raise open_shape(shape, self.before, *self.fault)
            names = ", ".join(entity_name(3, int(number)) for number in broken)
            warnings.append("%s left out: %s" % (names, open_shape(shape, mesh, *self.still).message))
            sides = np.where(np.isin(sides, broken), 0, sides)
        return mesh, sides, warnings


def volume_warnings(mesh, sides):
    """What to know about solids whose triangles do not enclose the volume that the CAD program gives them."""
    count = len(mesh.cad.solids)
    volumes = np.abs(solid_volumes(mesh.points, mesh.triangles, sides[mesh.triangle_face], count))
    return [
        "%s: its triangles enclose %.4g mm3, but the CAD program says %.4g mm3: a face of it is broken "
        "(Part: Check geometry)" % (entity_name(3, number), volume, wanted)
        for number, volume, solid in zip(range(1, count + 1), volumes.tolist(), mesh.cad.solids)
        for wanted in [abs(solid.Volume)]
        if (sides == number).any() and abs(volume - wanted) > OTHER * wanted
    ]


def finer_for_walls(mesh, linear, angular):
    """The Tessellation, again and finer when the facets of a thin curved wall might cross."""
    wanted = max(WALL_SHARE * thinnest(mesh), FINEST * mesh.cad.diagonal)
    if wanted < 0.8 * linear:
        finer, fault = attempt(mesh.cad, wanted, angular)
        if not fault:
            return finer
    return mesh


def thinnest(mesh):
    """Smallest mean thickness of a solid with curved faces: twice its volume over its surface (mm)."""
    sides = mesh.cad.sides[mesh.triangle_face]
    count = len(mesh.cad.solids)
    volumes = np.abs(solid_volumes(mesh.points, mesh.triangles, sides, count))
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    flat = np.array([isinstance(surface, Part.Plane) for surface in mesh.cad.surfaces])[mesh.triangle_face]
    surface = sum(np.bincount(side, weights=areas, minlength=count + 1)[1:] for side in sides.T)
    curved = sum(np.bincount(side[~flat], minlength=count + 1)[1:] for side in sides.T) > 0
    return (2.0 * volumes / np.maximum(surface, 1e-300))[curved].min(initial=np.inf)


def check_solid(shape):
    """Refuse what cannot be meshed whatever the tessellation."""
    if shape is None or shape.isNull():
        raise MeshError("plc", "null_shape", "the object has no shape; recompute it, or select another")
    if not shape.Solids:
        kind = shape.ShapeType.lower()
        edges = []
        if not shape.Faces:
            hint = "no faces; extrude or pad it (Part: Extrude, PartDesign: Pad)"
        elif shape.isClosed():
            hint = "faces: %d; they close, make a solid of them (Part: Convert to solid)" % len(shape.Faces)
        else:
            edges = free_edges(shape)
            hint = "faces: %d; close it%s and make a solid of it (Part: Convert to solid)" % (
                len(shape.Faces),
                near_edges(edges),
            )
        article = "an" if kind == "edge" else "a"
        text = "the shape is %s %s without a solid (%s)" % (article, kind, hint)
        raise MeshError("plc", "not_a_solid", text, place=middle(edges[0]) if edges else None)


def near_edges(edges):
    """' near (0, 0.5, 1), ...' with the places of the first edges, for a message."""
    if not edges:
        return ""
    places = ", ".join("(%.6g, %.6g, %.6g)" % tuple(middle(edge)) for edge in edges[:PLACES])
    return " near " + places + (", ... (%d free edges in all)" % len(edges) if edges[PLACES:] else "")


def middle(edge):
    """The point half way along the edge's range."""
    return edge.valueAt(0.5 * sum(edge.ParameterRange))


def deflections(diagonal, options):
    """(linear mm, angular rad): a share of the element size, finer for many elements per circle.

    Facets farther from a twisted face than a fraction of the elements on it make meshes that fold.
    """
    size = getattr(options, "max_size", None) or diagonal / AUTOMATIC_FRACTION
    per_circle = getattr(options, "elements_per_circle", None) or 0.0
    angular = min(ANGULAR, np.pi / per_circle) if per_circle > 0 else ANGULAR
    linear = min(LINEAR_SHARE * size, SMALLEST_SHARE * smallest_given(options, size), COARSEST * diagonal)
    return max(linear, FINEST * diagonal), max(angular, FINEST_ANGULAR)


def smallest_given(options, size):
    """The smallest of all sizes given for parts of the shape, and `size`."""
    if options is None:
        return size
    values = [] if options.size_values is None else options.size_values
    return min([size, *options.sizes.values(), *(region.size for region in options.regions), *values])


def outward(mesh, sides, warnings):
    """Sides with inside-out solids (negative volume) turned round, and solids without a volume left out."""
    count = len(mesh.cad.solids)
    volumes = solid_volumes(mesh.points, mesh.triangles, sides[mesh.triangle_face], count)
    present = np.isin(np.arange(1, count + 1), sides)
    flat = np.abs(volumes) <= FLAT * mesh.cad.diagonal**3
    if flat[present].all():
        name = entity_name(3, int(np.flatnonzero(present)[0]) + 1)
        raise MeshError("plc", "no_volume", "%s encloses no volume" % name, entity=name)
    for number in (np.flatnonzero(((volumes < 0.0) | flat) & present) + 1).tolist():
        name = entity_name(3, number)
        if flat[number - 1]:
            warnings.append("%s encloses no volume; it is left out" % name)
            sides = np.where(sides == number, 0, sides)
            continue
        warnings.append("%s is inside out (negative volume); it was turned round" % name)
        mine = (sides == number) & (sides[:, :1] != sides[:, 1:])
        flipped = np.where(mine[:, ::-1], number, np.where(mine, 0, sides))
        both = mine.any(axis=1) & (sides != 0).all(axis=1)
        if both.any():
            face = entity_name(2, int(np.flatnonzero(both)[0]))
            raise MeshError(
                "plc", "inside_out", "%s is inside out and shares %s" % (name, face), entity=name, other=face
            )
        sides = flipped
    return sides


def open_shape(shape, mesh, rows, edges):
    """The error for triangles that do not close."""
    faces = mesh.triangle_face[rows]
    name = entity_name(2, int(faces[0]))
    place = mesh.points[edges[0]].mean(axis=0)
    cause = (
        "the solid is not closed"
        if not all(solid.isClosed() for solid in shape.Solids)
        else "the solid has a gap"
    )
    if not shape.isValid():
        cause += " and the CAD program calls the shape invalid (Part: Check geometry)"
    return MeshError(
        "plc",
        "open_shell",
        in_number(
            "%s at %s: %d triangle edge(s) without a neighbour" % (cause, face_names(faces), len(rows))
        ),
        place=place,
        entity=name,
    )
