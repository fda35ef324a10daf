"""Facets far smaller than the elements, as exporters and modelling errors leave them in surface files."""

import numpy as np
import pytest

from DelaunayMesher import pipeline

SIZE = 0.2
ABSORBED = SIZE / 50  # what is narrower becomes nothing


def box_with_sliver(width, along):
    """A unit box; at the edge between its front and its top a triangle of some width, with its third corner
    at a part of the edge's length, and normals between those of the two faces."""
    d = width / np.sqrt(2.0)
    points = [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1], [0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]]
    points.append([along, -d, 1 - d])
    front = [[0, 1, 8], [1, 2, 8], [0, 8, 3]]
    others = [[3, 2, 6], [3, 6, 7], [4, 5, 1], [4, 1, 0], [1, 5, 6], [1, 6, 2], [4, 0, 3], [4, 3, 7]]
    back = [[5, 4, 7], [5, 7, 6]]
    return np.array(points, dtype=float), np.array([*front, [3, 8, 2], *others, *back])


def box_on_box(width):
    """Two boxes of 1 x 1 x 0.5 on each other, the upper one's front turned about an end of its lower edge so
    that a step of some width is left at the other end."""
    low = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0.5], [1, 0, 0.5], [1, 1, 0.5], [0, 1, 0.5]]
    high = [[1, width, 0.5], [0, 0, 1], [1, width, 1], [1, 1, 1], [0, 1, 1]]
    quads = [(0, 3, 2, 1), (0, 1, 5, 4), (2, 3, 7, 6), (3, 0, 4, 7), (4, 8, 10, 9), (9, 10, 11, 12)]
    quads += [(6, 7, 12, 11), (7, 4, 9, 12)]
    triangles = [[a, b, c] for q in quads for a, b, c in (q[:3], (q[0], q[2], q[3]))]
    triangles += [[4, 5, 8], [1, 2, 6], [1, 6, 8], [1, 8, 5], [8, 6, 11], [8, 11, 10]]
    return np.array(low + high, dtype=float), np.array(triangles)


def mesh(surface):
    return pipeline.run(surface, {"max_size": SIZE, "threads": 1})


def smallest_angle(result):
    return result.report()["quality"]["min_dihedral"]


@pytest.mark.parametrize("along", [0.07, 0.4, 0.5])
@pytest.mark.parametrize("width", [1e-5, 1e-3, 0.78 * ABSORBED, 0.97 * ABSORBED])
def test_a_sliver_is_absorbed_whole(width, along):
    result = mesh(box_with_sliver(width, along))
    assert "far smaller than the elements" in result.warnings[0]
    assert smallest_angle(result) > 25
    assert len(result.tets) < 1.2 * len(mesh(box_on_box(0)).tets)


@pytest.mark.parametrize("along", [0.07, 0.4, 0.5])
def test_both_tips_of_a_wider_sliver_are_cut_off(along):
    """Its tips have 0.9 to 5 degrees."""
    assert smallest_angle(mesh(box_with_sliver(1.5 * ABSORBED, along))) > 8


@pytest.mark.parametrize("width", [0.01, 0.03])
def test_the_tip_of_a_step_is_cut_off(width):
    """It has 0.6 and 1.7 degrees."""
    assert smallest_angle(mesh(box_on_box(width))) > 14
