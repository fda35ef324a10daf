"""Faces without a solid (an IGES file, a sewn import) -> solids.

Idea: OCC sews what agrees within 1e-6 mm. Shells that stay open are put into one solid when each of their
free edges lies on another free edge; the tessellation is closed there later (stitching.py). An IGES file has
a group of faces for each solid; those that close are sewn alone, as faces of solids that touch would be sewn
to each other. Postcondition: nothing is invented: a shell whose free edges have no partner stays a shell.
Limits: closed shells inside one another are taken as solids with cavities; of faces beside solids nothing is
made.
"""

import numpy as np
import Part

from ..errors import in_number
from .cad_elements import incidences

SEWING = 1e-4  # of the diagonal: how far apart edges may be that are taken as one
PROBES = (0.21, 0.5, 0.83)  # shares of an edge's range where its distance is measured


def with_solids(shape, warnings):
    """The shape itself if it has solids, else its faces sewn to solids, else itself; tells in `warnings`."""
    if shape.Solids or not shape.Faces:
        return shape
    solids, left = closed_groups(face_groups(shape), SEWING * shape.BoundBox.DiagonalLength)
    if not solids:
        return shape
    text = "the file has no solid; sewing made %d solid(s) of its %d face(s)" % (
        len(solids),
        len(shape.Faces),
    )
    if left:
        text += "; %d face(s) that did not close had to be left out" % left
    warnings.append(in_number(text))
    return solids[0] if len(solids) == 1 else Part.Compound(solids)


def face_groups(shape):
    """Lists of faces: those that stand together in one compound of a shape, not in one inside it."""
    if shape.ShapeType != "Compound":
        return [shape.Faces]
    parts = shape.childShapes()
    own = [face for part in parts if part.ShapeType != "Compound" for face in part.Faces]
    inner = [group for part in parts if part.ShapeType == "Compound" for group in face_groups(part)]
    return ([own] if own else []) + inner


def closed_groups(groups, tolerance):
    """(solids, faces left out) of groups of faces: each alone where it closes, the others together."""
    each = [(faces, *sewn(faces, tolerance)) for faces in groups]
    solids = [solid for _, closed, left in each if not left for solid in closed]
    unclosed = [result for result in each if result[2]]
    more, left = [], 0
    if len(unclosed) == 1:
        _, more, left = unclosed[0]
    elif unclosed:
        more, left = sewn([face for faces, *_ in unclosed for face in faces], tolerance)
    solids += more
    tight = [solid for solid in solids if solid.isClosed()]
    return with_cavities(tight) + [solid for solid in solids if not solid.isClosed()], left


def sewn(faces, tolerance):
    """(solids, how many faces left out) of faces sewn by OCC, shells that stay open with their partners()."""
    together = Part.Compound(faces)
    together.sewShape()
    shells = together.Shells
    loose = len(together.Faces) - sum(len(shell.Faces) for shell in shells)
    if loose:
        shells += [Part.Shell([face]) for face in together.Faces if not in_a_shell(face, shells)]
    solids = [outward(Part.Solid(shell)) for shell in shells if shell.isClosed()]
    groups, left = partners([shell for shell in shells if not shell.isClosed()], tolerance)
    return solids + [Part.makeSolid(Part.Compound(group)) for group in groups], left


def in_a_shell(face, shells):
    return any(face.isSame(other) for shell in shells for other in shell.Faces)


def outward(solid):
    """The solid with a positive volume."""
    if solid.Volume < 0.0:
        solid.reverse()
    return solid


def with_cavities(solids):
    """Solids, those that lie inside another one as its cavities."""
    solids = sorted(solids, key=lambda solid: -solid.Volume)
    inner = [[] for _ in solids]
    nested = [False] * len(solids)
    for number, solid in enumerate(solids):
        for outer in range(number):
            inside = solids[outer].BoundBox.isInside(solid.BoundBox)
            if inside and not nested[outer] and solids[outer].isInside(solid.Vertexes[0].Point, 1e-7, False):
                inner[outer].append(number)
                nested[number] = True
                break
    return [
        solid if not inner[number] else hollow(solid, [solids[other] for other in inner[number]])
        for number, solid in enumerate(solids)
        if not nested[number]
    ]


def hollow(solid, cavities):
    """The solid of the shells of all, those of the cavities turned round."""
    shells = [solid.Shells[0], *(cavity.Shells[0].reversed() for cavity in cavities)]
    return Part.makeSolid(Part.Compound(shells))


def partners(shells, tolerance):
    """(lists of open shells that close together, number of faces of the others)."""
    free = [(number, edge) for number, shell in enumerate(shells) for edge in free_edges(shell)]
    low, high = boxes_of([edge for _, edge in free], tolerance)
    group = np.arange(len(shells))
    alone = np.zeros(len(shells), dtype=bool)
    for place, (number, edge) in enumerate(free):
        found = neighbours(place, free, low, high, tolerance) if edge.Length > tolerance else []
        alone[number] |= found is None
        for other in found or ():
            group[group == group[other]] = group[number]
    groups, left = [], 0
    for number in np.unique(group):
        members = np.flatnonzero(group == number)
        if alone[members].any():
            left += sum(len(shells[member].Faces) for member in members)
        else:
            groups.append([shells[member] for member in members])
    return groups, left


def free_edges(shell):
    """Edges of a shell that bound one of its faces only, but for seams and points."""
    edges = shell.Edges
    _, edge_faces, seams = incidences(shell.Faces, edges)
    return [
        edge
        for number, edge in enumerate(edges)
        if len(edge_faces[number]) == 1 and number not in seams and not edge.Degenerated
    ]


def boxes_of(edges, margin):
    """(n, 3) lower and upper corners of the edges' boxes."""
    boxes = [edge.BoundBox for edge in edges]
    low = np.array([(box.XMin, box.YMin, box.ZMin) for box in boxes]).reshape(-1, 3)
    high = np.array([(box.XMax, box.YMax, box.ZMax) for box in boxes]).reshape(-1, 3)
    return low - margin, high + margin


def neighbours(place, free, low, high, tolerance):
    """Numbers of the shells whose free edges cover an edge, or None where a point has no partner."""
    edge = free[place][1]
    first, last = edge.ParameterRange
    result = []
    for share in PROBES:
        point = edge.valueAt(first + share * (last - first))
        near = ((low <= point) & (high >= point)).all(axis=1)
        near[place] = False
        vertex = Part.Vertex(point)
        found = [
            free[other][0]
            for other in np.flatnonzero(near)
            if free[other][1].distToShape(vertex)[0] <= tolerance
        ]
        if not found:
            return None
        result += found
    return result
