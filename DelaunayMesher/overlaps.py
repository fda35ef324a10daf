"""Closed bodies that lie in each other, told from places of one that lie inside another.

One may lie inside the other whole, or pass it exactly at its edges, or be the same.
Cost: for each pair of bodies whose boxes overlap, a few times the triangles of both.
"""

import numpy as np

from .cells import winding

SAMPLES = 6  # places of a body that are looked at
INSIDE, OUTSIDE = 0.9, 0.1  # winding numbers; on the surface it is between


def find_overlaps(bodies, known, places_of=None, depth=0.0):
    """[(inner, outer, places, whole), ...] of bodies, a list of the corners (m, 3, 3) of triangles that point
    outwards.

    places (k, 3): some of those of `inner` that are inside `outer`; whole: none that was looked at is outside
    it. known (n, n) bool: pairs to leave out. places_of: function that gives the places (k, 3) of a body to
    look at, by default its corners. depth: share of the smaller body's size that a place must at least be
    inside the other's box, to leave out early what merely touches.
    """
    places_of = places_of or corners_of
    low = np.array([body.min(axis=(0, 1)) for body in bodies])
    high = np.array([body.max(axis=(0, 1)) for body in bodies])
    size = np.linalg.norm(high - low, axis=1)
    found = []
    for inner, body in enumerate(bodies):
        margin = (depth * np.minimum(size, size[inner]))[:, None]
        meets = (low + margin < high[inner]).all(axis=1) & (high - margin > low[inner]).all(axis=1)
        meets[inner] = False
        meets &= ~known[inner]
        places = places_of(body) if meets.any() else None
        for outer in np.flatnonzero(meets).tolist():
            near = (places > low[outer] + margin[outer]) & (places < high[outer] - margin[outer])
            near = near.all(axis=1)
            picked = places[near][:: max(1, near.sum() // SAMPLES)]
            numbers = winding(bodies[outer], picked)
            if (numbers > INSIDE).any():
                whole = bool(near.all() and (numbers > OUTSIDE).all())
                found.append((inner, outer, picked[numbers > INSIDE], whole))
    return found


def corners_of(body):
    return np.unique(body.reshape(-1, 3), axis=0)


def places_inside(body, depth):
    """Corners of a body, and the middles of its triangles pushed inwards: where the faces of two bodies lie
    on each other, as those of two equal ones do, no corner is inside."""
    normal = np.cross(body[:, 1] - body[:, 0], body[:, 2] - body[:, 0])
    length = np.linalg.norm(normal, axis=1)
    pushed = (
        body.mean(axis=1)[length > 0] - depth * (normal / np.maximum(length, 1e-300)[:, None])[length > 0]
    )
    return np.concatenate([corners_of(body), pushed])


def size_of(body):
    """Diagonal of a body's box (mm)."""
    return float(np.linalg.norm(body.max(axis=(0, 1)) - body.min(axis=(0, 1))))
