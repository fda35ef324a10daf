"""Read surfaces from legacy .vtk files with DATASET POLYDATA: VTK's own form for them, which meshio lacks."""

import re

import numpy as np

TYPES = {"float": "f4", "double": "f8", "int": "i4", "vtktypeint32": "i4", "vtktypeint64": "i8"}
HEAD = 1024  # bytes that surely hold the four lines of a file's head


def is_polydata(path):
    """Whether the file is one of these."""
    with open(path, "rb") as file:
        return re.search(rb"^DATASET\s+POLYDATA\b", file.read(HEAD), re.MULTILINE | re.IGNORECASE) is not None


def read_polydata(path):
    """Points (n, 3) float64 and polygons, as lists of point numbers, of a text or binary file.

    Raises ValueError when there are triangle strips, or fewer numbers than announced.
    """
    with open(path, "rb") as file:
        source = _Sections(file.read())
    if source.find(r"TRIANGLE_STRIPS\s+[1-9]"):
        raise ValueError("triangle strips are not supported")
    count, kind = source.words(r"POINTS\s+(\d+)\s+(\w+)")
    points = source.numbers(3 * int(count), kind).astype(np.float64).reshape(-1, 3)
    if not source.find("POLYGONS"):
        return points, []
    first, second = (int(word) for word in source.words(r"POLYGONS\s+(\d+)\s+(\d+)"))
    if not source.next_is("OFFSETS"):
        return points, _counted(source.numbers(second, "int").tolist(), first)
    # Since version 5.1: first the place at which each polygon begins, then the corners of all.
    places = source.numbers(first, *source.words(r"OFFSETS\s+(\w+)")).tolist()
    corners = source.numbers(second, *source.words(r"CONNECTIVITY\s+(\w+)")).tolist()
    return points, [corners[start:end] for start, end in zip(places, places[1:])]


def _counted(numbers, count):
    """Polygons that have their number of corners in front."""
    polygons, at = [], 0
    for _ in range(count):
        polygons.append(numbers[at + 1 : at + 1 + numbers[at]])
        at += 1 + numbers[at]
    return polygons


class _Sections:
    """A file whose sections begin with a line of words; those that nobody asks for are skipped."""

    def __init__(self, data):
        self.data, self.at = data, 0
        self.binary = data.split(b"\n", 3)[2].strip().upper() == b"BINARY"

    def find(self, pattern):
        """The match of a line that begins so, from here on, or None."""
        line = re.compile(rb"^%s\b[^\r\n]*\r?\n" % pattern.encode(), re.MULTILINE | re.IGNORECASE)
        return line.search(self.data, self.at)

    def words(self, pattern):
        """The groups of the next line that begins so; goes on behind it."""
        match = self.find(pattern)
        if not match:
            raise ValueError("there is no %s" % pattern.split("\\")[0])
        self.at = match.end()
        return [word.decode().lower() for word in match.groups()]

    def next_is(self, word):
        """Whether the next line begins so."""
        return self.data[self.at : self.at + len(word)].upper() == word.encode()

    def numbers(self, count, kind):
        """Numbers of a type of VTK from here on."""
        if self.binary:
            found = np.frombuffer(self.data, ">" + TYPES[kind], count, self.at)
            self.at += found.nbytes
            return found
        found = np.array(self.data[self.at :].split(None, count)[:count], dtype=np.float64)
        if len(found) < count:
            raise ValueError("the file ends early")
        return found.astype(TYPES[kind])
