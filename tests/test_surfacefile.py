import struct

import numpy as np
import pytest
from sample_surfaces import box, cylinder, joined, sphere, volume, write_stl

from DelaunayMesher.errors import InputError
from DelaunayMesher.plc import Plc
from DelaunayMesher.surfacefile import read_surface

QUADS = ["0 1 3 2", "4 6 7 5", "0 4 5 1", "2 3 7 6", "0 2 6 4", "1 5 7 3"]


def off(points, triangles):
    lines = ["OFF  # a comment", "%d %d 0" % (len(points), len(triangles))]
    lines += ["%.17g %.17g %.17g" % tuple(p) for p in points]
    lines += ["3 %d %d %d 255 0 0" % tuple(t) for t in triangles]
    return "\n".join(lines)


def obj(points, triangles):
    lines = ["# a comment", "mtllib none.mtl"] + ["v %.17g %.17g %.17g" % tuple(p) for p in points]
    return "\n".join(lines + ["f %d/1 %d/1/2 %d//3" % tuple(t + 1) for t in triangles])


def medit(points, triangles):
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += ["%.17g %.17g %.17g 0" % tuple(p) for p in points]
    lines += ["Triangles", str(len(triangles))] + ["%d %d %d 1" % tuple(t + 1) for t in triangles] + ["End"]
    return "\n".join(lines)


def smesh(points, triangles):
    lines = ["%d 3 0 0" % len(points)] + ["%d %.17g %.17g %.17g" % (i, *p) for i, p in enumerate(points)]
    lines += ["%d 0" % len(triangles)] + ["3 %d %d %d" % tuple(t) for t in triangles] + ["0", "0"]
    return "\n".join(lines)


def ply(points, triangles):
    return "\n".join(
        ["ply", "format ascii 1.0", "comment x", "element vertex %d" % len(points)]
        + ["property double " + axis for axis in "xyz"]
        + ["element face %d" % len(triangles), "property list uchar int vertex_indices", "end_header"]
        + ["%.17g %.17g %.17g" % tuple(p) for p in points]
        + ["3 %d %d %d" % tuple(t) for t in triangles]
    )


def check(path, expected, precision=1e-9):
    surface = read_surface(path)
    plc = Plc.from_triangles(*surface[:3], holes=surface.holes, nested=surface.nested)
    assert plc.solid_count == 1
    assert plc.volume(1) == pytest.approx(expected, rel=precision)


@pytest.mark.parametrize("make", [box, cylinder, sphere])
@pytest.mark.parametrize("writer", [off, obj, medit, smesh, ply])
def test_text_formats(tmp_path, writer, make):
    points, triangles = make()
    path = tmp_path / ("a." + {"medit": "mesh"}.get(writer.__name__, writer.__name__))
    path.write_text(writer(points, triangles))
    check(path, volume(points, triangles))


def test_text_and_binary_stl(tmp_path):
    points, triangles = sphere()
    write_stl(tmp_path / "text.STL", points, triangles)
    check(tmp_path / "text.STL", volume(points, triangles), 1e-6)
    for header in (b"binary", b"solid but binary"):
        data = header.ljust(80, b" ") + struct.pack("<I", len(triangles))
        for corners in points[triangles]:
            data += struct.pack("<12fH", 0, 0, 0, *corners.reshape(-1), 0)
        (tmp_path / "binary.stl").write_bytes(data)
        check(tmp_path / "binary.stl", volume(points, triangles), 1e-6)


def test_binary_stl_whose_head_says_no_triangles(tmp_path):
    points, triangles = sphere()
    record = b"".join(struct.pack("<12fH", 0, 0, 0, *c.reshape(-1), 0) for c in points[triangles])
    (tmp_path / "a.stl").write_bytes(bytes(84) + record)
    check(tmp_path / "a.stl", volume(points, triangles), 1e-6)
    for cut in (record[:0], record[:-1]):
        (tmp_path / "a.stl").write_bytes(bytes(84) + cut)
        with pytest.raises(InputError, match="no triangles"):
            read_surface(tmp_path / "a.stl")


@pytest.mark.parametrize("writer", [off, obj, medit, smesh, ply])
def test_byte_order_marks(tmp_path, writer):
    path = tmp_path / ("a." + {"medit": "mesh"}.get(writer.__name__, writer.__name__))
    path.write_text(writer(*box()), encoding="utf-8-sig")
    check(path, 1)
    write_stl(tmp_path / "a.stl", *box())
    (tmp_path / "a.stl").write_text((tmp_path / "a.stl").read_text(), encoding="utf-8-sig")
    check(tmp_path / "a.stl", 1)


