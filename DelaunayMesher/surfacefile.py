"""Read closed triangulated surfaces: .stl .off .ply .obj .mesh .vtk .poly .smesh.

Polygons with more than three corners, and facets with holes, are triangulated without new points. Every
reader raises InputError for a file that is not what its name says.
"""

import io
import re
from contextlib import redirect_stderr, redirect_stdout
from typing import Any, NamedTuple

import numpy as np

from .cadprocess import ending_of
from .errors import InputError
from .polygons import triangulate_facet


class Surface(NamedTuple):
    """points (n, 3) float64, triangles (m, 3) int64; labels (m,) int64, holes (k, 3) and nested as Plc's."""

    points: Any
    triangles: Any
    labels: Any = None
    holes: Any = None
    nested: str = "cavity"


def read_surface(path):
    """Surface in the file `path`, by its ending."""
    ending = ending_of(path)
    if ending not in READERS:
        known = ", ".join(sorted(READERS))
        raise unreadable(
            "%s: cannot read %r files; surfaces are %s" % (path, ending, known), "unknown_format"
        )
    try:
        surface = READERS[ending](path)
    except OSError as error:
        raise unreadable("%s: %s" % (path, error.strerror or error)) from None
    except InputError as error:
        error.message = "%s: %s" % (path, error.message)
        raise
    except (ValueError, IndexError, KeyError, UnicodeDecodeError) as error:
        raise unreadable("%s: not a valid %s file (%s)" % (path, ending, error)) from None
    if len(surface.triangles) == 0:
        raise unreadable("%s holds no triangles" % path, "empty")
    return surface


def unreadable(message, code="unreadable"):
    """The InputError for a file that cannot be read."""
    return InputError("read", code, message)


def _read_stl(path):
    with open(path, "rb") as file:
        data = file.read()
    count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    if count == 0 and (len(data) - 84) % 50 == 0:  # some programs write it before they know
        count = (len(data) - 84) // 50
    if (
        count >= 0
        and len(data) >= 84 + 50 * count
        and (len(data) == 84 + 50 * count or b"\x00" in data[:1000])
    ):
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", 9), ("unused", "<u2")])
        corners = np.frombuffer(data, record, count, 84)["corners"].astype(np.float64)
    elif re.match(rb"(\xef\xbb\xbf)?\s*solid", data, re.IGNORECASE):
        places = re.findall(rb"vertex\s+(\S+\s+\S+\s+\S+)", data, re.IGNORECASE)
        corners = np.array(b" ".join(places).split(), dtype=np.float64).reshape(-1, 9)
    else:
        raise ValueError("neither a binary nor a text STL")
    return Surface(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def _read_off(path):
    rows = [line.split() for line in _lines(path)]
    if rows[0][0].upper() in ("OFF", "COFF", "NOFF"):
        rows[0] = rows[0][1:]
        rows = rows if rows[0] else rows[1:]
    elif not rows[0][0].isdigit():
        raise ValueError("%s is not supported" % rows[0][0])
    points_count, faces_count = int(rows[0][0]), int(rows[0][1])
    rows = rows[1:]
    if len(rows) < points_count + faces_count:
        raise ValueError("the file ends early")
    points = np.array([row[:3] for row in rows[:points_count]], dtype=np.float64).reshape(-1, 3)
    faces = [[int(word) for word in row[1 : 1 + int(row[0])]] for row in rows[points_count:][:faces_count]]
    return Surface(points, triangulate_polygons(points, faces))


def _read_obj(path):
    points, faces = [], []
    for line in _continued(_lines(path)):
        words = line.split()
        if words[0] == "v":
            points.append([float(word) for word in words[1:4]])
        elif words[0] == "f":
            numbers = [int(word.split("/")[0]) for word in words[1:]]
            faces.append([number - 1 if number > 0 else len(points) + number for number in numbers])
    points = np.array(points, dtype=np.float64).reshape(-1, 3)
    return Surface(points, triangulate_polygons(points, faces))


def _read_medit(path):
    """Medit .mesh: Vertices, Triangles and Quadrilaterals; their references keep faces apart."""
    words = _words(path)
    keywords = {word.lower(): index for index, word in enumerate(words) if word[:1].isalpha()}
    if "meshversionformatted" not in keywords or "vertices" not in keywords:
        raise ValueError("no text Medit mesh")
    width = int(words[keywords["dimension"] + 1])
    if width != 3:
        raise ValueError("the points have %d coordinates" % width)

    def table(keyword, columns):
        if keyword not in keywords:
            return np.zeros((0, columns))
        start = keywords[keyword] + 2
        count = int(words[start - 1])
        return np.array(words[start : start + count * columns], dtype=np.float64).reshape(count, columns)

    points = table("vertices", 4)[:, :3]
    triangles = table("triangles", 4).astype(np.int64)
    quads = table("quadrilaterals", 5).astype(np.int64)
    split = np.concatenate([quads[:, [0, 1, 2, 4]], quads[:, [0, 2, 3, 4]]])
    triangles = np.concatenate([triangles, split])
    return Surface(points, triangles[:, :3] - 1, triangles[:, 3])


def _read_vtk(path):
    """PolyData, or anything else through meshio: triangles and polygons, or the boundary of tetrahedra."""
    from .vtkfile import is_polydata, read_polydata

    if is_polydata(path):
        points, polygons = read_polydata(path)
        return Surface(points, triangulate_polygons(points, polygons))
    mesh = read_with_meshio(path)
    faces = [cells.data for cells in mesh.cells if cells.type in ("triangle", "quad", "polygon")]
    points = np.asarray(mesh.points, dtype=np.float64)
    if faces:
        polygons = [polygon for block in faces for polygon in np.asarray(block).tolist()]
        return Surface(points, triangulate_polygons(points, polygons))
    tets = [np.asarray(cells.data)[:, :4] for cells in mesh.cells if cells.type in ("tetra", "tetra10")]
    return Surface(points, boundary_of_tets(np.concatenate(tets) if tets else np.zeros((0, 4), np.int64)))


def boundary_of_tets(tets):
    """(m, 3) outward triangles that belong to one tetrahedron only."""
    faces = np.concatenate([tets[:, [1, 2, 3]], tets[:, [0, 3, 2]], tets[:, [0, 1, 3]], tets[:, [0, 2, 1]]])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]


