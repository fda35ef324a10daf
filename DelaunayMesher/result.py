"""The finished mesh with everything that is known about it."""

from dataclasses import dataclass, field
from typing import Any, Dict, List

import numpy as np

from .cad_names import carrier
from .errors import entity_name, in_number


@dataclass
class Mesh:
    """Arrays in mm; numbers count from 0 except solids (1-based, 0 = outside).

    points (n, 3) float64, mid-side nodes last; point_dimension (n,) int8 and point_entity (n,) int32: the
    CAD vertex (0), edge (1), face (2) or solid (3) that each point lies on; tets (t, 4 | 10) int32 in VTK
    order with tet_solid (t,); triangles (b, 3 | 6) of boundary and interfaces with triangle_face (b,);
    lines (l, 2 | 3) with line_edge (l,). below_target: elements under the target angle as dicts of tet,
    angle, reason, entity, place. straightened: tetrahedra whose curved boundary edge had to stay straight.
    element_counts: 'Vertex', 'Edge', 'Face', 'Solid' -> how many the part has, with and without nodes.
    seconds: stage -> time, in order. aliases: 'Face', 'Edge', 'Vertex' -> {number: that of the one at the
    same place that has its elements}, where solids touch.
    """

    points: Any
    point_dimension: Any
    point_entity: Any
    tets: Any
    tet_solid: Any
    triangles: Any
    triangle_face: Any
    lines: Any
    line_edge: Any
    straightened: Any
    below_target: List[Dict[str, Any]]
    options: Any
    element_counts: Dict[str, int]
    seconds: Dict[str, float] = field(default_factory=dict)
    statistics: Dict[str, float] = field(default_factory=dict)
    warnings: List[str] = field(default_factory=list)
    total_seconds: float = 0.0
    shape: Any = None
    aliases: Dict[str, Dict[int, int]] = field(default_factory=dict)
    _quality: Any = None

    @property
    def order(self):
        return 2 if self.tets.shape[1] == 10 else 1

    @property
    def status(self):
        """'ok', or 'usable' when an element is below the target for another reason than the input's own
        angles.
        """
        return "usable" if any(item["reason"] != "input_angle" for item in self.below_target) else "ok"

    @property
    def quality(self):
        """Summary of quality.py, computed once."""
        if self._quality is None:
            from . import quality

            self._quality = quality.summary(self.points, self.tets)
        return self._quality

    def nodes_of(self, name):
        """Sorted numbers of the points on 'Face3', 'Edge1', 'Vertex2' (mid-side nodes too) or in 'Solid1'.

        Empty for an element that was absorbed; raises InputError for one that the part does not have.
        """
        kind, index = carrier(name, self.element_counts, self.aliases)
        if kind == "Solid":
            return np.unique(self.tets[self.tet_solid == index + 1])
        if kind == "Face":
            return np.unique(self.triangles[self.triangle_face == index])
        if kind == "Edge":
            return np.unique(self.lines[self.line_edge == index])
        return np.flatnonzero((self.point_dimension == 0) & (self.point_entity == index))

    def vertex_points(self):
        """{'Vertex1': numbers of its points (n,), ...} of all CAD vertices that have any; several where
        solids were meshed apart.
        """
        points = np.flatnonzero(self.point_dimension == 0)
        found = {index: points[rows] for index, rows in rows_by_owner(self.point_entity[points])}
        for dropped, kept in self.aliases.get("Vertex", {}).items():
            if kept in found:
                found[dropped] = found[kept]
        return {"Vertex%d" % (index + 1): rows for index, rows in found.items()}

    def element_rows(self):
        """{'Edge1': ('Edge', rows (n,) of lines), 'Face3': ('Face', of triangles), 'Solid1': ('Volume', of
        tets), ...} of all CAD elements that have mesh elements.

        Those that were merged into others (`aliases`) have the rows of these.
        """
        found = {}
        for prefix, kind, owner, offset in (
            ("Edge", "Edge", self.line_edge, 1),
            ("Face", "Face", self.triangle_face, 1),
            ("Solid", "Volume", self.tet_solid, 0),
        ):
            for index, rows in rows_by_owner(owner):
                if index + offset > 0:
                    found["%s%d" % (prefix, index + offset)] = (kind, rows)
        for prefix in ("Face", "Edge"):
            for dropped, kept in self.aliases.get(prefix, {}).items():
                source = found.get("%s%d" % (prefix, kept + 1))
                if source:
                    found["%s%d" % (prefix, dropped + 1)] = source
        return found

    def write(self, path):
        """Write the mesh; the ending decides the format (meshfile.write_mesh)."""
        from .meshfile import write_mesh

        write_mesh(path, self)

    def report(self):
        """The JSON report as a dict (report.py)."""
        from .report import mesh_report

        return mesh_report(self)


def rows_by_owner(owner):
    """(owner, its rows (n,) in order) for each number that occurs in `owner` (m,)."""
    order = np.argsort(owner, kind="stable")
    owners, starts = np.unique(owner[order], return_index=True)
    return zip(owners.tolist(), np.split(order, starts[1:]))


def mesh_from_core(result, options, element_counts, warnings=()):
    """Mesh from the dict that _core.mesh returns."""
    below = result["below_target"]
    items = [
        {
            "tet": int(tet),
            "angle": float(angle),
            "reason": reason,
            "entity": entity_name(dimension, entity),
            "place": place,
        }
        for tet, angle, reason, dimension, entity, place in zip(
            below["tet"],
            below["angle"],
            below["reason"],
            below["dimension"],
            below["entity"],
            below["place"].tolist(),
        )
    ]
    arrays = (
        "points",
        "point_dimension",
        "point_entity",
        "tets",
        "tet_solid",
        "triangles",
        "triangle_face",
        "lines",
    )
    return Mesh(
        **{name: result[name] for name in (*arrays, "line_edge", "straightened")},
        below_target=items,
        options=options,
        element_counts=element_counts,
        seconds=dict(result["seconds"]),
        statistics=dict(result["statistics"]),
        warnings=[*warnings, *map(in_number, result["warnings"])],
        aliases=result["aliases"],
    )
