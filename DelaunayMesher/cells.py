"""Which solid lies on each side of each triangle of a closed surface, whatever its orientation.

Idea: every triangle has two sides. Round each edge the sides that face each other bound the same region, so
they are joined; the connected sets of sides are the shells of the regions. A shell that encloses a positive
volume, seen from its own region, is the outer boundary of a region; a negative one is the boundary of a
hole in the region that contains it (nesting). This treats cavities, several solids, and solids that share
walls alike. (Regions of an arrangement: Zhou, Grinspun, Zorin, Jacobson 2016, "Mesh arrangements for solid
geometry".) Cost: O(m log m), and O(m) per shell whose bounding box lies in that of another.
"""

from typing import Any, NamedTuple

import numpy as np

from .errors import MeshError, in_number

FRONT, BACK = 0, 1  # side numbers: 2 * triangle + FRONT (where the right-hand normal points) or + BACK
AT_ONCE = 1_000_000  # pairs of a place and a triangle, which bounds the memory
OVERLAP = 1e-9  # radians: triangles at one edge closer than this overlap
FLAT = 1e-12  # volume relative to the cube of the diagonal


class HalfEdges(NamedTuple):
    """The 3m sides of m triangles, sorted so that those of one edge are neighbours.

    ends (3m, 2): the points, the lower first; owner: the triangle; direction: +1 when it runs from the
    lower to the higher point; third: its other corner; starts, sizes: where each edge's group starts, and
    its size.
    """

    ends: Any
    owner: Any
    direction: Any
    third: Any
    starts: Any
    sizes: Any


def half_edges(triangles):
    """HalfEdges of triangles (m, 3) int64."""
    a = triangles.T.reshape(-1)
    b = triangles[:, [1, 2, 0]].T.reshape(-1)
    third = triangles[:, [2, 0, 1]].T.reshape(-1)
    owner = np.tile(np.arange(len(triangles)), 3)
    low, high = np.minimum(a, b), np.maximum(a, b)
    key = low * (int(triangles.max(initial=0)) + 1) + high
    order = np.argsort(key, kind="stable")
    new = np.ones(len(key), bool)
    new[1:] = np.diff(key[order]) != 0
    starts = np.flatnonzero(new)
    sizes = np.diff(np.append(starts, len(key)))
    direction = np.where(a < b, 1, -1)[order]
    return HalfEdges(
        np.stack([low, high], axis=1)[order], owner[order], direction, third[order], starts, sizes
    )


def connected(a, b, count):
    """How many groups `count` items fall into when a[k] and b[k] are linked, and the group (count,) of each.

    Groups are numbered by their first items. Each round hooks the leader of every group on that of a group
    before it, if there is a link, so that some rounds are enough. (SciPy takes longer to load.)
    """
    leader = np.arange(count)
    while len(a):
        first, second = leader[a], leader[b]
        apart = first != second
        a, b = a[apart], b[apart]
        low = np.minimum(first, second)[apart]
        order = np.argsort(-low, kind="stable")  # the lowest comes last and stays
        leader[np.maximum(first, second)[apart][order]] = low[order]
        while (leader != leader[leader]).any():
            leader = leader[leader]
    numbers, group = np.unique(leader, return_inverse=True)
    return len(numbers), group.reshape(-1)


