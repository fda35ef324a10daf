"""FreeCAD's FEM module on our meshes: it finds our nodes, its forces arrive whole, its cantilever bends
right.
"""

import functools
import re

import FreeCAD
import numpy as np
import ObjectsFem
import Part
import pytest
from femtools.ccxtools import FemToolsCcx
from parts import PARTS, SIZES

from DelaunayMesher import document, pipeline
from DelaunayMesher.cadprocess import CadProcess
from DelaunayMesher.quality import volumes


@functools.lru_cache(maxsize=None)
def meshed(name, order):
    """(shape, Mesh, FemMesh) of a part; made once for all tests."""
    shape = PARTS[name]()
    mesh = document.mesh_shape(shape, document.make_options(max_size=SIZES[name], order=order))
    return shape, mesh, document.fem_mesh(mesh)


both_orders = pytest.mark.parametrize("order", [1, 2])
every_part = pytest.mark.parametrize("name", PARTS)
quick_or_all = pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.long)])


def one_of_each_kind(shapes, geometry, every):
    """Numbers (from 1) of the shapes to look at: all, or the smallest of each kind of geometry."""
    if every:
        return range(1, len(shapes) + 1)
    smallest = {}
    for number in sorted(range(len(shapes)), key=lambda n: shapes[n].BoundBox.DiagonalLength):
        if not getattr(shapes[number], "Degenerated", False):
            smallest.setdefault(type(geometry(shapes[number])).__name__, number + 1)
    return sorted(smallest.values())


@every_part
@both_orders
@quick_or_all
def test_nodes_on_faces_are_ours(name, order, every):
    shape, mesh, filled = meshed(name, order)
    for number in one_of_each_kind(shape.Faces, lambda face: face.Surface, every):
        ours = mesh.nodes_of("Face%d" % number) + 1
        assert sorted(filled.getNodesByFace(shape.Faces[number - 1])) == ours.tolist()


@every_part
@both_orders
@quick_or_all
def test_nodes_on_edges_are_ours(name, order, every):
    shape, mesh, filled = meshed(name, order)
    carried = set(mesh.line_edge.tolist())
    for number in one_of_each_kind(shape.Edges, lambda edge: edge.Curve, every):
        edge, number = shape.Edges[number - 1], number - 1
        if number in carried:
            ours = mesh.nodes_of("Edge%d" % (number + 1)) + 1
            assert sorted(filled.getNodesByEdge(edge)) == ours.tolist()


@every_part
@both_orders
def test_elements_and_groups(name, order):
    shape, mesh, filled = meshed(name, order)
    counts = (filled.NodeCount, filled.VolumeCount, filled.FaceCount, filled.EdgeCount)
    assert counts == (len(mesh.points), len(mesh.tets), len(mesh.triangles), len(mesh.lines))
    assert (volumes(mesh.points, mesh.tets) > 0).all()
    if order == 2:  # FreeCAD 0.20 says 0 for elements with 4 nodes
        assert filled.Volume.Value == pytest.approx(volumes(mesh.points, mesh.tets).sum(), rel=0.05)
    groups = {filled.getGroupName(number): number for number in filled.Groups}
    kinds = {name: filled.getGroupElementType(number) for name, number in groups.items()}
    assert {name for name, kind in kinds.items() if kind == "Face"} == {
        "Face%d" % (number + 1) for number in range(len(shape.Faces))
    }
    assert kinds["Solid1"] == "Volume"
    assert len(filled.getGroupElements(groups["Solid1"])) == len(mesh.tets)
    first = filled.getGroupElements(groups["Face1"])
    nodes = {node for element in first for node in filled.getElementNodes(element)}
    assert sorted(nodes) == (mesh.nodes_of("Face1") + 1).tolist()


def analysis_with(file, part, filled, constraints):
    """(analysis, solver) with steel, a mesh and constraints."""
    analysis = ObjectsFem.makeAnalysis(file, "Analysis")
    solver = document.add_solver(analysis)
    material = ObjectsFem.makeMaterialSolid(file, "Steel")
    card = material.Material
    card.update(Name="Steel", YoungsModulus="210000 MPa", PoissonRatio="0.30")
    material.Material = card
    holder = file.addObject("Fem::FemMeshObject", "Mesh")
    holder.FemMesh = filled
    for item in (material, holder, *constraints):
        analysis.addObject(item)
    return analysis, solver


def input_file(analysis, solver, folder):
    """The text of the CalculiX input."""
    tool = FemToolsCcx(analysis, solver, test_mode=True)
    tool.update_objects()
    tool.setup_working_dir(str(folder), create=True)
    assert tool.check_prerequisites() == ""
    tool.write_inp_file()
    with open(tool.inp_file_name) as stream:
        return stream.read()


