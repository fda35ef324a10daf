"""CAD shape -> PLC: closed, oriented, labelled triangles with the exact geometry of every face and edge.

Idea: OCC's own tessellation closes where surface meshers that work in (u, v) fail, so it serves as the map;
the core puts every node on the exact surface.  Its deflection follows the wanted element size.  Precondition:
at least one solid.  Postcondition: the triangles enclose every solid; every segment is an edge of a triangle;
seams of closed surfaces are no segments (unless asked for).  Cost: 2 to 10 microseconds per triangle beside
OCC's own time. Limits: touching solids must have equal faces where they touch; self-intersections are left to
the core to find.
"""

from dataclasses import dataclass, replace

import numpy as np
import Part

from ..errors import MeshError, entity_name
from ..plc import Plc
from ..sizing import AUTOMATIC_FRACTION
from .closed import open_triangles, solid_volumes
from .edge_geometry import edge_records
from .face_geometry import SPHERE, TORUS, face_records, seam_is_smooth
from .tessellation import face_sides, tessellate
from .touching import (
    Aliases,
    merge_coincident_faces,
    merge_coincident_segments,
    segments_on_triangles,
)

LINEAR_SHARE = 0.02  # of the element size
WALL_SHARE = 0.1  # of the thickness of the thinnest solid
COARSEST, FINEST = 1.0 / 500.0, 1.0 / 3000.0  # linear deflection as shares of the diagonal; OCC is slow below
ANGULAR, FINEST_ANGULAR = 0.3, 0.15  # radians
# Tried in turn until the triangles close: (factor on the linear, factor on the angular deflection).
ATTEMPTS = ((1.0, 1.0), (0.25, 0.7), (0.06, 0.4), (4.0, 1.6))


@dataclass
class ShapePlc:
    """A PLC and its aliases: CAD elements whose triangles another element carries (dropped -> kept)."""

    plc: Plc
    aliases: Aliases


def plc_from_shape(shape, options=None, keep=()):
    """The Plc of a Part shape; see convert().  Raises MeshError (stage 'plc')."""
    return convert(shape, options, keep).plc


def convert(shape, options=None, keep=()):
    """ShapePlc of a Part shape.

    options: a MeshOptions (max_size, elements_per_circle and the names in sizes are used) or None.
    keep: names of seam edges and smooth vertices ('Edge3', 'Vertex1') that shall stay features.
    """
    check_solid(shape)
    keep = set(keep) | set(getattr(options, "sizes", None) or ())
    linear, angular = deflections(shape, options)
    faults = None
    for linear_factor, angular_factor in ATTEMPTS:
        mesh, sides, fault = attempt(shape, linear * linear_factor, angular * angular_factor)
        if not fault:
            return assemble(*finer_for_walls(shape, mesh, sides, linear * linear_factor, angular), keep)
        faults = faults or (mesh, *fault)
        if not shape.isValid():  # another tessellation will not mend it
            break
    raise open_shape(shape, *faults)


def attempt(shape, linear, angular):
    """(Tessellation, sides (F, 2), fault): fault is None when the triangles enclose every solid."""
    mesh = tessellate(shape, linear, angular)
    sides = face_sides(mesh.faces, mesh.shape.Solids)
    rows, edges = open_triangles(mesh.triangles, sides[mesh.triangle_face], len(mesh.points))
    return mesh, sides, (rows, edges) if len(rows) else None


def finer_for_walls(shape, mesh, sides, linear, angular):
    """(Tessellation, sides): again and finer when the facets of a thin curved wall might cross."""
    wall = thinnest(mesh, sides)
    wanted = max(WALL_SHARE * wall, FINEST * shape.BoundBox.DiagonalLength)
    if wanted < 0.8 * linear:
        finer, finer_sides, fault = attempt(shape, wanted, angular)
        if not fault:
            return finer, finer_sides
    return mesh, sides


