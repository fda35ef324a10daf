"""Our mesh -> FreeCAD's FemMesh.

Node numbers are ours plus one.  FreeCAD's tetrahedra are mirror images of VTK's, so the nodes are permuted.
The boundary triangles and edges must be there: without them FreeCAD loses force on curved faces.  Groups
FaceN, EdgeN (elements on a CAD face or edge) and SolidN (volumes) always; more with `groups`.

A document's object is filled in two steps, because FreeCAD copies what is assigned, and groups make half of
that work: first the elements, then the groups in the object's own mesh, which FreeCAD allows for groups.
"""

from dataclasses import dataclass
from itertools import starmap
from typing import Any, List, Tuple

import numpy as np

from ..errors import MeshError

AT_ONCE = 2000  # rows turned into Python's lists; no other thread runs meanwhile, that of the window neither
SMALLEST_PART, MOST_PARTS = 25000, 20  # of a group at once: each part costs FreeCAD a walk over all elements
AS_ARGUMENTS = {"Node": 3, "Edge": 2, "Face": 3, "Volume": 4}
TETRAHEDRON = {4: [1, 0, 2, 3], 10: [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]}


def fem_mesh(mesh, groups=()):
    """Fem.FemMesh of a Mesh, complete.

    groups: (name, names of CAD elements) pairs, such as ("Press", ["Face1", "Face4"]).  CAD elements that
    were merged into others have groups as well.
    """
    filling = fill(mesh, groups)
    for _ in add_groups(filling.elements, filling.groups):
        pass
    return filling.elements


@dataclass
class Filling:
    """For a document's object: a Fem.FemMesh without groups, and the groups: (name, kind, numbers (n,))."""

    elements: Any
    groups: List[Tuple[str, str, np.ndarray]]


def fill(mesh, groups=()):
    """The Filling of a Mesh, in any thread; groups as in fem_mesh."""
    elements, members = all_elements(mesh)
    return Filling(elements, all_groups(mesh, members, groups))


def put(target, filling):
    """Put a Filling into a document's object, in the window's thread.

    A generator, to be exhausted: it yields after the elements and then every 50 ms or so.
    """
    target.FemMesh = filling.elements
    yield
    yield from add_groups(target.FemMesh, filling.groups)


def all_elements(mesh):
    """(Fem.FemMesh without groups, {kind: element numbers (n,)})"""
    import Fem

    target = Fem.FemMesh()
    add(target, "Node", mesh.points, 1)
    first, members = 1, {}
    for kind, nodes in (
        ("Edge", mesh.lines),
        ("Face", mesh.triangles),
        ("Volume", mesh.tets[:, TETRAHEDRON[mesh.tets.shape[1]]]),
    ):
        add(target, kind, nodes + 1, first)
        members[kind] = np.arange(first, first + len(nodes))
        first += len(nodes)
    return target, members


def add(target, kind, rows, first):
    """Add a node or element for each row: coordinates (n, 3) or numbers of nodes (n, k).

    FreeCAD numbers them first, first + 1, ...: it is twice as fast when it is not told the numbers, and with
    the nodes as arguments, which it takes for elements without mid-side nodes.
    """
    add_one = getattr(target, "add%s" % kind)
    call = starmap if rows.shape[1] == AS_ARGUMENTS[kind] else map
    last = first - 1
    for start in range(0, len(rows), AT_ONCE):
        for last in call(add_one, rows[start : start + AT_ONCE].tolist()):  # noqa: B007
            pass
    if last != first + len(rows) - 1:
        raise MeshError("write", "numbering", "FreeCAD numbered the mesh otherwise: %s %d" % (kind, last))


def add_groups(target, groups):
    """Generator that adds (name, kind, numbers) groups to a FemMesh; yields now and then."""
    for name, kind, numbers in groups:
        group = target.addGroup(name, kind)
        part = max(SMALLEST_PART, len(numbers) // MOST_PARTS)
        for start in range(0, len(numbers), part):
            target.addGroupElements(group, numbers[start : start + part].tolist())
            yield


def all_groups(mesh, members, groups):
    """(name, kind, numbers (n,)) of the groups of all CAD elements and of the `groups` asked for."""
    rows = mesh.element_rows()
    collected = {name: (kind, members[kind][own]) for name, (kind, own) in rows.items()}
    result = [(name, kind, numbers) for name, (kind, numbers) in collected.items()]
    for name, names in groups:
        result += named_groups(name, names, collected, mesh)
    return result


def named_groups(name, names, collected, mesh):
    """The union of the groups of some CAD elements under one name; vertices become a node group."""
    kinds = {}
    for element in names:
        if element in collected:
            kind, numbers = collected[element]
            kinds.setdefault(kind, []).append(numbers)
        elif element.startswith("Vertex"):
            kinds.setdefault("Node", []).append(mesh.nodes_of(element) + 1)
    return [
        (name if len(kinds) == 1 else "%s_%s" % (name, kind), kind, np.unique(np.concatenate(blocks)))
        for kind, blocks in kinds.items()
    ]
