import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_surfaces import box, cylinder, joined, sphere, torus, volume

from DelaunayMesher.errors import MeshError
from DelaunayMesher.plc import Plc


def volumes(plc):
    return [plc.volume(solid) for solid in range(1, plc.solid_count + 1)]


def counts(plc):
    return len(plc.face_solids), plc.edge_count, plc.vertex_count, plc.solid_count


def test_box():
    plc = Plc.from_triangles(*box(high=(1, 2, 3)))
    plc.check()
    assert counts(plc) == (6, 12, 8, 1)
    assert volumes(plc) == pytest.approx([6])
    assert (plc.face_solids == [1, 0]).all()
    assert len(plc.segments) == 12


def test_features_of_round_bodies():
    assert counts(Plc.from_triangles(*cylinder())) == (3, 2, 2, 1)
    assert counts(Plc.from_triangles(*sphere())) == (1, 0, 0, 1)
    assert counts(Plc.from_triangles(*torus())) == (1, 0, 0, 1)
    assert counts(Plc.from_triangles(*cylinder(sides=8)))[0] == 10  # 45 degrees are creases
    assert counts(Plc.from_triangles(*cylinder(sides=8), crease_angle=50))[0] == 3


def test_labels_keep_faces_apart():
    points, triangles = sphere()
    labels = (points[triangles].mean(axis=1)[:, 2] > 0).astype(int)
    assert counts(Plc.from_triangles(points, triangles, labels)) == (2, 1, 1, 1)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1), st.sampled_from([box, cylinder, sphere, torus]), st.booleans())
def test_order_orientation_and_sharing_do_not_matter(seed, make, soup):
    random = np.random.default_rng(seed)
    points, triangles = make()
    expected = Plc.from_triangles(points, triangles)
    flip = random.random(len(triangles)) < 0.5
    triangles = triangles.copy()
    triangles[flip] = triangles[flip][:, ::-1]
    triangles = random.permutation(triangles)
    if soup:
        points, triangles = points[triangles].reshape(-1, 3), np.arange(triangles.size).reshape(-1, 3)
    else:
        order = random.permutation(len(points))
        number = np.argsort(order)
        points, triangles = points[order], number[triangles]
    plc = Plc.from_triangles(points, triangles)
    plc.check()
    assert counts(plc) == counts(expected)
    assert volumes(plc) == pytest.approx(volumes(expected))
    assert volume(plc.points, plc.triangles) == pytest.approx(volumes(expected)[0])


def test_shell_in_a_solid_is_a_cavity():
    nested = joined(box(high=(5, 5, 5)), box((1, 1, 1), (4, 4, 4)), box((2, 2, 2), (3, 3, 3)))
    assert volumes(Plc.from_triangles(*nested)) == pytest.approx([98, 1])
    everything = Plc.from_triangles(*nested, nested="solid")
    assert volumes(everything) == pytest.approx([98, 26, 1])
    hole = Plc.from_triangles(*nested, nested="solid", holes=[[1.5, 1.5, 1.5]])
    assert sorted(volumes(hole)) == pytest.approx([1, 98])


def test_several_solids():
    apart = Plc.from_triangles(*joined(box(), box((2, 0, 0), (3, 1, 1))))
    assert counts(apart) == (12, 24, 16, 2)
    touching = Plc.from_triangles(*joined(box(), box((1, 0, 0), (2, 1, 1))))
    assert counts(touching) == (11, 20, 12, 2)
    assert [1, 2] in touching.face_solids.tolist()
    at_an_edge = Plc.from_triangles(*joined(box(), box((1, 1, 0), (2, 2, 1))))
    assert volumes(at_an_edge) == pytest.approx([1, 1])
    at_a_point = Plc.from_triangles(*joined(box(), box((1, 1, 1), (2, 2, 2))))
    assert counts(at_a_point) == (12, 24, 15, 2)


def test_single_precision_gaps_are_closed():
    points, triangles = sphere()
    soup = points[triangles].reshape(-1, 3)
    soup = soup + np.random.default_rng(1).uniform(-3e-7, 3e-7, soup.shape)
    plc = Plc.from_triangles(soup, np.arange(len(soup)).reshape(-1, 3))
    assert len(plc.points) == len(points)
    assert len(plc.warnings) == 1


def test_needles_do_not_hide_a_crease():
    points, triangles = box()
    # Split the edge from (0, 0, 0) to (0, 0, 1) by a needle: a point just beside its middle.
    a, b = 0, 1
    points = np.concatenate([points, [[0, 0, 0.5], [1e-13, 0, 0.5]]])
    finer = []
    for triangle in triangles.tolist():
        if a in triangle and b in triangle:
            i = next(i for i in range(3) if {triangle[i], triangle[i - 2]} == {a, b})
            p, q, r = triangle[i], triangle[(i + 1) % 3], triangle[(i + 2) % 3]
            finer += [(p, 8, r), (8, q, r)]
        else:
            finer.append(triangle)
    plc = Plc.from_triangles(points, np.array(finer))
    assert counts(plc) == (6, 12, 8, 1)


@pytest.mark.parametrize(
    "surface, code",
    [
        ((box()[0], box()[1][:-1]), "open_edge"),
        ((box()[0], np.zeros((0, 3), int)), "empty"),
        ((box()[0] * [1, 1, 0], box()[1]), "zero_volume"),
        ((box()[0] * 0, box()[1]), "empty"),
        ((np.where(box()[0] == 1, np.nan, 0), box()[1]), "not_finite"),
        ((box()[0], box()[1] + 1), "out_of_range"),
        ((box()[0][:, :2], box()[1]), "bad_array"),
    ],
)
def test_bad_surfaces(surface, code):
    with pytest.raises(MeshError) as caught:
        Plc.from_triangles(*surface)
    assert caught.value.code == code


def test_open_edge_is_located():
    points, triangles = box(high=(2, 2, 2))
    with pytest.raises(MeshError) as caught:
        Plc.from_triangles(points, triangles[:-1])
    corners = points[triangles[-1]]
    assert (np.array(caught.value.place) >= corners.min(axis=0)).all()
    assert (np.array(caught.value.place) <= corners.max(axis=0)).all()


def test_check_finds_wrong_numbers():
    plc = Plc.from_triangles(*box())
    plc.triangle_face = plc.triangle_face + 1
    with pytest.raises(MeshError) as caught:
        plc.check()
    assert caught.value.code == "out_of_range"


def test_overlap_at_an_edge():
    points, triangles = joined(box(), box((0, 0, 0), (1, 2, 0.5)))
    with pytest.raises(MeshError) as caught:
        Plc.from_triangles(points, triangles)
    assert caught.value.code in ("overlap", "open_edge", "zero_volume")