def force_of(text, name):
    """Sum of the nodal forces (3,) that the input file writes for a constraint."""
    total = np.zeros(3)
    block = re.search(r"^\*\* %s$(.*?)(?=^\*\* Pull\d+$|^\*\*\*)" % name, text, re.M | re.S).group(1)
    for direction, value in re.findall(r"^\d+,([123]),([-+.\dEe]+)$", block, re.M):
        total[int(direction) - 1] += float(value)
    return total


# FreeCAD gives every facet its share of the CAD face's area.  Facets of a round face fall short of it by the
# square of their size, so the force does as well: by 0.7 % on a disc with 12 elements per circle and order 2,
# and 4 times that at order 1.
PER_CIRCLE = {1: 50.0, 2: 24.0}
FORCED = [
    ("box", 1),
    ("box", 2),
    ("cylinder", 2),
    ("sphere", 2),
    ("cone_frustum", 2),
    *(
        pytest.param(name, order, marks=pytest.mark.long)
        for name, order in (
            ("cylinder", 1),
            ("sphere", 1),
            ("torus", 1),
            ("torus", 2),
            ("cone_frustum", 1),
            ("lofted", 1),
            ("lofted", 2),
            ("bracket", 1),
            ("bracket", 2),
            ("plate", 2),
        )
    ),
]


@pytest.mark.parametrize("name, order", FORCED)
def test_a_force_on_any_face_arrives_whole(name, order, tmp_path, request):
    shape = PARTS[name]()
    options = document.make_options(max_size=SIZES[name], order=order, elements_per_circle=PER_CIRCLE[order])
    filled = document.fem_mesh(document.mesh_shape(shape, options))
    every = request.node.get_closest_marker("long") is not None
    numbers = one_of_each_kind(shape.Faces, lambda face: face.Surface, every)
    file = FreeCAD.newDocument("forces")
    try:
        part, up = file.addObject("Part::Feature", "Part"), file.addObject("Part::Box", "Up")
        part.Shape = shape
        file.recompute()
        constraints = [ObjectsFem.makeConstraintFixed(file, "Fixed")]
        constraints[0].References = [(part, "Face1")]
        for number in numbers:
            force = ObjectsFem.makeConstraintForce(file, "Pull%d" % number)
            force.References = [(part, "Face%d" % number)]
            force.Force = 1000.0 if FreeCAD.Version()[0] == "0" else "1000 N"
            force.Direction = (up, ["Face6"])
            constraints.append(force)
        file.recompute()
        text = input_file(*analysis_with(file, part, filled, constraints), tmp_path)
        for number in numbers:
            force = force_of(text, "Pull%d" % number)
            assert abs(force[2]) == pytest.approx(1000, rel=0.005)
            assert np.abs(force[:2]).max() < 1e-6
    finally:
        FreeCAD.closeDocument(file.Name)


def solved(analysis, solver, folder):
    """The largest displacement that CalculiX finds."""
    tool = FemToolsCcx(analysis, solver)
    tool.update_objects()
    tool.setup_working_dir(str(folder), create=True)
    tool.setup_ccx()
    assert tool.check_prerequisites() == ""
    tool.purge_results()
    tool.write_inp_file()
    tool.ccx_run()
    tool.load_results()
    result = next(item for item in analysis.Group if item.isDerivedFrom("Fem::FemResultObject"))
    return max(result.DisplacementLengths)


def test_freecads_cantilever_bends_as_beam_theory_and_gmsh_say(tmp_path):
    from femexamples.ccx_cantilever_faceload import setup

    file = setup()
    try:
        analysis, part = file.Analysis, file.Box
        old = next(item for item in analysis.Group if item.isDerivedFrom("Fem::FemMeshObject"))
        solver = next(item for item in analysis.Group if item.isDerivedFrom("Fem::FemSolverObject"))
        gmsh_says = solved(analysis, solver, tmp_path)
        analysis.removeObject(old)
        file.removeObject(old.Name)
        mesh = document.add_mesh(part, analysis=analysis, max_size=500.0, order=2)
        document.run(mesh)
        length, side, force, young, poisson = 8000.0, 1000.0, 9e6, 210000.0, 0.3
        inertia, area, shear = side**4 / 12, side**2, young / (2 * (1 + poisson))
        theory = force * length**3 / (3 * young * inertia) + force * length / (5 / 6 * shear * area)
        we_say = solved(analysis, solver, tmp_path)
        assert we_say == pytest.approx(theory, rel=0.02)
        assert we_say == pytest.approx(gmsh_says, rel=0.02)
    finally:
        FreeCAD.closeDocument(file.Name)


