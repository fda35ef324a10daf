"""Closed bodies that lie in each other, told from places of one that lie inside another.

For pairs without crossing triangles: one may lie inside the other whole, or pass it exactly at its edges.
Cost: for each pair of bodies whose boxes overlap, a few times the triangles of both.
"""

import numpy as np

from .cells import winding

SAMPLES = 3  # corners of a body that are looked at
INSIDE, OUTSIDE = 0.9, 0.1  # winding numbers; on the surface it is between


def find_overlaps(bodies, known):
    """[(inner, outer, place, whole), ...] of bodies, a list of the corners (m, 3, 3) of triangles that point
    outwards.

    place: a corner of `inner` inside `outer`; whole: no corner is outside it. known (n, n) bool: pairs to
    leave out.
    """
    low = np.array([body.min(axis=(0, 1)) for body in bodies])
    high = np.array([body.max(axis=(0, 1)) for body in bodies])
    found = []
    for inner, body in enumerate(bodies):
        meets = (low < high[inner]).all(axis=1) & (high > low[inner]).all(axis=1)
        meets[inner] = False
        meets &= ~known[inner]
        places = np.unique(body.reshape(-1, 3), axis=0) if meets.any() else None
        for outer in np.flatnonzero(meets).tolist():
            near = ((places > low[outer]) & (places < high[outer])).all(axis=1)
            picked = places[near][:: max(1, near.sum() // SAMPLES)]
            numbers = np.array([winding(bodies[outer], place) for place in picked])
            if (numbers > INSIDE).any():
                whole = bool(near.all() and (numbers > OUTSIDE).all())
                found.append((inner, outer, picked[numbers.argmax()], whole))
    return found
