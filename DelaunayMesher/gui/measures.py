"""The measures that the quality panel offers."""

from dataclasses import dataclass
from typing import Callable, Tuple

from .. import quality


@dataclass(frozen=True)
class Measure:
    """A measure of tetrahedra, its range in the histogram, and how good a value is (0..1)."""

    name: str
    unit: str
    low: float
    high: float
    ticks: Tuple[float, ...]
    compute: Callable  # (points, tets) -> (t,)
    worst_is_small: bool = True

    def goodness(self, value):
        """0 for the worst, 1 for the best; works on arrays."""
        share = (value - self.low) / (self.high - self.low)
        return share if self.worst_is_small else 1.0 - share

    def order(self, values):
        """Rows from worst to best."""
        return values.argsort(kind="stable") if self.worst_is_small else (-values).argsort(kind="stable")

    def is_worse(self, values, threshold):
        """Which values are beyond a threshold."""
        return values < threshold if self.worst_is_small else values > threshold


MEASURES = (
    Measure(
        "Smallest dihedral angle", "\u00b0", 0.0, 72.0, (0, 10, 20, 30, 40, 50, 60, 70),
        lambda points, tets: quality.dihedral_angles(points, tets).min(axis=1),
    ),
    Measure(
        "Largest dihedral angle", "\u00b0", 60.0, 180.0, (60, 90, 120, 150, 180),
        lambda points, tets: quality.dihedral_angles(points, tets).max(axis=1), worst_is_small=False,
    ),
    Measure("Radius ratio", "", 0.0, 1.0, (0, 0.2, 0.4, 0.6, 0.8, 1), quality.radius_ratio),
    Measure(
        "Radius-edge ratio", "", 0.6, 3.0, (1, 1.5, 2, 2.5, 3), quality.radius_edge_ratio,
        worst_is_small=False,
    ),
    Measure("Aspect ratio", "", 1.0, 10.0, (1, 2, 4, 6, 8, 10), quality.aspect_ratio, worst_is_small=False),
)  # fmt: skip
