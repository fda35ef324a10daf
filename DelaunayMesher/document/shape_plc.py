"""A closed tessellation -> PLCs: one for each group of solids that share something.

Solids that touch on equal faces share an interface.  Solids that share nothing go into different PLCs, which
are meshed one after the other: their meshes do not fit together where they touch.  All PLCs count faces,
edges and vertices as the whole shape does.
"""

import numpy as np
import Part
from FreeCAD import Vector

from ..errors import entity_name
from ..overlaps import find_overlaps, places_inside, size_of
from ..plc import Plc
from .edge_geometry import edge_records
from .face_geometry import SPHERE, TORUS, face_records, seam_is_smooth
from .touching import (
    find_contacts,
    groups_of_solids,
    merge_coincident_segments,
    merge_equal_faces,
    segments_on_triangles,
    solid_pairs,
)

NAMED = 5  # elements named in a message
DEPTH = 1e-3  # of the smaller one's diagonal: what solids that merely touch may lie in each other
SAME = 1e-6  # of the diagonal or volume: difference between equal solids
BOX = ("XMin", "YMin", "ZMin", "XMax", "YMax", "ZMax")


class ShapePlc:
    """The PLCs of a shape, in `plcs`."""

    def __init__(self, mesh, sides, keep, warnings):
        """mesh: a Tessellation that encloses its solids; sides (F, 2); keep: names of elements that stay."""
        self.mesh, self.sides = mesh, sides
        self.kept = {kind: numbers_of(keep, kind) for kind in ("Vertex", "Edge", "Face")}
        self.contacts = find_contacts(mesh, sides)
        self.geometry = Geometry(mesh, self.kept)
        self.kept_edges = edges_that_stay(mesh, self.kept)
        groups = groups_of_solids(mesh.cad, sides, self.contacts)
        groups = [[solid for solid in group if (sides == solid).any()] for group in groups]
        groups = [group for group in groups if group]  # without the solids that were left out
        self.plcs = [self.plc_of(group) for group in groups]
        warnings = [*warnings, *self.geometry.warnings]
        loose = (sides[mesh.triangle_face] == 0).all(axis=1)
        if loose.any():
            names = face_names(mesh.triangle_face[loose])
            warnings.append("faces that belong to no solid are left out: %s" % names)
        if len(groups) > 1:
            overlapping = overlapping_solids(mesh, sides, groups)
            touching = [
                (first, second)
                for first, second in self.contacts.pairs()
                if not {tuple(sorted(pair)) for pair in solid_pairs(sides, first, second)} <= set(overlapping)
            ]
            warnings += apart_warnings(mesh.cad.solids, touching, overlapping)
        self.plcs[0].warnings[:0] = warnings

    @property
    def plc(self):
        """The first PLC: the only one, unless there are solids that share nothing."""
        return self.plcs[0]

    def apart(self, plc):
        """Replace a PLC by one for each of its solids, those that share a face together; [] if it is one."""
        solids = plc.solid_numbers.tolist()
        group = {solid: solid for solid in solids}
        for a, b in self.sides[(self.sides > 0).all(axis=1)].tolist():
            if a in group and b in group and group[a] != group[b]:
                old, new = group[b], group[a]
                group = {solid: new if number == old else number for solid, number in group.items()}
        numbers = sorted(set(group.values()))
        if len(numbers) == 1:
            return []
        pieces = [self.plc_of([s for s in solids if group[s] == number]) for number in numbers]
        place = next(index for index, item in enumerate(self.plcs) if item is plc)
        self.plcs[place : place + 1] = pieces
        return pieces

    def plc_of(self, solids):
        """The Plc of some solids (1-based numbers)."""
        mesh, cad = self.mesh, self.mesh.cad
        local = np.zeros(len(cad.solids) + 1, dtype=np.int64)
        local[solids] = np.arange(1, len(solids) + 1)
        here, sides, same_faces = merge_equal_faces(self.contacts.equal, local[self.sides])
        mine = (here & sides.any(axis=1))[mesh.triangle_face] & ~self.contacts.folded
        triangles, triangle_face = mesh.triangles[mine], mesh.triangle_face[mine]
        used = np.zeros(len(mesh.points), dtype=bool)
        used[triangles] = True
        compact = np.cumsum(used) - 1
        segments, segment_edge, same_edges = self.segments_of(triangles, used)
        corners, corner_vertex, same_vertices = corner_points(
            mesh.vertex_point, self.geometry.corner & used[mesh.vertex_point]
        )
        return Plc(
            points=mesh.points[used],
            triangles=compact[triangles],
            triangle_face=triangle_face,
            segments=compact[segments],
            segment_edge=segment_edge,
            corners=compact[corners],
            corner_vertex=corner_vertex,
            face_solids=sides,
            edge_count=len(cad.edges),
            vertex_count=len(cad.vertices),
            solid_count=len(solids),
            geometry=self.geometry.of(triangle_face, segment_edge),
            solid_numbers=np.array(solids),
            cad_solid_count=len(cad.solids),
            kept_faces=[same_faces.get(n, n) for n in self.kept["Face"] if n < len(cad.faces)],
            kept_edges=[same_edges.get(n, n) for n in self.kept_edges],
            aliases={"Face": same_faces, "Edge": same_edges, "Vertex": same_vertices},
        )

    def segments_of(self, triangles, used):
        """(segments (k, 2), their edges, merged edges) along triangles, whose points are `used`."""
        mesh = self.mesh
        live = ~self.geometry.seam[mesh.segment_edge] & used[mesh.segments].all(axis=1)
        segments, segment_edge = mesh.segments[live], mesh.segment_edge[live]
        live = segments_on_triangles(segments, triangles, len(mesh.points))
        return merge_coincident_segments(segments[live], segment_edge[live])


