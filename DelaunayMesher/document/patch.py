"""Triangles of a part of a CAD face from its outline alone: loops of points, outer ones and holes.

Idea: in a plane by constrained triangulation. On a curved face the loops are joined by bridges, and filled by
dynamic programming (Barequet, Sharir 1995), the cost being the area off the normals of the surface; then
inner edges are flipped towards these normals and divided, their middles on the surface, until they lie near.
Postcondition: the outline is that of the loops, in their direction.
"""

import itertools

import numpy as np
from FreeCAD import Vector

from .tessellation import ONE_TURN, ROUND

AREA = 1.001  # of the area itself, beside the area along the normals: settles what they leave open
NEAR = 0.07  # of its length: how far an inner edge may be from the surface
CLEAR = 0.2  # of its length: how far from others the point in its middle must be
ROUNDS = 8
SAMPLES = 24  # in each direction of a face
STEPS = 30
BEYOND = 1e-6  # of its range: how far a parameter may lie outside a face
SETTLED = 1e-6  # of the distance from the surface: the last step


def bridged(points, loops):
    """One loop of several, joined by the shortest bridges."""
    loops = sorted(loops, key=len)
    whole = loops.pop()
    while loops:
        apart = [np.linalg.norm(points[whole][:, None] - points[loop][None], axis=2) for loop in loops]
        nearest = int(np.argmin([distances.min() for distances in apart]))
        a, b = np.unravel_index(apart[nearest].argmin(), apart[nearest].shape)
        loop = loops.pop(nearest)
        whole = whole[: a + 1] + loop[b:] + loop[: b + 1] + whole[a:]
    return whole


def least_cost(places, normals):
    """(n - 2, 3) triangles of a closed loop of points: least area, and least area off the given normals.

    The area alone would span two discs in the ends of a tube instead of its wall.
    """
    count = len(places)
    best = np.zeros((count, count))
    choice = np.zeros((count, count), dtype=np.int64)
    for span in range(2, count):
        first = np.arange(count - span)
        last = first + span
        between = first[:, None] + np.arange(1, span)[None]
        a, b, c = places[first][:, None], places[between], places[last][:, None]
        area = 0.5 * np.cross(b - a, c - a)
        normal = (normals[first][:, None] + normals[between] + normals[last][:, None]) / 3.0
        cost = AREA * np.linalg.norm(area, axis=2) - (area * normal).sum(axis=2)
        total = best[first[:, None], between] + best[between, last[:, None]] + cost
        chosen = total.argmin(axis=1)
        best[first, last] = total[first, chosen]
        choice[first, last] = first + 1 + chosen
    result, waiting = [], [(0, count - 1)]
    while waiting:
        a, c = waiting.pop()
        if c - a > 1:
            b = int(choice[a, c])
            result.append((a, b, c))
            waiting += [(a, b), (b, c)]
    return np.array(result, dtype=np.int64).reshape(-1, 3)


class FaceShape:
    """The surface of a face: points and normals, the normals as the triangles to be made have them."""

    def __init__(self, face, surface, sign):
        self.surface, self.sign, self.errors = surface, 1.0, {}
        self.grid, self.places = sample_grid(face, surface)
        u0, u1, v0, v1 = face.ParameterRange
        margin_u, margin_v = BEYOND * (u1 - u0), BEYOND * (v1 - v0)
        self.range = u0 - margin_u, u1 + margin_u, v0 - margin_v, v1 + margin_v
        place = 0.5 * (u0 + u1), 0.5 * (v0 + v1)
        try:
            own = self.normal(np.array(face.valueAt(*place)))
            self.sign = sign if np.dot(own, face.normalAt(*place)) >= 0 else -sign
        except (RuntimeError, ValueError):  # no normal there
            self.sign = 0.0

    def normal(self, point):
        """Unit normal of the surface nearest to a point, or zero where it has none."""
        try:
            u, v = self.foot(Vector(*point))
            normal = self.surface.getDN(u, v, 1, 0).cross(self.surface.getDN(u, v, 0, 1))
        except (RuntimeError, TypeError, ValueError, AttributeError):
            return np.zeros(3)
        length = normal.Length
        return self.sign / length * np.array(normal) if length > 0 else np.zeros(3)

    def foot(self, point):
        """(u, v) of the surface's point nearest to a vector: Gauss-Newton from the nearest sample, as OCC's
        own projection takes a hundred times as long; that one where the steps do not end."""
        if len(self.grid) and self.sign:
            u0, u1, v0, v1 = self.range
            u, v = self.grid[((self.places - point) ** 2).sum(axis=1).argmin()].tolist()
            for _ in range(STEPS):
                offset = self.surface.value(u, v) - point
                along_u, along_v = self.surface.getDN(u, v, 1, 0), self.surface.getDN(u, v, 0, 1)
                uu, uv, vv = along_u.dot(along_u), along_u.dot(along_v), along_v.dot(along_v)
                du, dv, determinant = along_u.dot(offset), along_v.dot(offset), uu * vv - uv * uv
                if determinant <= 1e-12 * uu * vv:
                    break
                du, dv = (vv * du - uv * dv) / determinant, (uu * dv - uv * du) / determinant
                u, v = u - du, v - dv
                if not (u0 <= u <= u1 and v0 <= v <= v1):
                    break
                if du * du * uu + dv * dv * vv <= (SETTLED * offset.Length) ** 2 + 1e-24:
                    return u, v
        return self.surface.parameter(point)

    def error(self, points, corners):
        """Area of a triangle off the normal in its middle; remembered, as projections are slow."""
        if corners not in self.errors:
            a, b, c = (points[corner] for corner in corners)
            area = 0.5 * np.array((Vector(*(b - a))).cross(Vector(*(c - a))))
            off = np.linalg.norm(area) - np.dot(area, self.normal((a + b + c) / 3.0))
            self.errors[corners] = float(off)
        return self.errors[corners]

    def nearest(self, point):
        """The point of the surface nearest to a point, or None."""
        try:
            return np.array(self.surface.value(*self.foot(Vector(*point))))
        except (RuntimeError, TypeError, ValueError, AttributeError):
            return None


