"""Random parts: each meshes, is a valid mesh, fills its CAD solids, and has its nodes on their CAD faces and
edges."""

import numpy as np
import Part
import pytest
from random_parts import random_part

from DelaunayMesher import pipeline
from DelaunayMesher.check import verify

COARSE = 0.08  # of the volume: what the facets of round parts leave out
NODES = 4  # tried of each face and edge


@pytest.mark.long
@pytest.mark.parametrize("number", range(60))
def test_a_random_part(number):
    part = random_part(number)
    mesh = pipeline.run(part, {"threads": 1})
    found = verify(mesh)
    assert not len(found["inverted"]) and not len(found["boundary"])
    corners = np.asarray(mesh.points)[np.asarray(mesh.tets)[:, :4]]
    volume = np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6  # signed: none may be inverted
    assert volume == pytest.approx(part.Volume, rel=COARSE)
    for dimension, elements in ((1, part.Edges), (2, part.Faces)):
        here = np.flatnonzero(mesh.point_dimension == dimension)
        for entity in np.unique(mesh.point_entity[here]):
            element = elements[entity]
            near = 2 * element.getTolerance(1) + 1e-5 * part.BoundBox.DiagonalLength
            for node in here[mesh.point_entity[here] == entity][:NODES]:
                assert element.distToShape(Part.Vertex(*mesh.points[node]))[0] < near