class Geometry:
    """Exact faces and edges of a tessellated shape, and which of its edges and vertices are features."""

    def __init__(self, mesh, kept):
        """kept: {'Vertex', 'Edge', 'Face': 0-based numbers of elements that stay}."""
        cad = mesh.cad
        tolerances = [position_tolerance(face) for face in cad.faces]
        self.faces = face_records(cad, mesh.face_nodes, tolerances)
        self.warnings = []
        if self.faces.doubtful:
            names = face_names(self.faces.doubtful)
            self.warnings.append("no exact surface for %s: its facets are used" % names)
        self.seam, self.corner = features(mesh, self.faces.kinds, kept)
        self.edges = edge_records(cad.edges, wanted_edges(mesh, self.seam))

    def of(self, faces, edges):
        """The dict of the core with the splines of some faces and edges only."""
        kinds, spline, surfaces = only(self.faces, faces)
        curve_kinds, curve_spline, curves = only(self.edges, edges)
        return {
            "face_kind": kinds,
            "face_params": self.faces.params,
            "face_spline": spline,
            "edge_kind": curve_kinds,
            "edge_params": self.edges.params,
            "edge_spline": curve_spline,
            "spline_surfaces": surfaces,
            "spline_curves": curves,
        }


def only(records, used):
    """(kinds, spline, splines) of the used ones of FaceRecords or EdgeRecords; the kind of the others is 0,
    which needs no record."""
    here = np.zeros(len(records.kinds), dtype=bool)
    here[used] = True
    kinds = np.where(here, records.kinds, 0).astype(np.int32)
    wanted = np.where(here, records.spline, -1)
    numbers = np.unique(wanted[wanted >= 0])
    renumbered = np.where(wanted >= 0, np.searchsorted(numbers, wanted), -1).astype(np.int32)
    return kinds, renumbered, [records.splines[number] for number in numbers.tolist()]


def numbers_of(names, kind):
    """0-based numbers, ascending, of the elements of a kind among some names ('Face3', 'Edge1')."""
    endings = [name[len(kind) :] for name in names if name.startswith(kind)]
    return sorted({int(ending) - 1 for ending in endings if ending.isdecimal() and int(ending) > 0})


def edges_that_stay(mesh, kept):
    """0-based numbers, ascending, of the edges kept: with a vertex all that meet there."""
    vertices = [number for number in kept["Vertex"] if number < len(mesh.vertex_point)]
    ends = np.isin(mesh.segments, mesh.vertex_point[vertices]).any(axis=1)
    edges = [number for number in kept["Edge"] if number < len(mesh.cad.edges)]
    return sorted({*edges, *mesh.segment_edge[ends].tolist()})


def overlapping_solids(mesh, sides, groups):
    """[(solid, other solid), ...] (1-based) of different groups that have volume in common."""
    solids = np.array([solid for group in groups for solid in group])
    group = np.repeat(np.arange(len(groups)), [len(group) for group in groups])
    bodies = [mesh.points[outward_triangles(mesh, sides, solid)] for solid in solids.tolist()]
    found = set()
    for inner, outer, places, _ in find_overlaps(bodies, group[:, None] == group, deep_places, DEPTH):
        numbers = solids[[inner, outer]].tolist()
        depth = DEPTH * min(size_of(bodies[inner]), size_of(bodies[outer]))
        pair, both = tuple(sorted(numbers)), [mesh.cad.solids[number - 1] for number in numbers]
        if pair not in found and have_common(*both, places, depth):
            found.add(pair)
    return sorted(found)


def deep_places(body):
    """Places of a body to look at, farther inside than have_common() asks for."""
    return places_inside(body, 3.0 * DEPTH * size_of(body))


