"""Our mesh -> FreeCAD's FemMesh.

Node numbers are ours plus one.  FreeCAD's tetrahedra are mirror images of VTK's, so the nodes are permuted.
The boundary triangles and edges must be there: without them FreeCAD loses force on curved faces.  Groups
FaceN, EdgeN (elements on a CAD face or edge) and SolidN (volumes) always; more with `groups`.  Cost: about 3
microseconds per tetrahedron.
"""

import numpy as np

AT_ONCE = 2000  # elements in one call of FreeCAD: meanwhile no other thread runs, that of the window neither
TETRAHEDRON = {4: [1, 0, 2, 3], 10: [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]}


def fem_mesh(mesh, groups=(), aliases=None):
    """Fem.FemMesh of a Mesh.

    groups: (name, names of CAD elements) pairs, such as ("Press", ["Face1", "Face4"]).  aliases:
    touching.Aliases; CAD elements that were merged into others have groups as well.
    """
    import Fem

    target = Fem.FemMesh()
    add_nodes(target, mesh.points)
    members = {
        "Edge": add_elements(target, "Edge", mesh.lines, 1),
        "Face": add_elements(target, "Face", mesh.triangles, 1 + len(mesh.lines)),
        "Volume": add_elements(
            target,
            "Volume",
            mesh.tets[:, TETRAHEDRON[mesh.tets.shape[1]]],
            1 + len(mesh.lines) + len(mesh.triangles),
        ),
    }
    collected = element_groups(mesh, members, aliases or mesh.aliases)
    for name, (kind, numbers) in collected.items():
        add_group(target, name, kind, numbers)
    for name, elements in groups:
        add_named_group(target, name, elements, collected, mesh)
    return target


def add_nodes(target, points):
    """Nodes 1 .. n."""
    add = target.addNode
    for number, (x, y, z) in enumerate(points.tolist(), 1):
        add(x, y, z, number)


def add_elements(target, kind, nodes, first):
    """Elements first, first + 1, ... from (n, k) 0-based node numbers; returns their numbers (n,) int64."""
    nodes = np.asarray(nodes, dtype=np.int64) + 1
    numbers = np.arange(first, first + len(nodes))
    add_list = getattr(target, "add%sList" % kind, None)  # FreeCAD 1.0
    add = getattr(target, "add%s" % kind)
    for start in range(0, len(nodes), AT_ONCE):
        block = nodes[start : start + AT_ONCE]
        if add_list:
            numbers[start : start + AT_ONCE] = add_list(block.ravel().tolist(), [block.shape[1]] * len(block))
            continue
        for number, element in enumerate(block.tolist(), first + start):
            add(element, number)
    return numbers


def element_groups(mesh, members, aliases):
    """{'Face3': ('Face', element numbers), ...} of all CAD elements that have mesh elements."""
    groups = {}
    for prefix, kind, owner, offset in (
        ("Edge", "Edge", mesh.line_edge, 1),
        ("Face", "Face", mesh.triangle_face, 1),
        ("Solid", "Volume", mesh.tet_solid, 0),
    ):
        order = np.argsort(owner, kind="stable")
        owners, starts = np.unique(owner[order], return_index=True)
        for index, numbers in zip(owners.tolist(), np.split(members[kind][order], starts[1:])):
            if index + offset > 0:
                groups["%s%d" % (prefix, index + offset)] = (kind, numbers)
    for prefix, table in (("Face", "faces"), ("Edge", "edges")):
        for dropped, kept in getattr(aliases, table, {}).items():
            source = groups.get("%s%d" % (prefix, kept + 1))
            if source:
                groups["%s%d" % (prefix, dropped + 1)] = source
    return groups


def add_group(target, name, kind, numbers):
    """One group of element (or node) numbers."""
    group = target.addGroup(name, kind)
    for start in range(0, len(numbers), AT_ONCE):
        target.addGroupElements(group, numbers[start : start + AT_ONCE].tolist())


def add_named_group(target, name, elements, collected, mesh):
    """The union of the groups of some CAD elements under one name; vertices become a node group."""
    kinds = {}
    for element in elements:
        if element in collected:
            kind, numbers = collected[element]
            kinds.setdefault(kind, []).append(numbers)
        elif element.startswith("Vertex"):
            kinds.setdefault("Node", []).append(mesh.nodes_of(element) + 1)
    for kind, blocks in kinds.items():
        label = name if len(kinds) == 1 else "%s_%s" % (name, kind)
        add_group(target, label, kind, np.unique(np.concatenate(blocks)))