def sample_grid(face, surface):
    """(parameters (n, 2), their points (n, 3)) spread over a face, once round if it goes round more often."""
    u0, u1, v0, v1 = face.ParameterRange
    u1 = min(u1, u0 + ONE_TURN) if isinstance(surface, ROUND) else u1
    shares = (np.arange(SAMPLES) + 0.5) / SAMPLES
    u, v = (side.reshape(-1) for side in np.meshgrid(u0 + shares * (u1 - u0), v0 + shares * (v1 - v0)))
    try:
        places = [(*surface.value(*place),) for place in zip(u.tolist(), v.tolist())]
    except (RuntimeError, TypeError, AttributeError):  # a kind FreeCAD has no class for
        return np.zeros((0, 2)), np.zeros((0, 3))
    return np.stack([u, v], axis=1), np.array(places)


def onto_surface(points, triangles, shape, outline):
    """(points, triangles) along the surface: edges flipped, then divided, their middles on the surface.

    outline: edges (lower point, higher point) that stay.
    """
    places = list(points[np.unique(triangles)])
    points, triangles = list(points), [tuple(corners) for corners in triangles.tolist()]
    triangles = flipped(points, triangles, shape, outline)
    for _ in range(ROUNDS):
        inner = inner_edges(triangles, outline)
        lengths = {edge: float(np.linalg.norm(points[edge[1]] - points[edge[0]])) for edge in inner}
        used, divided = set(), []
        for a, b in sorted(inner, key=lambda edge: (-lengths[edge], edge)):
            rows = inner[a, b]
            if used.isdisjoint(rows):
                middle = off_surface(0.5 * (points[a] + points[b]), shape, lengths[a, b])
                apart = np.inf if middle is None else np.linalg.norm(np.array(places) - middle, axis=1).min()
                if CLEAR * lengths[a, b] < apart < np.inf:
                    used.update(rows)
                    divided += halves([triangles[row] for row in rows], a, b, len(points))
                    points.append(middle)
                    places.append(middle)
        if not divided:
            break
        triangles = [corners for row, corners in enumerate(triangles) if row not in used] + divided
        triangles = flipped(points, triangles, shape, outline)
    return np.array(points), np.array(triangles, dtype=np.int64).reshape(-1, 3)


def inner_edges(triangles, outline):
    """{(lower point, higher point): the two rows of triangles that share it}"""
    rows = {}
    for row, (a, b, c) in enumerate(triangles):
        for edge in ((a, b), (b, c), (c, a)):
            rows.setdefault((min(edge), max(edge)), []).append(row)
    return {edge: pair for edge, pair in rows.items() if len(pair) == 2 and edge not in outline}


def flipped(points, triangles, shape, outline):
    """Triangles with inner edges flipped while that brings their normals nearer to those of the surface."""

    def error(corners):
        return shape.error(points, corners)

    triangles = list(triangles)
    edges = {edge for corners in triangles for edge in itertools.combinations(sorted(corners), 2)}
    for _ in range(ROUNDS):
        changed = set()
        for edge, rows in sorted(inner_edges(triangles, outline).items()):
            if not changed.isdisjoint(rows):
                continue
            old = [triangles[row] for row in rows]
            new, other = other_diagonal(*old, *edge)
            if other in edges or sum(map(error, new)) >= 0.99 * sum(map(error, old)):
                continue
            edges = edges - {edge} | {other}
            triangles[rows[0]], triangles[rows[1]] = new
            changed.update(rows)
        if not changed:
            break
    return triangles


def other_diagonal(first, second, a, b):
    """(two triangles with their edge a, b flipped, their common edge); unchanged where they do not agree."""
    if (a, b) not in zip(first, (*first[1:], first[0])):
        first, second = second, first
    c, d = (next(corner for corner in t if corner not in (a, b)) for t in (first, second))
    if c == d or (b, a) not in zip(second, (*second[1:], second[0])):
        return (first, second), (a, b)
    return ((a, d, c), (d, b, c)), (min(c, d), max(c, d))


def off_surface(middle, shape, length):
    """The point of the surface nearest to an edge's middle, or None if that is near enough or far off."""
    nearest = shape.nearest(middle)
    if nearest is None:
        return None
    return nearest if NEAR * length < np.linalg.norm(nearest - middle) < length else None


def halves(triangles, a, b, middle):
    """Triangles with a common edge a, b, each divided in two at its middle."""
    result = []
    for corners in triangles:
        result.append(tuple(middle if corner == a else corner for corner in corners))
        result.append(tuple(middle if corner == b else corner for corner in corners))
    return result