def find_cells(points, triangles, holes=None, nested="cavity"):
    """(m, 2) int: the solid in front of and behind each triangle, 1-based, 0 = outside or a cavity.

    Raises MeshError (open_edge, overlap, zero_volume) with the place.
    """
    sides = half_edges(triangles)
    shell = _shells(points, triangles, sides)
    component = pieces(triangles, sides)
    volumes = _shell_volumes(points, triangles, shell)
    limit = FLAT * float(np.linalg.norm(np.ptp(points[np.unique(triangles)], axis=0))) ** 3
    for flat in np.flatnonzero(np.abs(volumes) <= limit):
        place = points[triangles[np.flatnonzero(shell == flat)[0] // 2]].mean(axis=0)
        raise MeshError("plc", "zero_volume", "a part of the surface encloses no volume", place)
    region_of, parent, depth = _nesting(points, triangles, shell, component, volumes)
    solid_of = _number_solids(points, triangles, shell, volumes, region_of, depth, holes, nested)
    return solid_of[region_of[shell]].reshape(-1, 2)


def _shells(points, triangles, sides):
    """(2m,) number of the shell that each side belongs to."""
    edges, owner, direction, third, starts, sizes = sides
    if (sizes == 1).any():
        place = points[edges[starts[np.flatnonzero(sizes == 1)[0]]]].mean(axis=0)
        count = int((sizes == 1).sum())
        message = in_number("the surface is not closed: %d open edge(s), one" % count)
        raise MeshError("plc", "open_edge", message, place)
    angle = _angles(points, edges, third, starts, sizes)
    group = np.repeat(np.arange(len(starts)), sizes)
    order = np.lexsort((angle, group))
    owner, direction = owner[order], direction[order]
    following = np.arange(len(owner)) + 1
    following[starts + sizes - 1] = starts
    # A triangle that runs along the edge upwards turns its front to growing angles.
    ahead = 2 * owner + np.where(direction > 0, FRONT, BACK)
    behind = 2 * owner + np.where(direction > 0, BACK, FRONT)
    return connected(ahead, behind[following], 2 * len(triangles))[1]


def _angles(points, edges, third, starts, sizes):
    """Angle of each triangle round its edge; 0 where only two meet, as their order does not matter."""
    angle = np.zeros(len(edges))
    many = np.repeat(sizes > 2, sizes)
    if not many.any():
        return angle
    first = third[np.repeat(starts, sizes)][many]
    origin = points[edges[many, 0]]
    axis = points[edges[many, 1]] - origin
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    x = points[first] - origin
    x -= np.einsum("ij,ij->i", x, axis)[:, None] * axis
    y = np.cross(axis, x)
    v = points[third[many]] - origin
    angle[many] = np.arctan2(np.einsum("ij,ij->i", y, v), np.einsum("ij,ij->i", x, v)) % (2 * np.pi)
    # Rounding may leave the first one just under a full turn.
    angle[many] = np.where(angle[many] > 2 * np.pi - OVERLAP, 0, angle[many])
    _refuse_overlap(points, edges, angle, starts, sizes)
    return angle


def _refuse_overlap(points, edges, angle, starts, sizes):
    group = np.repeat(np.arange(len(starts)), sizes)
    order = np.lexsort((angle, group))
    close = (np.diff(angle[order]) < OVERLAP) & (np.diff(group[order]) == 0) & (sizes[group[order][1:]] > 2)
    if close.any():
        place = points[edges[order[np.flatnonzero(close)[0]]]].mean(axis=0)
        raise MeshError("plc", "overlap", "triangles of the surface overlap at an edge", place)


def pieces(triangles, sides=None):
    """(m,) number of the piece of surface, connected across edges, that each triangle belongs to."""
    sides = sides or half_edges(triangles)
    first = np.repeat(sides.owner[sides.starts], sides.sizes)
    return connected(first, sides.owner, len(triangles))[1]


def _shell_volumes(points, triangles, shell):
    """Signed volume that each shell encloses, seen from the region it bounds."""
    volumes = signed_volumes(points, triangles)
    return np.bincount(shell, np.stack([-volumes, volumes], axis=1).reshape(-1))


def signed_volumes(points, triangles):
    """(m,) volume of the tetrahedron that each triangle spans with the middle of the points."""
    a, b, c = (points[triangles[:, i]] - points.mean(axis=0) for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)) / 6


def outward_triangles(points, triangles):
    """(k, 3) those of one closed piece that bound it towards the outside, turned to point there.

    Raises MeshError (open_edge, overlap) with the place.
    """
    shell = _shells(points, triangles, half_edges(triangles))
    outer = int(np.argmin(_shell_volumes(points, triangles, shell)))
    return _seen_from_behind(triangles, np.flatnonzero(shell == outer))[:, ::-1]


def _seen_from_behind(triangles, sides):
    """(k, 3) triangles of some sides, turned to point away from the region that these face."""
    return np.where((sides % 2 == BACK)[:, None], triangles[sides // 2], triangles[sides // 2][:, ::-1])


def _nesting(points, triangles, shell, component, volumes):
    """Region of each shell (0 = outside), and of each region the one round it and its depth (outside 0)."""
    outer = np.flatnonzero(volumes > 0)
    region_of = np.zeros(len(volumes), np.int64)
    region_of[outer] = 1 + np.arange(len(outer))
    first_side = np.full(len(volumes), -1)
    first_side[shell[::-1]] = np.arange(len(shell))[::-1]
    component_of = component[first_side // 2]
    holes = np.flatnonzero(volumes < 0)
    region_of[holes] = [
        _containing(points, triangles, shell, volumes, outer, component_of, hole, region_of) for hole in holes
    ]
    outside_of = np.zeros(component_of.max() + 1, np.int64)  # region round each piece of surface
    outside_of[component_of[holes]] = region_of[holes]
    parent = np.zeros(len(outer) + 1, np.int64)
    parent[1:] = outside_of[component_of[outer]]
    depth = np.zeros(len(outer) + 1, np.int64)
    for region in range(1, len(parent)):
        up = region
        while up != 0:
            depth[region] += 1
            up = parent[up]
    return region_of, parent, depth


def _containing(points, triangles, shell, volumes, outer, component_of, hole, region_of):
    """The smallest region whose outer shell contains the shell `hole`."""
    mine = triangles[np.flatnonzero(shell == hole) // 2]
    area = np.linalg.norm(
        np.cross(points[mine[:, 1]] - points[mine[:, 0]], points[mine[:, 2]] - points[mine[:, 0]]), axis=1
    )
    place = points[mine[int(np.argmax(area))]].mean(axis=0)
    best, best_volume = 0, np.inf
    for other in outer:
        if component_of[other] == component_of[hole] or volumes[other] >= best_volume:
            continue
        if volumes[other] > -volumes[hole] and _winding(points, triangles, shell, other, place) > 0.5:
            best, best_volume = region_of[other], volumes[other]
    return best


def _winding(points, triangles, shell, number, place):
    """Winding number of a shell round a place off it."""
    corners = points[_seen_from_behind(triangles, np.flatnonzero(shell == number))]
    return float(winding(corners, place[None])[0])


def winding(corners, places):
    """How often a closed surface with some corners (m, 3, 3) winds round each of some places (k, 3) off it,
    (k,): 1 inside, when the triangles point outwards (van Oosterom and Strackee 1983)."""
    numbers = np.zeros(len(places))
    inside = ((places >= corners.min(axis=(0, 1))) & (places <= corners.max(axis=(0, 1)))).all(axis=1)
    rows = np.flatnonzero(inside)
    for some in np.array_split(rows, 1 + len(rows) * len(corners) // AT_ONCE):
        numbers[some] = _solid_angles(corners, places[some]).sum(axis=1) / (4 * np.pi)
    return numbers


def _solid_angles(corners, places):
    """Of each triangle seen from each place, (k, m)."""
    a, b, c = (corners[:, i] - places[:, None] for i in range(3))
    la, lb, lc = (np.sqrt(_dots(v, v)) for v in (a, b, c))
    above = _dots(a, np.cross(b, c))
    below = la * lb * lc + _dots(a, b) * lc + _dots(b, c) * la + _dots(c, a) * lb
    return 2 * np.arctan2(above, below)


def _dots(u, v):
    return np.einsum("kmi,kmi->km", u, v)


def _number_solids(points, triangles, shell, volumes, region_of, depth, holes, nested):
    """Solid number of each region, 0 for what stays empty."""
    solid = depth % 2 == 1 if nested == "cavity" else depth > 0
    outer = np.flatnonzero(volumes > 0)
    for place in np.zeros((0, 3)) if holes is None else np.asarray(holes, np.float64).reshape(-1, 3):
        inside = [k for k in outer if _winding(points, triangles, shell, k, place) > 0.5]
        if inside:
            solid[region_of[min(inside, key=lambda k: volumes[k])]] = False
    if not solid.any():
        raise MeshError("plc", "empty", "there is nothing to mesh: the surface encloses no solid")
    return np.where(solid, np.cumsum(solid), 0)
