"""Read .ply files, text and binary: the points and the polygons."""

from codecs import BOM_UTF8

import numpy as np

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip


def read_ply(path):
    """Points (n, 3) float64 and faces: (m, 3) int64 when all are triangles, else lists of point numbers."""
    with open(path, "rb") as file:
        encoding, elements = _read_header(file)
        data = file.read()
    source = _Words(data) if encoding == "ascii" else _Bytes(data, ">" if "big" in encoding else "<")
    points, faces = np.zeros((0, 3)), []
    for name, count, properties in elements:
        columns = source.read(count, properties)
        if name == "vertex":
            points = np.stack([np.asarray(columns[axis], dtype=np.float64) for axis in "xyz"], axis=1)
        elif name == "face":
            faces = columns.get("vertex_indices", columns.get("vertex_index"))
            if faces is None:
                raise ValueError("faces without vertex_indices")
    faces = faces if isinstance(faces, np.ndarray) else list(faces)
    if isinstance(faces, np.ndarray) and faces.shape[1] != 3:
        faces = faces.tolist()
    return points, faces


def _read_header(file):
    if file.readline().strip() not in (b"ply", BOM_UTF8 + b"ply"):
        raise ValueError("no 'ply' in the first line")
    encoding, elements = None, []
    while True:
        line = file.readline()
        if not line:
            raise ValueError("the header has no end")
        words = line.decode("ascii", "replace").split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "end_header":
            break
        if words[0] == "format":
            encoding = words[1]
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append((words[-1], words[2:4] if words[1] == "list" else words[1]))
    if encoding not in ("ascii", "binary_little_endian", "binary_big_endian"):
        raise ValueError("unknown encoding %s" % encoding)
    return encoding, elements


class _Words:
    """A text file's elements."""

    def __init__(self, data):
        self.words = data.split()
        self.at = 0

    def read(self, count, properties):
        columns = {name: [] for name, _ in properties}
        for _ in range(count):
            for name, kind in properties:
                width = 1
                if isinstance(kind, list):
                    width = int(self.words[self.at])
                    self.at += 1
                values = self.words[self.at : self.at + width]
                if len(values) < width:
                    raise ValueError("the file ends early")
                self.at += width
                columns[name].append([int(v) for v in values] if isinstance(kind, list) else float(values[0]))
        return columns


class _Bytes:
    """A binary file's elements; those with lists of one length are read at once."""

    def __init__(self, data, order):
        self.data, self.order, self.at = data, order, 0

    def read(self, count, properties):
        widths = [self._width(properties, index) for index in range(len(properties))] if count else []
        if None not in widths:
            columns = self._read_rows(count, properties, widths)
            if columns is not None:
                return columns
        return self._read_one_by_one(count, properties)

    def _type(self, kind):
        return np.dtype(self.order + TYPES[kind])

    def _width(self, properties, index):
        """Length of the list property `index` in the first element; 1 for a plain one."""
        at = self.at
        for position, (_, kind) in enumerate(properties):
            if isinstance(kind, list):
                counter = self._type(kind[0])
                width = int(np.frombuffer(self.data, counter, 1, at)[0])
                at += counter.itemsize + width * self._type(kind[1]).itemsize
            else:
                width = 1
                at += self._type(kind).itemsize
            if position == index:
                return width
        return None

    def _read_rows(self, count, properties, widths):
        """All elements as one table, or None when lists differ in length."""
        fields = []
        for (name, kind), width in zip(properties, widths):
            if isinstance(kind, list):
                fields += [("#" + name, self._type(kind[0])), (name, self._type(kind[1]), (width,))]
            else:
                fields.append((name, self._type(kind)))
        row = np.dtype(fields)
        if len(self.data) < self.at + count * row.itemsize:
            return None
        table = np.frombuffer(self.data, row, count, self.at)
        for (name, kind), width in zip(properties, widths):
            if isinstance(kind, list) and (table["#" + name] != width).any():
                return None
        self.at += count * row.itemsize
        return {
            name: table[name].astype(np.int64) if isinstance(kind, list) else table[name]
            for name, kind in properties
        }

    def _read_one_by_one(self, count, properties):
        columns = {name: [] for name, _ in properties}
        for _ in range(count):
            for name, kind in properties:
                width = 1
                if isinstance(kind, list):
                    width = int(self._take(kind[0], 1)[0])
                values = self._take(kind[1] if isinstance(kind, list) else kind, width)
                columns[name].append(values.tolist() if isinstance(kind, list) else values[0])
        return columns

    def _take(self, kind, count):
        values = np.frombuffer(self.data, self._type(kind), count, self.at)
        self.at += values.nbytes
        return values
