"""Every option of the mesher, once: name, unit, default, range, help, FreeCAD property.

The command line, the properties of the document object and the task panel are generated from OPTIONS;
MeshOptions is the validated set that a run takes.
"""

import dataclasses
import math
import os
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Tuple

from .cad_names import parse_name
from .errors import refusal
from .sizing import Region

MAX_AUTOMATIC_THREADS = 8


@dataclass(frozen=True)
class Option:
    """One row of the table.

    `default` None means automatic; a document property then holds 0. `open_minimum`: the value must be above
    `minimum`, not equal to it.
    """

    name: str
    kind: str  # 'length' mm | 'angle' degrees | 'float' | 'int' | 'bool' | 'choice'
    default: Any
    minimum: Optional[float]
    maximum: Optional[float]
    help: str
    property_name: str
    property_type: str
    group: str
    label: str
    unit: str = ""
    open_minimum: bool = False
    choices: Tuple[Any, ...] = ()
    metavar: str = ""

    @property
    def flag(self):
        """Command line flag: --max-size; a flag that is on by default turns it off: --no-optimise."""
        words = self.name.replace("_", "-")
        return "--no-" + words if self.kind == "bool" and self.default else "--" + words

    def check(self, value):
        """The value in its own type; raises InputError when it is of the wrong kind or out of range."""
        if value is None:
            if self.default is None:
                return None
            self._refuse(value, "must be given")
        if self.kind == "bool":
            if value not in (True, False):
                self._refuse(value, "must be True or False")
            return bool(value)
        number = self._number(value)
        if self.kind == "choice":
            if number not in self.choices:
                self._refuse(value, "must be %s" % " or ".join(str(choice) for choice in self.choices))
            return number
        low, high = self.minimum, self.maximum
        if low is not None and (number < low or (self.open_minimum and number == low)):
            self._refuse(value, "must be %s %g" % ("above" if self.open_minimum else "at least", low))
        if high is not None and number > high:
            self._refuse(value, "must be at most %g" % high)
        return number

    def _number(self, value):
        whole = self.kind in ("int", "choice")
        try:
            number = float(value)  # of whole numbers too: 1e6
        except (TypeError, ValueError, OverflowError):
            self._refuse(value, "must be a number")
        if isinstance(value, bool) or not math.isfinite(number) or (whole and not number.is_integer()):
            self._refuse(value, "must be a whole number" if whole else "must be finite")
        return int(number) if whole else number

    def _refuse(self, value, what):
        unit = " " + self.unit if self.unit else ""
        raise refusal("%s %s, not %r%s" % (self.name, what, value, unit))


OPTIONS = (
    Option(
        "max_size", "length", None, 0, 1e15,
        "largest edge length of the elements; automatic: 1/20 of the diagonal of the part",
        "MaxSize", "App::PropertyLength", "Size", "Max size", "mm", True, metavar="MM",
    ),
    Option(
        "min_size", "length", None, 0, None,
        "smallest edge length, given sizes included; automatic: 1/100 of Max size at curves, 1/50 at walls",
        "MinSize", "App::PropertyLength", "Size", "Min size", "mm", True, metavar="MM",
    ),
    Option(
        "growth", "float", 0.35, 0, 10,
        "how fast the size may grow: mm of size per mm of distance",
        "Growth", "App::PropertyFloat", "Size", "Growth rate", "", True, metavar="RATE",
    ),
    Option(
        "elements_per_circle", "float", 12.0, 0, 1000,
        "elements round a full circle of a curved face or edge; 0 ignores curvature",
        "ElementsPerCircle", "App::PropertyFloat", "Size", "Elements per circle", metavar="N",
    ),
    Option(
        "elements_across", "float", 2.0, 0, 100,
        "elements across thin walls and narrow gaps; 0 ignores them",
        "ElementsAcross", "App::PropertyFloat", "Size", "Elements across walls", metavar="N",
    ),
    Option(
        "order", "choice", 1, None, None,
        "1: straight elements with 4 nodes; 2: curved elements with 10 nodes",
        "ElementOrder", "App::PropertyEnumeration", "Elements", "Element order", choices=(1, 2),
    ),
    Option(
        "target_angle", "angle", 20.0, 0, 30,
        "smallest dihedral angle that the refinement aims at",
        "TargetAngle", "App::PropertyAngle", "Elements", "Target angle", "deg", metavar="DEG",
    ),
    Option(
        "optimise", "bool", True, None, None,
        "improve the elements after the refinement",
        "Optimise", "App::PropertyBool", "Elements", "Optimise",
    ),
    Option(
        "seed", "int", 1, 0, 2**31 - 1,
        "seed of the random numbers: the same seed gives the same mesh",
        "Seed", "App::PropertyInteger", "Run", "Seed", metavar="N",
    ),
    Option(
        "threads", "int", 0, 0, 1024,
        "threads; 0: all cores, at most 8. The mesh does not depend on it",
        "Threads", "App::PropertyInteger", "Run", "Threads", metavar="N",
    ),
    Option(
        "max_elements", "int", 0, 0, 2**31 - 1,
        "no mesh when it would have more tetrahedra; 0: as many as fit into memory",
        "MaxElements", "App::PropertyInteger", "Run", "Max elements", metavar="N",
    ),
)  # fmt: skip

