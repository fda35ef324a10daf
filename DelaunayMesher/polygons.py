"""Triangulation of planar facets: polygons with holes, inner segments and loose points.

The triangles only carry the surface to the mesher, which makes its own; what counts is that they fill the
facet without a gap, use no new point and keep every given segment. Method: sweep over the points sorted by x
(each is joined to the part of the hull that it sees), segments recovered by flipping what crosses them (Sloan
1993), the other edges flipped until Delaunay, outside and holes removed by flooding. Orientation tests are
exact (fractions where doubles cannot tell). Cost: about 0.2 ms for each point.
"""

from fractions import Fraction

import numpy as np

from .errors import InputError


def triangulate_facet(points, loops, holes=()):
    """Triangles (t, 3) int, as numbers of `points`, of one planar facet, all turning the same way.

    points (n, 3) float64; loops: lists of point numbers, each a closed polygon (2 numbers: an inner segment,
    1: an inner point); holes: (k, 3) points in the holes. The plane is that of the largest polygon. Raises
    InputError when polygons cross each other.
    """
    outer = max(loops, key=lambda loop: _area2(points[loop]))
    if len(loops) == 1 and len(outer) == 3:
        return np.array([outer])
    normal = _area_vector(points[outer])
    if not normal.any():
        raise _bad_facet("a facet has no area", points[outer[0]])
    drop = int(np.argmax(np.abs(normal)))
    keep = [(1, 2), (2, 0), (0, 1)][drop]
    numbers = sorted({int(number) for loop in loops for number in loop})
    place = {number: index for index, number in enumerate(numbers)}
    flat = [(float(points[number][keep[0]]), float(points[number][keep[1]])) for number in numbers]
    segments = set()
    for loop in loops:
        for a, b in zip(loop, [*loop[1:], loop[0]]):
            if a != b:
                segments.add((min(place[a], place[b]), max(place[a], place[b])))
    try:
        triangles = _constrained(flat, segments)
    except _CrossingError as crossing:
        raise _bad_facet(
            "the polygons of a facet cross each other", points[numbers[crossing.args[0]]]
        ) from None
    seeds = [(float(hole[keep[0]]), float(hole[keep[1]])) for hole in holes]
    triangles = _inside(flat, triangles, segments, seeds)
    if not triangles:
        raise _bad_facet("the polygons of a facet enclose no area", points[outer[0]])
    result = np.array([[numbers[v] for v in triangle] for triangle in triangles])
    return result if normal[drop] > 0 else result[:, ::-1]


def plane_triangles(points, loops):
    """(t, 3) triangles inside loops in a plane that turn as the largest one, the others being holes; None if
    loops cross each other.

    As triangulate_facet(), but inner segments and points do not ask for a place in a hole.
    """
    outer = max(loops, key=lambda loop: _area2(points[loop]))
    try:
        holes = [
            points[triangulate_facet(points, [loop])[0]].mean(axis=0)
            for loop in loops
            if loop is not outer and len(loop) > 2
        ]
        triangles = triangulate_facet(points, loops, holes)
    except InputError:
        return None
    ahead = {(int(a), int(b)) for corners in triangles for a, b in zip(corners, np.roll(corners, -1))}
    right = all((a, b) in ahead for a, b in zip(outer, [*outer[1:], outer[0]]))
    return triangles if right else triangles[:, ::-1]


def _bad_facet(message, place):
    return InputError("read", "bad_facet", message, place)


def _area_vector(loop):
    return np.cross(loop - loop[0], np.roll(loop, -1, axis=0) - loop[0]).sum(axis=0) / 2


def _area2(loop):
    return float(np.linalg.norm(_area_vector(loop)))


class _CrossingError(Exception):
    """Two segments cross; the argument is a point of one of them."""


def _turn(a, b, c):
    """Sign of the area of the triangle a, b, c in the plane, exact."""
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    if not ((bx and cy) or (by and cx)):
        return 0  # on a line along an axis, as often as not
    left, right = bx * cy, by * cx
    det = left - right
    if abs(det) > 1e-14 * (abs(left) + abs(right)):
        return 1 if det > 0 else -1
    ax, ay = Fraction(a[0]), Fraction(a[1])
    exact = (Fraction(b[0]) - ax) * (Fraction(c[1]) - ay) - (Fraction(b[1]) - ay) * (Fraction(c[0]) - ax)
    return (exact > 0) - (exact < 0)


def _constrained(flat, segments):
    """Triangulation of the convex hull that holds every segment: {directed edge: opposite corner}."""
    opposite = _sweep(flat)
    for a, b in sorted(segments):
        _recover(flat, opposite, a, b, segments)
    _flip_to_delaunay(flat, opposite, segments)
    return opposite


def _add(opposite, a, b, c):
    opposite[a, b], opposite[b, c], opposite[c, a] = c, a, b


