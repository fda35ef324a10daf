"""Faces without a solid (an IGES file, a sewn import) -> solids.

Idea: OCC sews what agrees within 1e-6 mm. Shells that stay open are put into one solid when each of their
free edges lies on another free edge; the tessellation is closed there later (stitching.py). Postcondition:
nothing is invented: a shell whose free edges have no partner stays a shell. Limits: closed shells inside one
another are taken as solids with cavities; of faces beside solids nothing is made.
"""

import numpy as np
import Part

from .cad_elements import incidences

SEWING = 1e-4  # of the diagonal: how far apart edges may be that are taken as one
PROBES = (0.21, 0.5, 0.83)  # shares of an edge's range where its distance is measured


def with_solids(shape, warnings):
    """The shape itself if it has solids, else its faces sewn to solids, else itself; tells in `warnings`."""
    if shape.Solids or not shape.Faces:
        return shape
    sewn = shape.copy()
    sewn.sewShape()
    shells = sewn.Shells
    loose = len(sewn.Faces) - sum(len(shell.Faces) for shell in shells)
    shells += [Part.Shell([face]) for face in sewn.Faces if not in_a_shell(face, shells)] if loose else []
    solids = [Part.Solid(shell) for shell in shells if shell.isClosed()]
    solids = with_cavities([outward(solid) for solid in solids])
    rest = [shell for shell in shells if not shell.isClosed()]
    groups, left = partners(rest, SEWING * shape.BoundBox.DiagonalLength)
    solids += [Part.makeSolid(Part.Compound(group)) for group in groups]
    if not solids:
        return shape
    warnings.append(
        "the file has no solid; its %d faces were sewn to %d solid%s%s"
        % (
            len(shape.Faces),
            len(solids),
            "" if len(solids) == 1 else "s",
            ", %d faces do not close and are left out" % left if left else "",
        )
    )
    return solids[0] if len(solids) == 1 else Part.Compound(solids)


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
