"""The size field before a run: an estimate of the element count, and the sizes on the part's surface.

Count: the integral of 1 / (mean volume of an element of size h) over the solids, sampled on vertical columns
through the PLC.  Measured on plates, brackets and cylinders: within a fifth of the truth.  Cost: the
conversion of the shape and the building of the size field, plus some 0.1 s.
"""

from dataclasses import dataclass

import numpy as np

from .. import extension, pipeline, sizing
from .estimate import VOLUME_SHARE
from .plc_from_shape import convert

COLUMNS = 3000
OFFSET = (0.4371, 0.5713)  # of a cell: columns must not run along diagonals of the triangles
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
    """The Preview of a Part shape with a MeshOptions.  Raises MeshError as a run would."""
    core = extension.load()
    plcs = convert(shape, options, keep).plcs
    if options.max_size is None:
        everything = np.concatenate([plc.points for plc in plcs])
        options = options.with_changes(max_size=sizing.automatic_max_size(everything))
    count, blocks, starts = 0.0, [], 0
    for plc in plcs:
        points, triangles = finer(plc.points, plc.triangles, FINEST_SHARE * sizing.diagonal(plc.points))
        samples, weights = inner_samples(plc)
        places = np.ascontiguousarray(np.concatenate([points, samples]))
        sizes = core.sizes(plc.as_dict(), plc.geometry, pipeline.options_for_core(options, plc), places)
        count += float((weights / (VOLUME_SHARE * sizes[len(points) :] ** 3)).sum())
        blocks.append((points, triangles + starts, sizes[: len(points)]))
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


def inner_samples(plc):
    """(points (k, 3), the volume that each stands for (k,)) inside the solids of a PLC."""
    low, high = plc.points.min(axis=0), plc.points.max(axis=0)
    extent = high - low
    cells = np.maximum(1, np.round(np.sqrt(COLUMNS * extent[:2] / extent[1::-1]))).astype(int)
    step = extent[:2] / cells
    column, z, above = crossings(plc, low, step, cells)
    order = np.lexsort((z, column))
    column, z, above = column[order], z[order], above[order]
    inside = np.flatnonzero((column[1:] == column[:-1]) & (above[:-1] != 0))
    heights = z[inside + 1] - z[inside]
    counts = np.maximum(1, np.ceil(heights / step.mean())).astype(int)
    owner = np.repeat(np.arange(len(inside)), counts)
    rank = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = (rank + 0.5) / counts[owner]
    chosen = column[inside][owner]
    xy = low[:2] + (np.stack([chosen // cells[1], chosen % cells[1]], axis=1) + OFFSET) * step
    points = np.column_stack([xy, z[inside][owner] + share * heights[owner]])
    return points, heights[owner] / counts[owner] * step.prod()


def crossings(plc, low, step, cells):
    """Where the columns x = low + (i + OFFSET) step cross the triangles: column number i * cells[1] + j,
    height, and the solid above."""
    corners = plc.points[plc.triangles]
    flat = (corners[:, :, :2] - low[:2]) / step - OFFSET  # columns are whole numbers now
    first = np.maximum(np.ceil(flat.min(axis=1)).astype(int), 0)
    last = np.minimum(np.floor(flat.max(axis=1)).astype(int), cells - 1)
    wide = np.maximum(last - first + 1, 0)
    counts = wide.prod(axis=1)
    row = np.repeat(np.arange(len(corners)), counts)
    rank = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
    i = first[row, 0] + rank // np.maximum(wide[row, 1], 1)
    j = first[row, 1] + rank % np.maximum(wide[row, 1], 1)
    a, b, c = (flat[row, k] - np.stack([i, j], axis=1) for k in range(3))
    areas = np.stack([cross(b, c), cross(c, a), cross(a, b)], axis=1)
    total = areas.sum(axis=1)
    hit = (areas > 0).all(axis=1) | (areas < 0).all(axis=1)
    row, areas, total, i, j = row[hit], areas[hit], total[hit], i[hit], j[hit]
    z = np.einsum("kc,kc->k", areas, corners[row, :, 2]) / total
    sides = np.asarray(plc.face_solids)[np.asarray(plc.triangle_face)[row]]
    return i * cells[1] + j, z, np.where(total > 0, sides[:, 1], sides[:, 0])


def cross(a, b):
    """z of the cross product of plane vectors (k, 2)."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
