"""The compiled core through the public API, on surfaces without CAD. Fails when the core is not built."""

import re
import time

import numpy as np
import pytest
from sample_surfaces import box, cylinder, joined, sphere, torus, volume

import DelaunayMesher
from DelaunayMesher import joining, quality
from DelaunayMesher.errors import InputError, MeshCancelled, MeshError
from DelaunayMesher.plc import Plc
from DelaunayMesher.sizing import Region
from DelaunayMesher.surfacefile import boundary_of_tets


def check_mesh(mesh, solids=1):
    """Every tetrahedron positive; boundary triangles are exactly the faces with one owner or two solids."""
    assert (quality.volumes(mesh.points, mesh.tets) > 0).all()
    assert set(np.unique(mesh.tet_solid)) == set(range(1, solids + 1))
    corners = np.sort(mesh.triangles[:, :3], axis=1)
    assert len(np.unique(corners, axis=0)) == len(corners)
    given = {tuple(row) for row in corners.tolist()}
    expected = set()
    for solid in range(1, solids + 1):
        tets = mesh.tets[mesh.tet_solid == solid][:, :4]
        expected |= {tuple(sorted(row)) for row in boundary_of_tets(tets).tolist()}
    assert given == expected
    assert np.array_equal(np.unique(mesh.tets), np.arange(len(mesh.points)))


@pytest.mark.parametrize(
    "surface, size",
    [(box(high=(3, 4, 5)), 0.7), (cylinder(sides=32), 0.25), (sphere(), 0.2), (torus(), 0.25)],
    ids=["box", "cylinder", "sphere", "torus"],
)
@pytest.mark.parametrize("optimise", [True, False])
def test_bodies(surface, size, optimise):
    mesh = DelaunayMesher.mesh(surface, max_size=size, optimise=optimise, elements_per_circle=0)
    check_mesh(mesh)
    assert quality.volumes(mesh.points, mesh.tets).sum() == pytest.approx(volume(*surface), rel=0.01)
    assert mesh.quality["min_dihedral"] > 15
    edges = quality.edge_lengths(mesh.points, mesh.tets)
    assert 0.8 * size < np.median(edges) < 1.15 * size
    assert mesh.status == "ok" or mesh.below_target
    assert list(mesh.seconds)[0] == "plc" and mesh.total_seconds > 0


def test_solids_with_a_shared_wall():
    surface = joined(box(), box((1, 0, 0), (2, 1, 1)))
    mesh = DelaunayMesher.mesh(surface, max_size=0.25)
    check_mesh(mesh, solids=2)
    assert quality.volumes(mesh.points, mesh.tets).sum() == pytest.approx(2)


def test_cavity():
    surface = joined(box(high=(3, 3, 3)), box((1, 1, 1), (2, 2, 2)))
    mesh = DelaunayMesher.mesh(surface, max_size=0.5)
    check_mesh(mesh)
    assert quality.volumes(mesh.points, mesh.tets).sum() == pytest.approx(26)


def test_entities_of_points():
    mesh = DelaunayMesher.mesh(box(), max_size=0.3)
    assert (np.bincount(mesh.point_dimension)[:1] == 8).all()
    for face in range(6):
        on_face = mesh.nodes_of("Face%d" % (face + 1))
        inner = np.flatnonzero((mesh.point_dimension == 2) & (mesh.point_entity == face))
        assert set(inner) <= set(on_face)
    assert len(np.unique(mesh.line_edge)) == 12


def test_second_order():
    mesh = DelaunayMesher.mesh(cylinder(), max_size=0.4, order=2)
    check_mesh(mesh)
    assert mesh.tets.shape[1] == 10 and mesh.triangles.shape[1] == 6 and mesh.lines.shape[1] == 3
    assert quality.scaled_jacobian(mesh.points, mesh.tets).min() > 0
    middles = mesh.points[mesh.tets[:, 4:]]
    straight = np.stack([mesh.points[mesh.tets[:, [i, j]]].mean(axis=1) for i, j in quality.EDGES], axis=1)
    assert np.abs(middles - straight).max() < 0.1


def test_same_seed_same_bytes():
    first = DelaunayMesher.mesh(cylinder(), max_size=0.25, threads=1)
    for threads in (1, 2, 5):
        again = DelaunayMesher.mesh(cylinder(), max_size=0.25, threads=threads)
        assert again.points.tobytes() == first.points.tobytes()
        assert again.tets.tobytes() == first.tets.tobytes()
        assert again.triangles.tobytes() == first.triangles.tobytes()
    other = DelaunayMesher.mesh(cylinder(), max_size=0.25, seed=2)
    assert other.tets.tobytes() != first.tets.tobytes()