def thinnest(mesh, sides):
    """Smallest mean thickness of a solid with curved faces: twice its volume over its surface (mm)."""
    sides = sides[mesh.triangle_face]
    count = len(mesh.shape.Solids)
    volumes = np.abs(solid_volumes(mesh.points, mesh.triangles, sides, count))
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    flat = np.array([isinstance(face.Surface, Part.Plane) for face in mesh.faces])[mesh.triangle_face]
    surface = sum(np.bincount(side, weights=areas, minlength=count + 1)[1:] for side in sides.T)
    curved = sum(np.bincount(side[~flat], minlength=count + 1)[1:] for side in sides.T) > 0
    return (2.0 * volumes / np.maximum(surface, 1e-300))[curved].min(initial=np.inf)


def check_solid(shape):
    """Refuse what cannot be meshed whatever the tessellation."""
    if shape is None or shape.isNull():
        raise MeshError("plc", "null_shape", "the object has no shape; recompute it, or select another")
    if not shape.Solids:
        kind = shape.ShapeType.lower()
        hint = (
            "its faces close: make a solid of it" if shape.isClosed() else "close it and make a solid of it"
        )
        raise MeshError(
            "plc",
            "not_a_solid",
            "the shape is a %s without a solid (%d faces); %s (Part: Convert to solid)"
            % (kind, len(shape.Faces), hint),
        )
    bounds = shape.BoundBox
    if not bounds.isValid() or not np.isfinite(bounds.DiagonalLength):
        raise MeshError("plc", "not_finite", "the shape has no finite extent")


def deflections(shape, options):
    """(linear mm, angular rad): a share of the element size, finer for many elements per circle."""
    diagonal = shape.BoundBox.DiagonalLength
    size = getattr(options, "max_size", None) or diagonal / AUTOMATIC_FRACTION
    per_circle = getattr(options, "elements_per_circle", None) or 0.0
    angular = min(ANGULAR, np.pi / per_circle) if per_circle > 0 else ANGULAR
    linear = min(max(LINEAR_SHARE * size, FINEST * diagonal), COARSEST * diagonal)
    return linear, max(angular, FINEST_ANGULAR)


def assemble(mesh, sides, keep):
    """ShapePlc from a closed tessellation."""
    warnings = []
    sides = outward(mesh, sides, warnings)
    aliases = Aliases()
    loose = (sides[mesh.triangle_face] == 0).all(axis=1)
    if loose.any():
        names = face_names(mesh.triangle_face[loose])
        warnings.append("faces that belong to no solid are left out: %s" % names)
    triangles, triangle_face, face_solids = merge_coincident_faces(
        mesh.triangles[~loose], mesh.triangle_face[~loose], sides, mesh.points, aliases
    )
    tolerances = [position_tolerance(face) for face in mesh.faces]
    kinds, params, spline, surfaces, doubtful = face_records(mesh.faces, mesh.face_nodes, tolerances)
    if doubtful:
        warnings.append("no exact surface for %s: its facets are used" % face_names(doubtful))
    seam, corner = features(mesh, kinds, keep)
    curve_kinds, curve_params, curve_spline, curves, _ = edge_records(mesh.edges, wanted_edges(mesh, seam))

    live = ~seam[mesh.segment_edge] & segments_on_triangles(mesh.segments, triangles, len(mesh.points))
    segments, segment_edge = merge_coincident_segments(mesh.segments[live], mesh.segment_edge[live], aliases)
    corners, corner_vertex = corner_points(mesh.vertex_point, corner, triangles, aliases)
    plc = Plc(
        points=mesh.points,
        triangles=triangles,
        triangle_face=triangle_face,
        segments=segments,
        segment_edge=segment_edge,
        corners=corners,
        corner_vertex=corner_vertex,
        face_solids=face_solids,
        edge_count=len(mesh.edges),
        vertex_count=len(mesh.vertex_point),
        solid_count=len(mesh.shape.Solids),
        geometry={
            "face_kind": kinds,
            "face_params": params,
            "face_spline": spline,
            "edge_kind": curve_kinds,
            "edge_params": curve_params,
            "edge_spline": curve_spline,
            "spline_surfaces": surfaces,
            "spline_curves": curves,
        },
        warnings=warnings,
    )
    return ShapePlc(drop_unused_points(plc), aliases)


