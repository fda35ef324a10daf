"""Small closed surfaces for the tests: (points (n, 3), triangles (m, 3))."""

import numpy as np


def box(low=(0, 0, 0), high=(1, 1, 1)):
    points = np.array(
        [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])],
        dtype=float,
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [corner for a, b, c, d in quads for corner in ((a, b, c), (a, c, d))]
    return points, np.array(triangles)


def joined(*surfaces):
    """Several surfaces as one."""
    points, triangles, count = [], [], 0
    for some, more in surfaces:
        points.append(some)
        triangles.append(more + count)
        count += len(some)
    return np.concatenate(points), np.concatenate(triangles)


def cylinder(radius=1.0, height=2.0, sides=24):
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([ring, ring + [0, 0, height], [[0, 0, 0], [0, 0, height]]])
    low = np.arange(sides)
    following = (low + 1) % sides
    triangles = [
        np.stack([low, following, following + sides], axis=1),
        np.stack([low, following + sides, low + sides], axis=1),
        np.stack([following, low, np.full(sides, 2 * sides)], axis=1),
        np.stack([low + sides, following + sides, np.full(sides, 2 * sides + 1)], axis=1),
    ]
    return points, np.concatenate(triangles)


def sphere(radius=1.0, rounds=3):
    """A subdivided octahedron."""
    points = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    points = [np.array(point, dtype=float) for point in points]
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(rounds):
        middle, finer = {}, []
        for a, b, c in triangles:
            mids = []
            for p, q in ((a, b), (b, c), (c, a)):
                key = (min(p, q), max(p, q))
                if key not in middle:
                    middle[key] = len(points)
                    points.append((points[p] + points[q]) / np.linalg.norm(points[p] + points[q]))
                mids.append(middle[key])
            ab, bc, ca = mids
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return radius * np.array(points), np.array(triangles)


def torus(major=3.0, minor=1.0, around=48, across=16):
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, around, endpoint=False),
        np.linspace(0, 2 * np.pi, across, endpoint=False),
        indexing="ij",
    )
    ring = major + minor * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), minor * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = i * across + j, (i + 1) % around * across + j
    c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
    triangles = [np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))]
    return points, np.concatenate(triangles)


def volume(points, triangles):
    """Signed volume that a closed surface encloses."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def write_stl(path, points, triangles):
    """A text STL file."""
    lines = ["solid test"]
    for corners in points[triangles]:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex %.9g %.9g %.9g" % tuple(corner) for corner in corners]
        lines += ["endloop", "endfacet"]
    lines.append("endsolid test")
    path.write_text("\n".join(lines))
