"""Write VTK's .vtu files in pieces: the arrays are never copied as a whole, as they would be by meshio.

Inline base64 without compression, which takes longer than meshing.
"""

import binascii
import sys
from itertools import chain

import numpy as np

ROWS = 1 << 15  # of an array at once
CELL_TYPES = {4: 10, 10: 24, 3: 5, 6: 22}  # nodes of an element -> VTK's number of its type
HEAD = (
    '<?xml version="1.0"?>\n'
    '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="%s" header_type="UInt64">\n'
    '<UnstructuredGrid>\n<Piece NumberOfPoints="%d" NumberOfCells="%d">\n'
)
TAIL = "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"


def write_vtu(path, mesh):
    """Write the tetrahedra and the boundary triangles; cell data 'solid' and 'face' (1-based, 0 = none)."""
    points, tets, triangles = mesh.points, mesh.tets, mesh.triangles
    cells = len(tets) + len(triangles)
    nodes = tets.size + triangles.size
    blocks = (tets, triangles)
    with open(path, "wb") as file:
        order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
        file.write((HEAD % (order, len(points), cells)).encode())
        file.write(b"<Points>\n")
        _write(file, "Points", "Float64", points.size, _pieces(points), ' NumberOfComponents="3"')
        file.write(b"</Points>\n<Cells>\n")
        _write(file, "connectivity", "Int32", nodes, chain(*map(_pieces, blocks)))
        _write(file, "offsets", "Int64", cells, _offsets(blocks))
        _write(file, "types", "UInt8", cells, _constants((b, CELL_TYPES[b.shape[1]]) for b in blocks))
        file.write(b"</Cells>\n<CellData>\n")
        _write(file, "solid", "Int32", cells, chain(_pieces(mesh.tet_solid), _constants([(triangles, 0)])))
        faces = (piece + 1 for piece in _pieces(mesh.triangle_face))
        _write(file, "face", "Int32", cells, chain(_constants([(tets, 0)]), faces))
        file.write(b"</CellData>\n" + TAIL.encode())


def _pieces(array):
    """Some rows of an array after the other."""
    for start in range(0, len(array), ROWS):
        yield array[start : start + ROWS]


def _offsets(blocks):
    """Where each element ends in the list of all nodes."""
    end = 0
    for block in blocks:
        for piece in _pieces(block):
            yield end + block.shape[1] * np.arange(1, len(piece) + 1)
            end += piece.size


def _constants(blocks):
    """A number for each row of each block."""
    for block, number in blocks:
        for piece in _pieces(block):
            yield np.broadcast_to(number, len(piece))


def _write(file, name, kind, count, pieces, more=""):
    """A DataArray of `count` numbers of a kind."""
    file.write(('<DataArray type="%s" Name="%s"%s format="binary">\n' % (kind, name, more)).encode())
    dtype = np.dtype(kind.lower())
    left = np.uint64(count * dtype.itemsize).tobytes()
    for piece in pieces:
        data = left + np.ascontiguousarray(piece, dtype).tobytes()
        whole = len(data) // 3 * 3  # three bytes make four letters
        file.write(binascii.b2a_base64(data[:whole], newline=False))
        left = data[whole:]
    file.write(binascii.b2a_base64(left) + b"</DataArray>\n")
