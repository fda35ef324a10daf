"""The size field before a run: the element count to expect (docs/sizing.md), and the sizes on the part's
surface.

Cost: the conversion of the shape and the building of the size field.
"""

from dataclasses import dataclass

import numpy as np

from .. import extension, pipeline, sizing

FINEST_SHARE = 1.0 / 50.0  # edge length on the shown surface, of the diagonal
MOST_TRIANGLES = 40000


@dataclass
class Preview:
    """count: expected tetrahedra; points (n, 3), triangles (m, 3) of the surface and the size (n,) there."""

    count: float
    points: np.ndarray
    triangles: np.ndarray
    sizes: np.ndarray


def preview(shape, options, keep=()):
    """The Preview of a Part shape or a Surface with a MeshOptions.  Raises MeshError as a run would."""
    core = extension.load()
    plcs, _, _ = pipeline.to_plcs(shape, options, keep)
    if options.max_size is None:
        everything = np.concatenate([plc.points for plc in plcs])
        options = options.with_changes(max_size=sizing.automatic_max_size(everything))
    count, blocks, starts = 0.0, [], 0
    for plc in plcs:
        points, triangles = finer(plc.points, plc.triangles, FINEST_SHARE * sizing.diagonal(plc.points))
        own_options = pipeline.options_for_core(options, plc)
        sizes, expected = core.sizes(plc.as_dict(), plc.geometry, own_options, np.ascontiguousarray(points))
        count += expected
        blocks.append((points, triangles + starts, sizes))
        starts += len(points)
    return Preview(count, *(np.concatenate(block) for block in zip(*blocks)))


def finer(points, triangles, length):
    """Points and triangles with every edge longer than `length` halved again and again, conformingly.

    Stops at MOST_TRIANGLES, so that a large part is not shown more slowly than a small one.
    """
    triangles = np.asarray(triangles, dtype=np.int64)
    while len(triangles) < MOST_TRIANGLES:
        corners = points[triangles]
        lengths = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        if lengths.max() <= length:
            break
        # Only the longest edge of a triangle is ever halved, and a triangle by one edge at a time; both
        # triangles at an edge see the same length, so they agree on it sooner or later.
        longest = lengths.argmax(axis=1)
        rows = np.arange(len(triangles))
        a = triangles[rows, longest]
        b = triangles[rows, (longest + 1) % 3]
        opposite = triangles[rows, (longest + 2) % 3]
        split = lengths[rows, longest] > length
        pairs = np.sort(np.stack([a, b], axis=1)[split], axis=1)
        unique, middle = np.unique(pairs, axis=0, return_inverse=True)
        middle = middle.reshape(-1) + len(points)
        points = np.concatenate([points, points[unique].mean(axis=1)])
        a, b, opposite = a[split], b[split], opposite[split]
        triangles = np.concatenate(
            [
                triangles[~split],
                np.stack([a, middle, opposite], axis=1),
                np.stack([middle, b, opposite], axis=1),
            ]
        )
    return points, triangles
