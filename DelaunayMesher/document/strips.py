"""Triangles of very narrow torus faces, from their outline alone.

OCC puts tens of thousands of nodes into such a face (a torus strip of 12 m by 0.15 mm: 24 s); the polylines
of its edges, which the neighbours need anyway, are enough.  Limit: one outline, which does not close around
the torus.
"""

import itertools

import numpy as np
import Part
from FreeCAD import Vector

from ..polygons import triangulate_facet

NARROW = 1e-2  # width over length


def is_narrow(face, surface):
    """Whether a face is a strip of a torus with one outline."""
    if not isinstance(surface, Part.Toroid) or len(face.Wires) != 1:
        return False
    u0, u1, v0, v1 = face.ParameterRange
    if max(u1 - u0, v1 - v0) > 1.9 * np.pi:
        return False
    along = (u1 - u0) * (surface.MajorRadius + surface.MinorRadius)
    across = (v1 - v0) * surface.MinorRadius
    return min(along, across) < NARROW * max(along, across)


def strip_facets(face, lines):
    """(nodes, triangles) of a face as getFacesFromSubElement gives them, from the polylines of its edges.

    Raises MeshError (an InputError) when the outline crosses itself in the surface's parameters.
    """
    rows = {}
    chains = [
        [rows.setdefault(tuple(round(x, 7) for x in point), len(rows)) for point in line] for line in lines
    ]
    first = {}
    for row, point in zip(itertools.chain(*chains), itertools.chain(*lines)):
        first.setdefault(row, point)
    nodes = [first[row] for row in range(len(rows))]
    loop = closed_loop(chains)
    flat = parameters(face, nodes)
    triangles = triangulate_facet(flat, [loop])
    corner, span = flat[triangles[:, 0], :2], flat[triangles, :2]
    area = np.linalg.det(span[:, 1:] - corner[:, None]).sum()
    u, v = flat[loop[0], :2].tolist()
    along_u, along_v = face.Surface.getDN(u, v, 1, 0), face.Surface.getDN(u, v, 0, 1)
    outward = along_u.cross(along_v).dot(face.normalAt(u, v)) > 0
    if (area > 0) != outward:
        triangles = triangles[:, ::-1]
    return [Vector(*node) for node in nodes], [tuple(corners) for corners in triangles.tolist()]


def closed_loop(chains):
    """The nodes of chains that meet end to end, in order."""
    following = {}
    for chain in chains:
        for a, b in zip(chain, chain[1:]):
            following.setdefault(a, []).append(b)
            following.setdefault(b, []).append(a)
    start = chains[0][0]
    loop, before = [start], None
    while True:
        after = next(node for node in following[loop[-1]] if node != before)
        if after == start or len(loop) > len(following):
            return loop
        before = loop[-1]
        loop.append(after)


def parameters(face, nodes):
    """(n, 3) of u, v, 0 of nodes on the face, within its range."""
    u0, u1, v0, v1 = face.ParameterRange
    middle = np.array([0.5 * (u0 + u1), 0.5 * (v0 + v1)])
    uv = np.array([face.Surface.parameter(node) for node in nodes])
    uv -= 2.0 * np.pi * np.round((uv - middle) / (2.0 * np.pi))
    return np.column_stack([uv, np.zeros(len(uv))])