def test_obj_lines_that_go_on(tmp_path):
    text = "\n".join(["v " + " ".join(map(str, p)) for p in box()[0]])
    text += "".join("\nf %d \\\n  %d %d\\\n %d" % tuple(int(n) + 1 for n in quad.split()) for quad in QUADS)
    (tmp_path / "a.obj").write_text(text)
    check(tmp_path / "a.obj", 1)


@pytest.mark.parametrize("digits", [3, 26, 27, 60])
def test_text_stl_numbers_of_any_length(tmp_path, digits):
    corners = -20 * box()[0][box()[1]].reshape(-1, 3)
    lines = ["vertex " + " ".join("%.*e" % (digits, x) for x in corner) for corner in corners]
    (tmp_path / "a.stl").write_text("\n".join(["solid x", *lines]))
    assert np.array_equal(read_surface(tmp_path / "a.stl").points, corners)


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_ply(tmp_path, order):
    points, triangles = sphere()
    name = {"<": "little", ">": "big"}[order]
    head = ["ply", "format binary_%s_endian 1.0" % name, "element vertex %d" % len(points)]
    head += ["property float " + axis for axis in "xyz"] + ["property uchar red"]
    head += ["element face %d" % len(triangles), "property list uint8 int32 vertex_index", "end_header", ""]
    data = "\n".join(head).encode()
    data += b"".join(struct.pack(order + "3fB", *p, 7) for p in points)
    data += b"".join(struct.pack(order + "B3i", 3, *t) for t in triangles)
    (tmp_path / "a.ply").write_bytes(data)
    check(tmp_path / "a.ply", volume(points, triangles), 1e-6)
    (a, b, c), d = triangles[-1], triangles[-2][2]
    mixed = data[: -13 * 2] + struct.pack(order + "B4i", 4, a, b, d, c)
    mixed = mixed.replace(b"face %d" % len(triangles), b"face %d" % (len(triangles) - 1))
    (tmp_path / "mixed.ply").write_bytes(mixed)
    assert len(read_surface(tmp_path / "mixed.ply").triangles) == len(triangles)


def test_polygons(tmp_path):
    points, _ = box()
    corners = ["%g %g %g" % tuple(p) for p in points]
    (tmp_path / "a.off").write_text("\n".join(["OFF 8 6 12", *corners, *("4 " + quad for quad in QUADS)]))
    check(tmp_path / "a.off", 1)
    faces = ["f " + " ".join(str(int(n) - 8) for n in quad.split()) for quad in QUADS]
    (tmp_path / "a.obj").write_text("\n".join(["v " + c for c in corners] + faces))
    check(tmp_path / "a.obj", 1)


def test_poly_with_holes_in_facets_and_volume(tmp_path):
    # A square tube: the end facets have a square hole. Then a closed box inside, hollow in a second file.
    outer, inner = box(high=(3, 3, 1))[0], box((1, 1, 0), (2, 2, 1))[0]
    lines = ["16 3 0 0"] + ["%d %g %g %g" % (i, *p) for i, p in enumerate(np.concatenate([outer, inner]), 1)]
    lines.append("10 1")
    for z, ring in ((0, (1, 3, 7, 5)), (1, (2, 4, 8, 6))):
        lines += ["2 1 %d" % (z + 1), "4 %d %d %d %d" % ring, "4 %d %d %d %d" % tuple(8 + n for n in ring)]
        lines.append("1 1.5 1.5 %d" % z)
    for shift in (0, 8):
        for side in ((1, 2, 4, 3), (5, 6, 8, 7), (1, 2, 6, 5), (3, 4, 8, 7)):
            lines += ["1 0 7", "4  %d %d  # goes on" % (side[0] + shift, side[1] + shift)]
            lines.append("%d %d" % (side[2] + shift, side[3] + shift))
    (tmp_path / "tube.poly").write_text("\n".join([*lines, "0", "0"]))
    check(tmp_path / "tube.poly", 8)

    points, triangles = joined(box(high=(3, 3, 3)), box((1, 1, 1), (2, 2, 2)))
    text = smesh(points, triangles)
    (tmp_path / "full.smesh").write_text(text)
    surface = read_surface(tmp_path / "full.smesh")
    assert Plc.from_triangles(*surface[:3], holes=surface.holes, nested=surface.nested).solid_count == 2
    (tmp_path / "hollow.smesh").write_text(text[: text.rindex("0\n0")] + "1\n1 1.5 1.5 1.5\n0")
    check(tmp_path / "hollow.smesh", 26)


def test_node_file_beside_poly(tmp_path):
    points, triangles = box()
    lines = smesh(points, triangles).splitlines()
    (tmp_path / "a.node").write_text("\n".join(lines[:9]), encoding="utf-8-sig")
    (tmp_path / "a.smesh").write_text("\n".join(["0 3 0 0", *lines[9:]]))
    check(tmp_path / "a.smesh", 1)


