"""Read TetGen's .poly and .smesh: facets of several polygons with holes, volume holes, a separate .node
file.
"""

import os

import numpy as np

from .polygons import triangulate_facet
from .surfacefile import Surface


def read_poly(path, lines):
    """Surface of a .poly (facets with several polygons) or .smesh (one polygon per facet) file.

    Facet markers keep faces apart; regions need no seeds: every closed region is a solid unless it holds
    one of the file's hole points.
    """
    rows = [line.replace(",", " ").split() for line in lines]
    numbers, points, at = _read_nodes(path, rows)
    facets, at = _read_facets(rows, at, str(path).lower().endswith(".smesh"))
    holes, _ = _read_holes(rows, at)
    place = {number: index for index, number in enumerate(numbers)}
    triangles, labels = [], []
    for polygons, facet_holes, marker in facets:
        loops = [[place[number] for number in polygon] for polygon in polygons]
        found = triangulate_facet(points, loops, facet_holes)
        triangles.append(found)
        labels.append(np.full(len(found), marker))
    if not triangles:
        return Surface(points, np.zeros((0, 3), np.int64))
    return Surface(points, np.concatenate(triangles), np.concatenate(labels), holes, "solid")


def _read_nodes(path, rows):
    """Numbers and coordinates of the points, and the row after them."""
    count, at = int(rows[0][0]), 1
    if count == 0:  # the points are in the .node file beside it
        beside = os.path.splitext(str(path))[0] + ".node"
        with open(beside, encoding="utf-8-sig", errors="replace") as file:
            stripped = (line.split("#")[0].split() for line in file)
            nodes = [row for row in stripped if row]
        count, nodes = int(nodes[0][0]), nodes[1:]
    else:
        nodes, at = rows[1 : 1 + count], 1 + count
    if len(nodes) < count:
        raise ValueError("the file ends within the points")
    points = np.array([row[1:4] for row in nodes[:count]], dtype=np.float64).reshape(-1, 3)
    return [int(row[0]) for row in nodes[:count]], points, at


def _read_facets(rows, at, simple):
    """List of (polygons, holes in the facet, marker), and the row after them."""
    count = int(rows[at][0])
    marked = len(rows[at]) > 1 and rows[at][1] != "0"
    at += 1
    facets = []
    for _ in range(count):
        if simple:
            polygon, at = _polygon(rows, at)
            marker = polygon.pop() if marked else 0
            facets.append(([polygon], (), marker))
            continue
        head = [int(word) for word in rows[at]]
        polygons_count, holes_count = head[0], head[1] if len(head) > 1 else 0
        marker = head[2] if marked and len(head) > 2 else 0
        at += 1
        polygons = []
        for _ in range(polygons_count):
            polygon, at = _polygon(rows, at)
            polygons.append(polygon)
        holes = [[float(word) for word in row[1:4]] for row in rows[at : at + holes_count]]
        facets.append((polygons, holes, marker))
        at += holes_count
    return facets, at


def _polygon(rows, at):
    """Numbers of one polygon, which may go on over several lines (with a marker, if any, at the end)."""
    words = list(rows[at])
    count = int(words[0])
    at += 1
    while len(words) < 1 + count:
        words += rows[at]
        at += 1
    return [int(word) for word in words[1:]], at


def _read_holes(rows, at):
    if at >= len(rows):
        return np.zeros((0, 3)), at
    count = int(rows[at][0])
    table = [row[1:4] for row in rows[at + 1 : at + 1 + count]]
    return np.array(table, dtype=np.float64).reshape(-1, 3), at + 1 + count
