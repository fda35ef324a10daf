"""Exact checks of a finished mesh, from its arrays alone: what a mesh is said to be, verified.

Nothing here rests on rounded numbers. Signs (orientation, point in sphere) come from the exact predicates of
the core; an angle so near its limit that rounding could decide is computed in rational numbers; a search tree
only picks the points to test, with a margin. Elements of second order are checked at their corners.
"""

from fractions import Fraction

import numpy as np

from . import extension, quality

CHUNK = 200000  # elements at once
NEAR_LIMIT = 1e-6  # degrees from the limit within which an angle is computed exactly
ROUNDING = 1e-9  # degrees by which an angle may miss its limit: the core compares in doubles
FLAT = 1e-9  # sixfold volume over longest edge cubed below which floating point is not trusted


def verify(mesh, target=None):
    """All checks of a Mesh; target in degrees, None: that of its options.

    Returns a dict. inverted: tetrahedra that are not positively oriented; boundary: faces that are a boundary
    or an interface but no triangle of the mesh, or the reverse; slivers: tetrahedra with a dihedral angle
    below the target. Each is an array and empty when all is well. delaunay: 'yes' - no point of the mesh lies
    inside the circumscribed sphere of any tetrahedron; 'constrained' - only points behind a boundary or an
    interface do; 'no'.
    """
    points, tets = mesh.points, np.asarray(mesh.tets)[:, :4]
    target = mesh.options.target_angle if target is None else target
    if len(not_delaunay(points, tets, mesh.triangles)):
        delaunay = "no"
    else:
        delaunay = "constrained" if len(points_in_spheres(points, tets)) else "yes"
    return {
        "inverted": inverted(points, tets),
        "boundary": wrong_boundary(tets, mesh.tet_solid, mesh.triangles),
        "slivers": slivers(points, tets, target),
        "delaunay": delaunay,
    }


def inverted(points, tets):
    """Numbers of the tetrahedra (t, 4) that are flat or inverted."""
    tets = np.asarray(tets)[:, :4]
    return np.flatnonzero(_in_batches(extension.load().orient3d, points, tets) <= 0)


def wrong_boundary(tets, tet_solid, triangles):
    """(k, 3) sorted corners: faces between different solids or with one tetrahedron that are not among the
    triangles, triangles that are no such face, and faces of three tetrahedra.
    """
    corners = _faces(tets)
    faces, inverse, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    inverse = inverse.reshape(-1)
    solid = np.repeat(np.asarray(tet_solid), 4)
    least, most = np.full(len(faces), 2**31 - 1), np.zeros(len(faces), dtype=np.int64)
    np.minimum.at(least, inverse, solid)
    np.maximum.at(most, inverse, solid)
    expected = faces[(count == 1) | (least != most)]
    given = np.sort(np.asarray(triangles)[:, :3], axis=1)
    rows, times = np.unique(np.concatenate([expected, given]), axis=0, return_counts=True)
    return np.concatenate([rows[times != 2], faces[count > 2]])