def test_vtk_surface_and_boundary_of_tetrahedra(tmp_path):
    meshio = pytest.importorskip("meshio")
    points, triangles = sphere()
    meshio.Mesh(points, [("triangle", triangles)]).write(tmp_path / "a.vtk")
    check(tmp_path / "a.vtk", volume(points, triangles))
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
    meshio.Mesh(corners, [("tetra", np.array([[0, 1, 2, 3], [1, 2, 3, 4]]))]).write(tmp_path / "b.vtk")
    check(tmp_path / "b.vtk", 1 / 6 + 1 / 3)


def polydata(points, polygons, binary=False, version="3.0"):
    """What VTK writes, with sections that are no business of ours."""

    def numbers(values, kind):
        if binary:
            return np.asarray(values, kind).tobytes() + b"\n"
        return " ".join("%.17g" % x for x in np.ravel(values)).encode() + b"\n"

    head = "# vtk DataFile Version %s\nvtk output\n%s\nDATASET POLYDATA\n"
    data = (head % (version, "BINARY" if binary else "ASCII")).encode()
    data += b"FIELD FieldData 1\nTimeValue 1 1 double\n" + numbers([3.5], ">f8")
    data += b"POINTS %d double\n" % len(points) + numbers(points, ">f8") + b"METADATA\nINFORMATION 0\n\n"
    corners = np.concatenate(polygons)
    sizes = [len(polygon) for polygon in polygons]
    if version == "5.1":
        data += b"LINES 2 2\nOFFSETS vtktypeint64\n" + numbers([0, 2], ">i8")
        data += b"CONNECTIVITY vtktypeint64\n" + numbers([0, 1], ">i8")
        data += b"POLYGONS %d %d\nOFFSETS vtktypeint64\n" % (len(polygons) + 1, len(corners))
        data += numbers(np.cumsum([0, *sizes]), ">i8") + b"CONNECTIVITY vtktypeint64\n"
        data += numbers(corners, ">i8")
    else:
        data += b"LINES 1 3\n" + numbers([2, 0, 1], ">i4")
        data += b"POLYGONS %d %d\n" % (len(polygons), len(corners) + len(polygons))
        data += numbers([n for polygon in polygons for n in (len(polygon), *polygon)], ">i4")
    data += b"CELL_DATA %d\nSCALARS a int 1\nLOOKUP_TABLE default\n" % len(polygons)
    return data + numbers(sizes, ">i4")


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("version", ["3.0", "5.1"])
def test_vtk_polydata(tmp_path, binary, version):
    points, triangles = sphere()
    (tmp_path / "a.vtk").write_bytes(polydata(points, triangles, binary, version))
    check(tmp_path / "a.vtk", volume(points, triangles))
    quads = [[int(n) for n in quad.split()] for quad in QUADS]
    mixed = [[0, 1, 3], [0, 3, 2], *quads[1:]]
    data = polydata(box()[0], mixed, binary, version)
    (tmp_path / "a.vtk").write_bytes(data)
    check(tmp_path / "a.vtk", 1)
    for broken in (data[: data.index(b"POLYGONS") + 40], data.replace(b"LINES", b"TRIANGLE_STRIPS")):
        (tmp_path / "a.vtk").write_bytes(broken)
        with pytest.raises(InputError, match="a.vtk"):
            read_surface(tmp_path / "a.vtk")


def test_what_meshio_says_before_it_leaves_the_program(tmp_path, capfd):
    pytest.importorskip("meshio")
    (tmp_path / "a.vtk").write_text("# vtk DataFile Version 3.0\nx\nASCII\nDATASET NONSENSE\n")
    with pytest.raises(InputError, match="NONSENSE"):
        read_surface(tmp_path / "a.vtk")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    "name, text",
    [
        ("a.stl", "no such thing"),
        ("a.stl", "solid x\nvertex 0 0\nendsolid"),
        ("a.stl", "solid empty\nendsolid"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n"),
        ("a.off", "4OFF\n3 1 0\n"),
        ("a.off", ""),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9"),
        ("a.obj", "v 0 0 0\nf 1 2 3"),
        ("a.ply", "ply\nformat ascii 1.0\n"),
        ("a.ply", "plx"),
        ("a.mesh", "MeshVersionFormatted 1\n"),
        ("a.poly", "1 3\n"),
        ("a.smesh", "3 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n1 0\n3 0 1 7\n0"),
        ("a.vtk", "no vtk"),
        ("a.xyz", "0 0 0"),
    ],
)
def test_unreadable_files(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError) as caught:
        read_surface(tmp_path / name)
    assert name in str(caught.value)
    assert caught.value.exit_code == 2