def have_common(inner, outer, places, depth):
    """Whether one of some places in or on the CAD solid `inner` lies deeper than that in `outer`: triangles
    of both lie in each other a little where round faces touch."""
    return any(
        outer.isInside(Vector(*place), depth, False) and inner.isInside(Vector(*place), depth, True)
        for place in places.tolist()
    )


def are_same(one, other):
    """Whether two CAD solids have the same box, volume and centre."""
    box, its = one.BoundBox, other.BoundBox
    near = SAME * box.DiagonalLength
    return (
        all(abs(getattr(box, name) - getattr(its, name)) <= near for name in BOX)
        and abs(one.Volume - other.Volume) <= SAME * abs(one.Volume)
        and one.CenterOfMass.distanceToPoint(other.CenterOfMass) <= near
    )


def outward_triangles(mesh, sides, solid):
    """(k, 3) triangles of a solid, pointing out of it."""
    behind, front = (sides[mesh.triangle_face] == solid).T
    return np.concatenate([mesh.triangles[behind], mesh.triangles[front][:, ::-1]])


def apart_warnings(solids, touching, overlapping):
    """What to know about solids that are meshed apart: pairs of faces that touch, and of solids that have
    volume in common."""
    advice = "For a mesh that does, cut the part with Boolean Fragments (mode CompSolid)"
    same = [(a, b) for a, b in overlapping if are_same(solids[a - 1], solids[b - 1])]
    partly = [pair for pair in overlapping if pair not in same]
    warnings = []
    if same:
        warnings.append(
            "solids are the same, and both are meshed: %s. Remove one of each two" % pairs_of_names(3, same)
        )
    if partly:
        warnings.append(
            "solids lie in each other, and so do their meshes, which do not fit together: %s. %s"
            % (pairs_of_names(3, partly), advice)
        )
    if touching:
        warnings.append(
            "faces of different solids touch or cross without being one face, so the meshes of these solids "
            "do not fit together there: %s. %s" % (pairs_of_names(2, touching), advice)
        )
    return warnings


def pairs_of_names(dimension, pairs):
    """'Face1 and Face7, Face2 and Face3, ... (9 pairs in all)' for a message."""
    names = ["%s and %s" % (entity_name(dimension, a), entity_name(dimension, b)) for a, b in pairs[:NAMED]]
    return ", ".join(names) + ("" if len(pairs) <= NAMED else ", ... (%d pairs in all)" % len(pairs))


def position_tolerance(face):
    """How far (mm) tessellation nodes may lie off the surface: as far as the face's own edges do."""
    return max(1e-7, 2.0 * face.getTolerance(1, Part.Edge), 2.0 * face.getTolerance(1, Part.Vertex))


def features(mesh, kinds, kept):
    """(E,) bool: smooth seams to be dropped; (V,) bool: vertices that are features."""
    cad = mesh.cad
    seam = np.zeros(len(cad.edges), dtype=bool)
    for number, face in cad.seam_faces.items():
        alone = cad.edge_faces[number] == [face] and number not in kept["Edge"]
        seam[number] = alone and seam_is_smooth(
            cad.edges[number], cad.faces[face], cad.surfaces[face], kinds[face]
        )
    tips = {
        edge.Vertexes[0].hashCode()
        for edge, faces in zip(cad.edges, cad.edge_faces)
        if edge.Degenerated and not all(kinds[face] in (SPHERE, TORUS) for face in faces)
    }
    touched = np.zeros(len(mesh.points), dtype=bool)
    touched[mesh.segments[~seam[mesh.segment_edge]]] = True
    corner = touched[mesh.vertex_point]
    if tips:
        corner |= [vertex.hashCode() in tips for vertex in cad.vertices]
    corner[[number for number in kept["Vertex"] if number < len(corner)]] = True
    return seam, corner


def wanted_edges(mesh, seam):
    """(E,) bool: edges that need their curve."""
    wanted = np.zeros(len(mesh.cad.edges), dtype=bool)
    wanted[mesh.segment_edge] = True
    return wanted & ~seam


def corner_points(vertex_point, is_corner):
    """(corners, corner_vertex, {dropped vertex: kept vertex}): one vertex per point."""
    vertices = np.flatnonzero(is_corner)
    corners, first, inverse = np.unique(vertex_point[vertices], return_index=True, return_inverse=True)
    kept = vertices[first]
    pairs = zip(vertices.tolist(), kept[inverse.reshape(-1)].tolist())
    return corners, kept, {vertex: other for vertex, other in pairs if vertex != other}


def face_names(faces):
    """'Face1, Face7, ... (12 in all)' for a message."""
    numbers = sorted({int(face) for face in faces})
    text = ", ".join(entity_name(2, number) for number in numbers[:NAMED])
    return text if len(numbers) <= NAMED else "%s, ... (%d in all)" % (text, len(numbers))