def outward(mesh, sides, warnings):
    """Sides with inside-out solids (negative volume) turned round."""
    count = len(mesh.shape.Solids)
    volumes = solid_volumes(mesh.points, mesh.triangles, sides[mesh.triangle_face], count)
    for number in np.flatnonzero(volumes <= 0.0) + 1:
        name = entity_name(3, int(number))
        if volumes[number - 1] == 0.0:
            raise MeshError("plc", "no_volume", "%s encloses no volume" % name, entity=name)
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


def position_tolerance(face):
    """How far (mm) tessellation nodes may lie off the surface: as far as the face's own edges do."""
    return max(1e-7, 2.0 * face.getTolerance(1, Part.Edge), 2.0 * face.getTolerance(1, Part.Vertex))


def features(mesh, kinds, keep):
    """(E,) bool: smooth seams to be dropped; (V,) bool: vertices that are features."""
    seam = np.zeros(len(mesh.edges), dtype=bool)
    sharp_tip = set()
    for number, face in mesh.seam_faces.items():
        smooth = mesh.edge_faces[number] == [face] and seam_is_smooth(
            mesh.edges[number], mesh.faces[face], kinds[face]
        )
        seam[number] = smooth and entity_name(1, number) not in keep
    tips = np.zeros(len(mesh.vertex_point), dtype=bool)
    touched = np.zeros(int(mesh.vertex_point.max(initial=-1)) + 1, dtype=bool)
    dropped = np.isin(mesh.segment_edge, np.flatnonzero(seam))
    ends = mesh.segments[~dropped].reshape(-1)
    touched[ends[ends < len(touched)]] = True
    for number, edge in enumerate(mesh.edges):
        if edge.Degenerated and not all(kinds[face] in (SPHERE, TORUS) for face in mesh.edge_faces[number]):
            sharp_tip.add(edge.Vertexes[0].hashCode())
    seams_only = ~touched[mesh.vertex_point]
    for number, vertex in enumerate(mesh.shape.Vertexes):
        tips[number] = vertex.hashCode() in sharp_tip or entity_name(0, number) in keep
    return seam, ~seams_only | tips


def wanted_edges(mesh, seam):
    """(E,) bool: edges that need their curve."""
    wanted = np.zeros(len(mesh.edges), dtype=bool)
    wanted[mesh.segment_edge] = True
    return wanted & ~seam


def corner_points(vertex_point, is_feature, triangles, aliases):
    """(corners, corner_vertex): one vertex per point; vertices that coincide become aliases."""
    used = np.isin(vertex_point, triangles.reshape(-1)) & is_feature
    vertices = np.flatnonzero(used)
    corners, first, inverse = np.unique(vertex_point[vertices], return_index=True, return_inverse=True)
    for vertex, kept in zip(vertices.tolist(), vertices[first][inverse.reshape(-1)].tolist()):
        if vertex != kept:
            aliases.vertices[vertex] = kept
    return corners, vertices[first]


def drop_unused_points(plc):
    """The same PLC with points that no triangle uses left out."""
    used, compact = np.unique(plc.triangles, return_inverse=True)
    return replace(
        plc,
        points=plc.points[used],
        triangles=compact.reshape(-1, 3),
        segments=np.searchsorted(used, plc.segments),
        corners=np.searchsorted(used, plc.corners),
    )


def face_names(faces):
    """'Face1, Face7, ... (12 in all)' for a message."""
    numbers = sorted({int(face) for face in faces})
    text = ", ".join(entity_name(2, number) for number in numbers[:5])
    return text if len(numbers) <= 5 else "%s, ... (%d in all)" % (text, len(numbers))


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
        "%s at %s: %d triangle edges have no neighbour" % (cause, face_names(faces), len(rows)),
        place=place,
        entity=name,
    )