def test_sizes_by_name_region_and_points():
    plain = len(DelaunayMesher.mesh(box(), max_size=0.3).tets)
    plc = Plc.from_triangles(*box())
    top = next(f for f in range(6) if (plc.points[plc.triangles[plc.triangle_face == f]][..., 2] == 1).all())
    finer = DelaunayMesher.mesh(plc, max_size=0.3, sizes={"Face%d" % (top + 1): 0.08})
    assert len(finer.tets) > 2 * plain
    edges = quality.edge_lengths(finer.points, finer.tets).mean(axis=1)
    height = finer.points[finer.tets].mean(axis=1)[:, 2]
    assert np.median(edges[height > 0.95]) < 0.7 * np.median(edges[height < 0.3])
    ball = DelaunayMesher.mesh(box(), max_size=0.3, regions=[Region.ball((0.5, 0.5, 0.5), 0.2, 0.06)])
    assert len(ball.tets) > 2 * plain
    points = DelaunayMesher.mesh(box(), max_size=0.3, size_points=[[0.5, 0.5, 0.5]], size_values=[0.05])
    assert len(points.tets) > plain


def test_unknown_name():
    with pytest.raises(InputError) as caught:
        DelaunayMesher.mesh(box(), sizes={"Face7": 0.1})
    assert caught.value.entity == "Face7" and "Face1 to Face6" in str(caught.value)


def test_names_count_on_over_pieces_that_cross():
    mesh = DelaunayMesher.mesh(joined(box(), box((0.5, 0.5, 0.5), (1.5, 1.5, 1.5))), max_size=0.5)
    assert len(mesh.nodes_of("Face12")) and len(mesh.nodes_of("Solid2"))
    for name in ("Face13", "Edge25", "Vertex17", "Solid3"):
        with pytest.raises(InputError, match="there is no " + name):
            mesh.nodes_of(name)


def test_counts_in_warnings_are_singular_or_plural(monkeypatch):
    join = joining.join
    monkeypatch.setattr(joining, "join", lambda *given: {**join(*given), "warnings": ["in 1 place(s)"]})
    assert DelaunayMesher.mesh(box(), max_size=0.5).warnings == ["in 1 place"]


def test_a_minimum_size_lifts_the_limit_of_thin_walls():
    foil = box(high=(4, 4, 0.05))
    coarse = DelaunayMesher.mesh(foil, max_size=10)
    (warning,) = coarse.warnings
    wanted, given = map(float, re.search(r"need elements of (\S+) mm; they get (\S+) mm", warning).groups())
    assert wanted < given and "--min-size" in warning
    predicted = int(re.search(r"the smaller makes about (\d+) elements", warning).group(1))
    fine = DelaunayMesher.mesh(foil, max_size=10, min_size=wanted)
    assert not fine.warnings
    assert len(coarse.tets) < len(fine.tets) and 0.5 < predicted / len(fine.tets) < 2


def test_the_faces_of_walls_at_their_limit_are_named():
    block_and_foil = joined(box(high=(4, 4, 4)), box((10, 0, 0), (14, 4, 0.05)))
    (warning,) = DelaunayMesher.mesh(block_and_foil, max_size=10).warnings
    wide = range(7, 13)  # faces of the foil; those that are the foil's two sides have all walls
    named = [int(n) for n in re.findall(r"Face(\d+)", warning)]
    assert len(named) == 2 and set(named) < set(wide)


def test_too_many_elements():
    with pytest.raises(MeshError) as caught:
        DelaunayMesher.mesh(box(), max_size=0.01, max_elements=1000)
    assert caught.value.code == "too_many_elements"
    with pytest.raises(MeshError, match=r"about 1e\+\d+ tetrahedra"):  # more than 64 bits can count
        DelaunayMesher.mesh(box(), max_size=1e-8)