BY_NAME = {option.name: option for option in OPTIONS}


@dataclass
class MeshOptions:
    """A validated set of options; every field but the last four is a row of OPTIONS (mm, degrees).

    sizes: {'Face3': 0.5, 'Edge1': 0.2, ...}, names as FreeCAD's, counted from 1.
    regions: list of sizing.Region.
    size_points (k, 3) and size_values (k,): sizes given on points, from an error estimate for instance.
    """

    max_size: Optional[float] = None
    min_size: Optional[float] = None
    growth: float = 0.35
    elements_per_circle: float = 12.0
    elements_across: float = 2.0
    order: int = 1
    target_angle: float = 20.0
    optimise: bool = True
    seed: int = 1
    threads: int = 0
    max_elements: int = 0
    sizes: Dict[str, float] = field(default_factory=dict)
    regions: List[Region] = field(default_factory=list)
    size_points: Any = None
    size_values: Any = None

    def __post_init__(self):
        for option in OPTIONS:
            setattr(self, option.name, option.check(getattr(self, option.name)))
        if self.max_size and self.min_size and self.min_size > self.max_size:
            raise refusal("min_size %g mm is larger than max_size %g mm" % (self.min_size, self.max_size))
        self.sizes = {name: _size_at(name, size) for name, size in dict(self.sizes).items()}
        self.regions = list(self.regions)
        for region in self.regions:
            region.check()
        self._check_size_points()

    def _check_size_points(self):
        if (self.size_points is None) != (self.size_values is None):
            raise refusal("size_points and size_values belong together")
        if self.size_points is None:
            return
        import numpy as np

        self.size_points = np.ascontiguousarray(self.size_points, dtype=np.float64)
        self.size_values = np.ascontiguousarray(self.size_values, dtype=np.float64)
        if self.size_points.ndim != 2 or self.size_points.shape != (len(self.size_values), 3):
            raise refusal("size_points must be (k, 3) and size_values (k,)")
        if not (np.isfinite(self.size_points).all() and np.isfinite(self.size_values).all()):
            raise refusal("size_points and size_values must be finite")
        if (self.size_values <= 0).any():
            raise refusal("size_values must be above 0", "bad_size")

    def with_changes(self, **changes):
        """A validated copy; raises InputError for an unknown option."""
        known = [item.name for item in dataclasses.fields(self)]
        for name in changes:
            if name not in known:
                raise refusal(
                    "there is no option %r; there are %s" % (name, ", ".join(known)), "unknown_option"
                )
        return dataclasses.replace(self, **changes)

    def used_threads(self):
        """Number of threads of a run."""
        return self.threads or min(MAX_AUTOMATIC_THREADS, os.cpu_count() or 1)


def make_options(options=None, **changes):
    """MeshOptions from None, a MeshOptions or a dict, with changes on top."""
    if options is None:
        options = MeshOptions()
    elif isinstance(options, dict):
        options = MeshOptions().with_changes(**options)
    elif not isinstance(options, MeshOptions):
        raise refusal("options must be a MeshOptions, not %s" % type(options).__name__)
    return options.with_changes(**changes) if changes else options


def _size_at(name, size):
    parse_name(name)
    try:
        number = float(size)
    except (TypeError, ValueError):
        raise refusal("the size at %s must be a number, not %r" % (name, size), "bad_size", name) from None
    if not math.isfinite(number) or number <= 0:
        raise refusal("the size at %s must be above 0 mm, not %r" % (name, size), "bad_size", name)
    return number
