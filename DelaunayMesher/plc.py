"""The piecewise linear complex: what the core takes.

From CAD it comes with exact geometry (document.plc_from_shape); from a bare triangulated surface,
from_triangles finds the solids (cells.py) and the features (features.py), and the triangles are the
geometry.
"""

from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional

import numpy as np

from . import cells, cleaning, features
from .errors import MeshError

CREASE_ANGLE = 40.0  # degrees: above the 30 of a 12-sided STL cylinder, below the 45 of a chamfer


@dataclass
class Plc:
    """Arrays in mm; all numbers count from 0 except solids (1-based, 0 = outside).

    points (n, 3) float64; triangles (m, 3) int32 with triangle_face (m,); segments (k, 2) with segment_edge
    (k,); corners (c,) with corner_vertex (c,); face_solids (F, 2): the solids behind and in front of the
    right-hand normal of each face's triangles. geometry: exact faces and edges as a dict of arrays
    (docs/plc.md), or None when the triangles are the geometry. warnings: what had to be repaired.
    """

    points: Any
    triangles: Any
    triangle_face: Any
    segments: Any
    segment_edge: Any
    corners: Any
    corner_vertex: Any
    face_solids: Any
    edge_count: int
    vertex_count: int
    solid_count: int
    geometry: Optional[Dict[str, Any]] = None
    warnings: List[str] = field(default_factory=list)
    solid_numbers: Any = None  # of some solids of a part only: their numbers there (1-based)
    cad_solid_count: int = 0  # and how many there are
    kept_faces: Any = ()  # that loads or groups refer to: never absorbed, however small
    kept_edges: Any = ()
    aliases: Dict[str, Dict[int, int]] = field(default_factory=dict)  # see cad_names.carrier()

    _SHAPES = (
        ("points", np.float64, (-1, 3)),
        ("triangles", np.int32, (-1, 3)),
        ("triangle_face", np.int32, (-1,)),
        ("segments", np.int32, (-1, 2)),
        ("segment_edge", np.int32, (-1,)),
        ("corners", np.int32, (-1,)),
        ("corner_vertex", np.int32, (-1,)),
        ("face_solids", np.int32, (-1, 2)),
        ("kept_faces", np.int32, (-1,)),
        ("kept_edges", np.int32, (-1,)),
    )

    def __post_init__(self):
        for name, dtype, shape in self._SHAPES:
            array = np.ascontiguousarray(getattr(self, name), dtype=dtype)
            setattr(self, name, array.reshape(shape) if array.size == 0 else array)
            if getattr(self, name).ndim != len(shape) or (
                len(shape) == 2 and array.shape[1:] != shape[1:] and array.size
            ):
                raise MeshError("plc", "bad_array", "%s has the shape %s" % (name, array.shape))

    def as_dict(self):
        """What the core takes."""
        arrays = {name: getattr(self, name) for name, _, _ in self._SHAPES}
        counts = {name: int(getattr(self, name)) for name in ("edge_count", "vertex_count", "solid_count")}
        return {**arrays, **counts}

    def check(self):
        """Raise MeshError at the first number that is out of range or not finite; the core checks the
        topology.
        """
        if len(self.triangles) == 0:
            raise MeshError("plc", "empty", "there is nothing to mesh: the surface has no triangles")
        if not np.isfinite(self.points).all():
            raise MeshError(
                "plc", "not_finite", "point %d has a coordinate that is no number" % _first_bad(self.points)
            )
        ranges = (
            ("triangles", len(self.points)),
            ("segments", len(self.points)),
            ("corners", len(self.points)),
            ("triangle_face", len(self.face_solids)),
            ("segment_edge", self.edge_count),
            ("corner_vertex", self.vertex_count),
            ("face_solids", self.solid_count + 1),
            ("kept_faces", len(self.face_solids)),
            ("kept_edges", self.edge_count),
        )
        for name, count in ranges:
            array = getattr(self, name)
            if array.size and (array.min() < 0 or array.max() >= count):
                raise MeshError(
                    "plc", "out_of_range", "%s holds a number outside 0 .. %d" % (name, count - 1)
                )
        for name, owner in (
            ("triangles", "triangle_face"),
            ("segments", "segment_edge"),
            ("corners", "corner_vertex"),
        ):
            if len(getattr(self, name)) != len(getattr(self, owner)):
                raise MeshError("plc", "bad_array", "%s and %s differ in length" % (name, owner))

    @property
    def element_counts(self):
        """{'Vertex', 'Edge', 'Face', 'Solid': how many the whole part has}"""
        return {
            "Vertex": self.vertex_count,
            "Edge": self.edge_count,
            "Face": len(self.face_solids),
            "Solid": self.cad_solid_count or self.solid_count,
        }

    def volume(self, solid):
        """Volume of one solid (1-based) in mm3, from its triangles."""
        sides = self.face_solids[self.triangle_face]
        sign = (sides[:, 0] == solid).astype(float) - (sides[:, 1] == solid)
        return float(sign @ cells.signed_volumes(self.points, self.triangles))

    @classmethod
    def from_triangles(
        cls, points, triangles, labels=None, crease_angle=CREASE_ANGLE, holes=None, nested="cavity"
    ):
        """PLC of a closed triangulated surface without CAD.

        points (n, 3), triangles (m, 3), any order and orientation; duplicate points are merged. labels
        (m,): a face never crosses from one label to another. crease_angle in degrees: two triangles that
        turn by more meet in a feature edge. A shell inside a solid is a cavity; nested='solid' makes every
        closed region a solid except those with a point of `holes` (k, 3) in them. Raises MeshError naming
        the place of an open edge, an overlap, an empty or flat surface.
        """
        points, triangles, labels, warnings = cleaning.clean(points, triangles, labels)
        plc = cls.from_clean_triangles(points, triangles, labels, crease_angle, holes, nested)
        plc.warnings[:0] = warnings
        return plc

    @classmethod
    def from_clean_triangles(
        cls, points, triangles, labels, crease_angle=CREASE_ANGLE, holes=None, nested="cavity"
    ):
        """from_triangles() of what cleaning.clean() returns."""
        front_back = cells.find_cells(points, triangles, holes=holes, nested=nested)
        keep = front_back.any(axis=1)
        triangles, labels, front_back = triangles[keep], labels[keep], front_back[keep]
        flip = (front_back[:, 1] == 0) | ((front_back[:, 0] != 0) & (front_back[:, 0] < front_back[:, 1]))
        triangles[flip] = triangles[flip][:, ::-1]
        front_back[flip] = front_back[flip][:, ::-1]
        behind_front = front_back[:, ::-1]
        found = features.find_features(points, triangles, labels, behind_front, crease_angle)
        points, triangles, segments, corners = cleaning.drop_unused(
            points, triangles, found.segments, found.corners
        )
        return cls(
            points,
            triangles,
            found.triangle_face,
            segments,
            found.segment_edge,
            corners,
            np.arange(len(corners)),
            found.face_solids,
            found.edge_count,
            len(corners),
            int(front_back.max(initial=0)),
        )


def _first_bad(points):
    return int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
