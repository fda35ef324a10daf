"""Where the mesh is to be finer: names, regions and sizes on points, as the arrays the core takes.

Lengths in mm. A size is the wanted edge length of the elements; the smallest of all sizes at a place holds.
"""

import math
from dataclasses import dataclass
from typing import Tuple

import numpy as np

from .cad_names import carrier
from .errors import refusal

AUTOMATIC_FRACTION = 20  # of the diagonal; Gmsh's default of 10 is too coarse for stresses


@dataclass(frozen=True)
class Region:
    """Size inside a ball, box or cylinder; outside it grows over `transition` mm (0: by the growth rate)."""

    kind: str  # 'ball' | 'box' | 'cylinder'
    a: Tuple[float, float, float]  # centre | corner | start of the axis
    b: Tuple[float, float, float]  # unused | opposite corner | end of the axis
    radius: float
    size: float
    transition: float = 0.0

    KINDS = ("ball", "box", "cylinder")

    @classmethod
    def ball(cls, centre, radius, size, transition=0.0):
        return cls("ball", tuple(centre), (0.0, 0.0, 0.0), radius, size, transition)

    @classmethod
    def box(cls, corner, opposite, size, transition=0.0):
        return cls("box", tuple(corner), tuple(opposite), 0.0, size, transition)

    @classmethod
    def cylinder(cls, start, end, radius, size, transition=0.0):
        return cls("cylinder", tuple(start), tuple(end), radius, size, transition)

    def check(self):
        """Raise InputError when a number makes no sense."""
        if self.kind not in self.KINDS:
            raise refusal("a region is one of %s, not %r" % (", ".join(self.KINDS), self.kind), "bad_region")
        numbers = [*self.a, *self.b, self.radius, self.size, self.transition]
        if len(self.a) != 3 or len(self.b) != 3 or not all(math.isfinite(x) for x in numbers):
            raise refusal("a %s region has a number that is missing or not finite" % self.kind, "bad_region")
        if self.size <= 0:
            raise refusal(
                "the size of a %s region must be above 0, not %g" % (self.kind, self.size), "bad_size"
            )
        if self.transition < 0 or (self.kind != "box" and self.radius <= 0):
            raise refusal(
                "a %s region needs a radius above 0 and a transition of 0 or more" % self.kind, "bad_region"
            )

    def row(self):
        """The ten numbers of the core's table: kind, a, b, radius, size, transition."""
        return [self.KINDS.index(self.kind), *self.a, *self.b, self.radius, self.size, self.transition]


def sizes_by_name(sizes, plc):
    """Arrays of sizes for the core from {'Face3': 0.5, ...}; infinity where none is given."""
    arrays = {kind: np.full(count, np.inf) for kind, count in plc.element_counts.items()}
    for name, size in sizes.items():
        kind, row = carrier(name, plc.element_counts, plc.aliases)
        arrays[kind][row] = min(size, arrays[kind][row])
    if plc.solid_numbers is not None:
        arrays["Solid"] = arrays["Solid"][plc.solid_numbers - 1]
    return {kind.lower() + "_size": array for kind, array in arrays.items()}


def diagonal(points):
    """Length of the bounding box diagonal."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def automatic_max_size(points):
    """The largest size when the user gives none."""
    return diagonal(points) / AUTOMATIC_FRACTION


def regions_array(regions):
    """(r, 10) float64 table of regions."""
    return np.array([region.row() for region in regions], dtype=np.float64).reshape(-1, 10)