def not_delaunay(points, tets, triangles=None):
    """(k, 2) rows (tetrahedron, point): the point opposite a shared face lies inside the circumsphere.

    Faces among `triangles` (b, 3) are left out. When none is found the mesh is the Delaunay triangulation of
    its points, constrained by those faces and its boundary.
    """
    tets = np.asarray(tets)[:, :4]
    first, second = _shared_faces(tets)
    if triangles is not None and len(triangles):
        kept = ~_rows_in(_faces(tets)[first], np.sort(np.asarray(triangles)[:, :3], axis=1))
        first, second = first[kept], second[kept]
    return _inside(points, tets, first // 4, tets[second // 4, second % 4])


def points_in_spheres(points, tets):
    """(k, 2) rows (tetrahedron, point): any point of the mesh inside the circumsphere."""
    from scipy.spatial import cKDTree

    tets = np.asarray(tets)[:, :4]
    used = np.unique(tets)
    tree = cKDTree(points[used])
    found = [np.zeros((0, 2), dtype=np.int64)]
    for start in range(0, len(tets), CHUNK):
        part = tets[start : start + CHUNK]
        centres, radii = _spheres(points, part)
        # Four corners lie on the sphere: a fifth point nearer than the margin is to be looked at.
        fifth = tree.query(centres, k=min(5, len(used)))[0][:, -1]
        near = np.flatnonzero(~(fifth > radii)) if len(used) > 4 else np.zeros(0, dtype=np.int64)
        lists = [used[tree.query_ball_point(centres[t], radii[t])] for t in near]
        tet = np.repeat(near, [len(points_near) for points_near in lists])
        point = np.concatenate(lists) if lists else np.zeros(0, dtype=np.int64)
        other = (part[tet] != point[:, None]).all(axis=1)
        rows = _inside(points, part, tet[other], point[other])
        rows[:, 0] += start
        found.append(rows)
    return np.concatenate(found)


def slivers(points, tets, target):
    """Numbers of the tetrahedra with a dihedral angle below `target` degrees (by more than 1e-9 degrees)."""
    tets = np.asarray(tets)[:, :4]
    limit = target - ROUNDING
    below = []
    for start in range(0, len(tets), CHUNK):
        part = tets[start : start + CHUNK]
        smallest = quality.dihedral_angles(points, part).min(axis=1)
        doubtful = (np.abs(smallest - limit) < NEAR_LIMIT) | (_flatness(points, part) < FLAT)
        sharp = (smallest < limit) & ~doubtful
        for t in np.flatnonzero(doubtful):
            sharp[t] = _has_angle_below(points[part[t]].tolist(), limit)
        below.append(start + np.flatnonzero(sharp))
    return np.concatenate(below) if below else np.zeros(0, dtype=np.int64)


def _has_angle_below(corners, degrees):
    """In rational numbers: is one of the six dihedral angles smaller?"""
    corners = [[Fraction(x) for x in corner] for corner in corners]
    a, b, c, d = corners
    normals = [
        _cross(_minus(c, b), _minus(d, b)),
        _cross(_minus(d, a), _minus(c, a)),
        _cross(_minus(b, a), _minus(d, a)),
        _cross(_minus(c, a), _minus(b, a)),
    ]
    cosine = Fraction(float(np.cos(np.radians(degrees))))
    for i in range(4):
        for j in range(i):
            along = -_dot(normals[i], normals[j])
            lengths = _dot(normals[i], normals[i]) * _dot(normals[j], normals[j])
            if lengths == 0 or _signed_square(along) > _signed_square(cosine) * lengths:
                return True
    return False


def _signed_square(x):
    return x * abs(x)


def _minus(a, b):
    return [x - y for x, y in zip(a, b)]


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _flatness(points, tets):
    longest = quality.edge_lengths(points, tets).max(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.nan_to_num(6 * np.abs(quality.volumes(points, tets)) / longest**3)


def _spheres(points, tets):
    """Centres (t, 3) and radii (t,) of spheres that hold the circumscribed ones, whatever the rounding."""
    a, edges = points[tets[:, 0]], points[tets[:, 1:]] - points[tets[:, :1]]
    flatness = _flatness(points, tets)
    trusted = flatness > FLAT
    centres, radii = a.copy(), np.full(len(tets), np.inf)
    away = np.linalg.solve(2 * edges[trusted], (edges[trusted] ** 2).sum(axis=2)[..., None])[..., 0]
    centres[trusted] += away
    size = np.abs(points[tets]).max(axis=(1, 2))[trusted]
    margin = 1e-9 + 1e-14 / flatness[trusted]
    radii[trusted] = np.linalg.norm(away, axis=1) * (1 + margin) + 1e-14 * size
    return centres, radii


def _inside(points, tets, tet, point):
    """(k, 2) those of the rows (tet[i], point[i]) where the point lies inside the circumscribed sphere."""
    five = np.concatenate([tets[tet], np.asarray(point)[:, None]], axis=1)
    inside = _in_batches(extension.load().insphere, points, five) > 0
    return np.stack([np.asarray(tet), np.asarray(point)], axis=1)[inside].astype(np.int64)


def _in_batches(predicate, points, rows):
    """Signs (n,) of an exact predicate for rows (n, 4 | 5) of point numbers."""
    signs = [np.zeros(0, dtype=np.int8)]
    for start in range(0, len(rows), CHUNK):
        signs.append(predicate(np.ascontiguousarray(points[rows[start : start + CHUNK]], dtype=np.float64)))
    return np.concatenate(signs)


def _faces(tets):
    """(4 t, 3) faces with sorted corners; row 4 t + k is opposite corner k of tetrahedron t."""
    tets = np.asarray(tets)[:, :4]
    faces = np.stack([np.delete(tets, k, axis=1) for k in range(4)], axis=1).reshape(-1, 3)
    return np.sort(faces, axis=1)


def _shared_faces(tets):
    """Two arrays (n,) of rows of _faces: the same face seen from its two tetrahedra."""
    faces = _faces(tets)
    order = np.lexsort(faces.T[::-1])
    ordered = faces[order]
    same = (ordered[1:] == ordered[:-1]).all(axis=1)
    return order[:-1][same], order[1:][same]


def _rows_in(rows, others):
    """(n,) bool: which rows (n, 3) are among others (m, 3)."""
    order = np.lexsort(np.concatenate([rows, others]).T[::-1])
    ordered = np.concatenate([rows, others])[order]
    group = np.concatenate([[0], np.cumsum((ordered[1:] != ordered[:-1]).any(axis=1))])
    present = np.zeros(group[-1] + 1, dtype=bool)
    present[group[order >= len(rows)]] = True
    result = np.zeros(len(order), dtype=bool)
    result[order] = present[group]
    return result[: len(rows)]
