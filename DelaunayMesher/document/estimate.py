"""Sizes and counts to be told before a run, from the shape alone and at once."""

import math

from ..sizing import AUTOMATIC_FRACTION

MIN_FRACTION = 100  # of the largest size, as options.py says
VOLUME_SHARE = 0.1  # mean volume of a tetrahedron over the cube of the wanted edge length (measured)


def automatic_size(shape):
    """The largest size that 'automatic' means for a shape; 0 when it has no extent."""
    box = shape.BoundBox
    return box.DiagonalLength / AUTOMATIC_FRACTION if box.isValid() else 0.0


def suggested_size(shape):
    """automatic_size with two digits, for people to start from."""
    return two_digits(automatic_size(shape))


def two_digits(size):
    """A length rounded to two significant digits."""
    if size <= 0.0:
        return 0.0
    return round(size, 1 - math.floor(math.log10(size)))


def uniform_count(shape, size):
    """Tetrahedra that fill a shape at one size everywhere: fewer than curvature and refinements will ask
    for."""
    return sum(solid.Volume for solid in shape.Solids) / (VOLUME_SHARE * size**3)