def test_touching_solids_have_groups_on_both_sides():
    first = Part.makeBox(10, 10, 10)
    second = Part.makeBox(10, 10, 10, FreeCAD.Vector(10, 0, 0))
    mesh = document.mesh_shape(Part.makeCompound([first, second]), document.make_options(max_size=4.0))
    filled = document.fem_mesh(mesh)
    names = {filled.getGroupName(number) for number in filled.Groups}
    assert names >= {"Face%d" % number for number in range(1, 13)} | {"Solid1", "Solid2"}
    assert {"Edge%d" % number for number in range(1, 25)} <= names
    assert volumes(mesh.points, mesh.tets[mesh.tet_solid == 2]).sum() == pytest.approx(1000)


def touching_boxes():
    """(shape, pairs of names of elements at the same place) of two boxes that lie side by side."""
    shape = Part.makeCompound([Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, FreeCAD.Vector(10, 0, 0))])
    pairs = []
    for kind, elements in (("Face", shape.Faces), ("Edge", shape.Edges), ("Vertex", shape.Vertexes)):
        places = [tuple(round(x, 6) for x in element.CenterOfGravity) for element in elements]
        pairs += [
            ("%s%d" % (kind, places.index(place) + 1), "%s%d" % (kind, number + 1))
            for number, place in enumerate(places)
            if places.index(place) < number
        ]
    return shape, pairs


def test_both_names_of_a_merged_element_hold():
    shape, pairs = touching_boxes()
    assert sorted(name.rstrip("0123456789") for name, _ in pairs) == ["Edge"] * 4 + ["Face"] + ["Vertex"] * 4
    coarse = len(document.mesh_shape(shape, {"max_size": 4}).tets)
    for names in pairs[0], pairs[1], pairs[-1]:
        meshes = [document.mesh_shape(shape, {"max_size": 4, "sizes": {name: 0.7}}) for name in names]
        assert len(meshes[0].tets) == len(meshes[1].tets) > 1.5 * coarse
        for mesh in meshes:
            first, second = (mesh.nodes_of(name) for name in names)
            assert len(first) > 0 and first.tolist() == second.tolist()
    first, second = pairs[0]
    fine, both = ({"max_size": 4, "sizes": sizes} for sizes in ({first: 0.7}, {first: 0.7, second: 2.0}))
    assert len(document.mesh_shape(shape, both).tets) == len(document.mesh_shape(shape, fine).tets)


def test_files_from_another_process_have_both_names_of_a_merged_element(tmp_path):
    shape, pairs = touching_boxes()
    path, written = str(tmp_path / "two.brep"), tmp_path / "two.inp"
    shape.exportBrep(path)
    with CadProcess(path) as source:
        mesh = pipeline.run(source, {"max_size": 4})
    mesh.write(written)
    sets = {}
    for line in written.read_text().splitlines():
        if line.startswith("*"):
            rows = sets.setdefault(line.rpartition("=")[2], [])
        else:
            rows.append(line)
    for first, second in pairs:
        assert sets[first] == sets[second] and sets[first]


@both_orders
def test_overlapping_solids_are_meshed_apart(order):
    first = Part.makeBox(10, 10, 10)
    second = Part.makeBox(10, 10, 10, FreeCAD.Vector(10, 3, 4))
    third = Part.makeBox(10, 10, 10, FreeCAD.Vector(5, -5, -5))  # inside the first as well
    shape = Part.makeCompound([first, second, third])
    options = document.make_options(max_size=4.0, order=order, sizes={"Solid3": 2.5, "Face7": 1.5})
    mesh = document.mesh_shape(shape, options)
    assert any("fit together" in text for text in mesh.warnings)
    parts = [mesh.tets[mesh.tet_solid == number] for number in (1, 2, 3)]
    for tets in parts:
        assert volumes(mesh.points, tets).sum() == pytest.approx(1000)
    assert len(parts[2]) > 2 * len(parts[0]) and len(parts[1]) > len(parts[0])
    assert set(mesh.triangle_face) == set(range(18)) and set(mesh.line_edge) == set(range(36))
    for number, face in enumerate(shape.Faces):
        nodes = mesh.points[mesh.nodes_of("Face%d" % (number + 1))]
        assert max(face.distToShape(Part.Vertex(*node))[0] for node in nodes[:20]) < 1e-7
    corners = np.unique(mesh.tets[:, :4])
    assert corners.max() == len(corners) - 1  # mid-side nodes come last
    filled = document.fem_mesh(mesh)
    assert {"Solid1", "Solid2", "Solid3"} <= {filled.getGroupName(number) for number in filled.Groups}