def read_with_meshio(path):
    """meshio's mesh of a file; its errors become ours."""
    meshio = import_meshio()
    said = io.StringIO()
    try:
        with redirect_stdout(said), redirect_stderr(said):
            return meshio.read(path)
    except SystemExit:  # meshio prints why no reader of its takes the file, and leaves the program
        reason = said.getvalue().strip().split("\n")[0] or "meshio does not know what is in it"
        raise unreadable("not readable: %s" % reason) from None
    except Exception as error:
        raise unreadable("not readable: %s" % error) from None


def import_meshio():
    """meshio, or an InputError that says how to get it."""
    try:
        import meshio
    except ImportError:
        raise unreadable(
            "this format needs meshio: apt-get install python3-meshio, or pip install meshio", "no_meshio"
        ) from None
    return meshio


def triangulate_polygons(points, faces):
    """(m, 3) triangles of polygons given as lists of point numbers."""
    if any(min(face, default=0) < 0 or max(face, default=0) >= len(points) for face in faces):
        raise ValueError("a face uses a point that does not exist")
    simple = [face for face in faces if len(face) == 3]
    parts = [np.array(simple, dtype=np.int64).reshape(-1, 3)]
    parts += [triangulate_facet(points, [list(face)]) for face in faces if len(face) > 3]
    return np.concatenate(parts)


def _lines(path, comment="#"):
    """Lines that are neither empty nor comments."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:  # some begin with a byte order mark
        stripped = (line.split(comment)[0].strip() for line in file)
        return [line for line in stripped if line]


def _continued(lines):
    """The lines, of which one that ends with a backslash goes on in the next."""
    begun = ""
    for line in lines:
        begun += line.rstrip("\\") + " "
        if not line.endswith("\\"):
            yield begun
            begun = ""


def _words(path):
    return [word for line in _lines(path) for word in line.split()]


def _read_poly(path):
    from .polyfile import read_poly

    return read_poly(path, _lines(path))


def _read_ply(path):
    from .plyfile import read_ply

    points, faces = read_ply(path)
    return Surface(points, faces if isinstance(faces, np.ndarray) else triangulate_polygons(points, faces))


READERS = {
    ".stl": _read_stl,
    ".off": _read_off,
    ".obj": _read_obj,
    ".ply": _read_ply,
    ".mesh": _read_medit,
    ".vtk": _read_vtk,
    ".poly": _read_poly,
    ".smesh": _read_poly,
}