def _sweep(flat):
    """Any triangulation of the points, joined in order of x."""
    order = sorted(range(len(flat)), key=lambda v: flat[v])
    apex = next((k for k in range(2, len(order)) if _turn(*(flat[order[i]] for i in (0, 1, k)))), None)
    if apex is None:
        raise _CrossingError(order[0])
    opposite = {}
    hull = list(order[:apex])  # a straight chain so far; the first point off it makes a fan
    v = order[apex]
    if _turn(flat[hull[0]], flat[hull[1]], flat[v]) < 0:
        hull.reverse()
    for a, b in zip(hull, hull[1:]):
        _add(opposite, a, b, v)
    hull.append(v)
    after = dict(zip(hull, [*hull[1:], hull[0]]))
    before = {b: a for a, b in after.items()}
    for last, v in zip(order[apex:], order[apex + 1 :]):
        first = end = last  # what v sees of the hull is beside the point before it
        while _turn(flat[end], flat[after[end]], flat[v]) < 0:
            _add(opposite, after[end], end, v)
            end = after[end]
        while _turn(flat[before[first]], flat[first], flat[v]) < 0:
            _add(opposite, first, before[first], v)
            first = before[first]
        after[first], before[v], after[v], before[end] = v, first, end, v
    return opposite


def _recover(flat, opposite, a, b, segments):
    """Flip the edges that cross the segment a, b until it is one."""
    if (a, b) in opposite or (b, a) in opposite:
        return
    crossing = _crossed(flat, opposite, a, b)
    tries, most = 0, 100 * (len(crossing) + 10) ** 2
    while crossing:
        p, q = crossing.pop(0)
        if (min(p, q), max(p, q)) in segments:
            raise _CrossingError(a)
        r, s = opposite[p, q], opposite[q, p]
        tries += 1
        if tries > most:
            raise _CrossingError(a)
        if not _flip(flat, opposite, p, q):
            crossing.append((p, q))
            continue
        if not {r, s} & {a, b} and _turn(flat[a], flat[b], flat[r]) * _turn(flat[a], flat[b], flat[s]) < 0:
            crossing.append((r, s))


def _flip(flat, opposite, p, q):
    """Whether the two triangles beside the edge p, q make a convex quadrangle; if so, its other diagonal
    replaces the edge."""
    r, s = opposite[p, q], opposite[q, p]
    if not (_turn(flat[r], flat[p], flat[s]) > 0 and _turn(flat[s], flat[q], flat[r]) > 0):
        return False
    del opposite[p, q], opposite[q, p]
    _add(opposite, r, p, s)
    _add(opposite, s, q, r)
    return True


def _crossed(flat, opposite, a, b):
    """Edges that the segment from a to b crosses, in order; raises when it runs through a point."""
    p, q = None, None
    for (u, v), w in opposite.items():
        if w == a and _turn(flat[a], flat[b], flat[u]) < 0 < _turn(flat[a], flat[b], flat[v]):
            p, q = u, v
            break
    if p is None:
        raise _CrossingError(a)
    edges = []
    while True:
        edges.append((p, q))
        r = opposite.get((q, p))
        if r == b:
            return edges
        side = _turn(flat[a], flat[b], flat[r]) if r is not None else 0
        if side == 0:
            raise _CrossingError(a)
        p, q = (r, q) if side < 0 else (p, r)


def _flip_to_delaunay(flat, opposite, segments):
    """Flip edges that are no segments until none has a corner in the circle of the triangle beyond it."""
    waiting = [(a, b) for a, b in opposite if a < b]
    while waiting:
        p, q = waiting.pop()
        r, s = opposite.get((p, q)), opposite.get((q, p))
        if r is None or s is None or (min(p, q), max(p, q)) in segments:
            continue
        if _in_circle(flat[p], flat[q], flat[r], flat[s]) and _flip(flat, opposite, p, q):
            waiting += [(p, s), (s, q), (q, r), (r, p)]


def _in_circle(a, b, c, d):
    """Whether d lies clearly inside the circle of a, b, c, which turn to the left."""
    rows = [(p[0] - d[0], p[1] - d[1]) for p in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    a2, b2, c2 = (x * x + y * y for x, y in rows)
    terms = (a2 * bx * cy, -a2 * by * cx, b2 * cx * ay, -b2 * cy * ax, c2 * ax * by, -c2 * ay * bx)
    return sum(terms) > 1e-12 * sum(map(abs, terms))


def _inside(flat, opposite, segments, holes):
    """Triangles that cannot be reached from outside the hull, nor from a hole, without crossing a segment."""
    triangle_at = {(a, b): min((a, b, c), (b, c, a), (c, a, b)) for (a, b), c in opposite.items()}
    triangles = sorted(set(triangle_at.values()))
    front = [
        triangle
        for (a, b), triangle in triangle_at.items()
        if (b, a) not in opposite and (min(a, b), max(a, b)) not in segments
    ]
    for hole in holes:
        front += [triangle for triangle in triangles if _contains([flat[v] for v in triangle], hole)]
    removed = set()
    while front:
        triangle = front.pop()
        if triangle in removed:
            continue
        removed.add(triangle)
        for a, b in zip(triangle, (*triangle[1:], triangle[0])):
            if (b, a) in opposite and (min(a, b), max(a, b)) not in segments:
                front.append(triangle_at[b, a])
    return [triangle for triangle in triangles if triangle not in removed]


def _contains(corners, place):
    a, b, c = corners
    return _turn(a, b, place) >= 0 and _turn(b, c, place) >= 0 and _turn(c, a, place) >= 0