def test_the_limit_of_elements_counts_what_no_size_asks_for():
    bars = joined(*(box((2 * k, 0, 0), (2 * k + 1, 1, 20)) for k in range(10)))
    options = {"max_size": 10, "elements_across": 0}
    fits = DelaunayMesher.mesh(bars, **options)
    count = len(fits.tets)
    assert 50 * fits.statistics["predicted_tetrahedra"] < count
    limited = DelaunayMesher.mesh(bars, max_elements=count, **options)
    assert limited.points.tobytes() == fits.points.tobytes()
    with pytest.raises(
        MeshError, match=r"\d+ triangles, so the mesh has \d+ tetrahedra at the least"
    ) as caught:
        DelaunayMesher.mesh(bars, max_elements=count // 5, **options)
    assert (caught.value.stage, caught.value.code) == ("surfaces", "too_many_elements")
    with pytest.raises(MeshError, match=r"\d+ tetrahedra are made already, more than the limit") as caught:
        DelaunayMesher.mesh(bars, max_elements=count // 2, **options)
    assert (caught.value.stage, caught.value.code) == ("refinement", "too_many_elements")


def test_the_limit_of_elements_holds_for_all_pieces_together():
    crossing = joined(box(), box((0.5, 0.5, 0.5), (1.5, 1.5, 1.5)))
    count = len(DelaunayMesher.mesh(crossing, max_size=0.2).tets)
    assert len(DelaunayMesher.mesh(crossing, max_size=0.2, max_elements=2 * count).tets) == count
    with pytest.raises(MeshError, match="sizes ask for about"):
        DelaunayMesher.mesh(crossing, max_size=0.2, max_elements=round(0.75 * count))


def test_cancel_and_progress():
    seen = []

    def note(stage, fraction):
        seen.append((stage, fraction))
        return True

    DelaunayMesher.mesh(box(), max_size=0.05, report=note)
    stages = list(dict.fromkeys(stage for stage, _ in seen))
    assert stages[0] == "plc" and "refinement" in stages
    assert all(0 <= fraction <= 1 for _, fraction in seen)
    started = []

    def stop(stage, fraction):
        started.append(time.monotonic())
        return stage != "refinement"

    with pytest.raises(MeshCancelled):
        DelaunayMesher.mesh(box(), max_size=0.05, report=stop)
    with pytest.raises(MeshCancelled):
        DelaunayMesher.mesh(box(), report=lambda stage, fraction: False)


def test_errors_of_the_callback_come_through():
    def fail(stage, fraction):
        if stage == "refinement":
            raise KeyError("mine")

    with pytest.raises(KeyError):
        DelaunayMesher.mesh(box(), max_size=0.1, report=fail)


def test_wrong_sources():
    for source in (3, None, "no such file.stl"):
        with pytest.raises(InputError):
            DelaunayMesher.mesh(source)


def test_delaunay_against_scipy():
    from scipy.spatial import Delaunay

    points = np.random.default_rng(3).random((2000, 3))
    tets = DelaunayMesher.delaunay(points)
    assert tets.dtype == np.int32
    assert (quality.volumes(points, tets) > 0).all()
    ours = {tuple(row) for row in np.sort(tets, axis=1).tolist()}
    theirs = {tuple(row) for row in np.sort(Delaunay(points).simplices, axis=1).tolist()}
    assert ours == theirs


def test_delaunay_of_a_grid_and_of_nothing():
    grid = np.stack(np.meshgrid(*[np.arange(6.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    tets = DelaunayMesher.delaunay(grid)
    assert quality.volumes(grid, tets).sum() == pytest.approx(125)
    with pytest.raises(MeshError) as caught:
        DelaunayMesher.delaunay(grid * [1, 1, 0])
    assert caught.value.code == "degenerate_points"
    for bad in (np.zeros((4, 2)), np.full((5, 3), np.nan)):
        with pytest.raises(MeshError):
            DelaunayMesher.delaunay(bad)


def test_predicates():
    from DelaunayMesher import _core

    corners = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]])
    assert _core.orient3d(corners).tolist() == [1]
    assert _core.orient3d(corners[:, ::-1].copy()).tolist() == [1]
    assert _core.orient3d(corners[:, [1, 0, 2, 3]]).tolist() == [-1]
    inside = np.concatenate([corners, [[[0.5, 0.5, 0.5]]]], axis=1)
    assert _core.insphere(inside).tolist() == [1]
    on = np.concatenate([corners, [[[1.0, 1.0, 1.0]]]], axis=1)
    assert _core.insphere(on).tolist() == [0]


def test_no_sliver_under_a_nearly_smooth_edge():
    """A flat tetrahedron with one face on each side of the ridge cannot change sides: the ridge must stay."""
    rise, length = 0.05, 4.0
    y, z = np.array([-1, 1, 1, 0, -1.0]), np.array([0, 0, 1, 1 + rise, 1.0])
    points = np.concatenate([np.stack([np.full(5, x), y, z], axis=1) for x in (0.0, length)])
    triangles = [(3, 0, 4), (3, 1, 0), (3, 2, 1), (8, 9, 5), (8, 5, 6), (8, 6, 7)]
    faces = [0, 0, 0, 1, 1, 1]
    for k in range(5):
        a, b = k, (k + 1) % 5
        triangles += [(a, b, 5 + b), (a, 5 + b, 5 + a)]
        faces += [2 + k, 2 + k]
    plc = Plc.from_triangles(points, np.array(triangles), np.array(faces))
    mesh = DelaunayMesher.mesh(plc, max_size=1.0, optimise=False, seed=27)
    check_mesh(mesh)
    assert mesh.quality["min_dihedral"] >= 20
    ends = mesh.points[mesh.lines]
    ridge = np.isclose(ends[:, :, 1], 0).all(axis=1) & np.isclose(ends[:, :, 2], 1 + rise).all(axis=1)
    assert np.ptp(ends[ridge], axis=1)[:, 0].sum() == pytest.approx(length)
