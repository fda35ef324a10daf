#include "optimisation/rescue.h"

#include <doctest/doctest.h>

#include "optimisation/check_mesh.h"
#include "sample_meshes.h"

using namespace dm;

namespace {

struct Tools {
  const Geometry geometry;
  EditMesh edit;
  Smoother smoother;
  Flipper flipper;
  Contractor contractor;
  Inserter inserter;
  Rescuer rescuer;
  explicit Tools(sample::Sample& s)
      : geometry(s.plc, s.records),
        edit(s.mesh),
        smoother(edit, geometry),
        flipper(edit),
        contractor(edit, geometry),
        inserter(edit, smoother, geometry),
        rescuer(edit, smoother, flipper, contractor, geometry) {
    edit.start_clock();
  }
};

void check(const sample::Sample& s, const Geometry& geometry) {
  check_volume_mesh(s.mesh);
  check_on_geometry(s.mesh, geometry, 1e-9);
}

bool is_on_boundary(const Entity& e) { return e.dimension < 3; }

}  // namespace

TEST_CASE("points are put inside, on boundary edges, segments and triangles, also between two solids") {
  for (const bool two : {false, true}) {
    auto s = two ? sample::two_boxes(0.2, 3) : sample::box(4, 0.2, 3);
    const double volume = sample::volume(s.mesh);
    const auto segments = s.mesh.segments.size(), triangles = s.mesh.triangles.size();
    Tools tools(s);
    std::array<int, 4> inserted{};  // by the dimension of what the point lies on
    int on_interface = 0;
    const Index count = tools.edit.slot_count();
    for (Index t = 0; t < count; t += 3)
      for (int place = 0; place < Inserter::kPlaces; ++place) {
        if (tools.edit.removed(t) || !tools.inserter.insert(t, place)) continue;
        const Entity e = tools.edit.entity(tools.edit.vertex_count() - 1);
        ++inserted[e.dimension];
        on_interface += two && e == Entity{2, 6};
        CHECK((place == 0) == (e.dimension == 3));
        break;
      }
    for (Index t = 1; t < count; t += 3)
      for (int place = 1; place < Inserter::kPlaces; ++place) {
        if (tools.edit.removed(t) || !tools.inserter.insert(t, place)) continue;
        const Entity e = tools.edit.entity(tools.edit.vertex_count() - 1);
        ++inserted[e.dimension];
        on_interface += two && e == Entity{2, 6};
        break;
      }
    CHECK(inserted[3] > 0);
    CHECK(inserted[2] > 0);
    CHECK(inserted[1] > 0);
    CHECK((on_interface > 0) == two);
    tools.edit.finish();
    check(s, tools.geometry);
    CHECK(sample::volume(s.mesh) == doctest::Approx(volume));
    CHECK(s.mesh.segments.size() == segments + inserted[1]);
    CHECK(s.mesh.triangles.size() > triangles);
  }
}

TEST_CASE("points of CAD faces and edges are contracted along them") {
  for (const bool two : {false, true}) {
    auto s = two ? sample::two_boxes(0.1, 3) : sample::box(4, 0.1, 3);
    const double volume = sample::volume(s.mesh);
    const auto points = s.mesh.points.size();
    Tools tools(s);
    std::array<std::size_t, 4> contracted{};
    for (Index t = 0; t < tools.edit.slot_count(); ++t) {
      if (tools.edit.removed(t)) continue;
      const Tet c = tools.edit.tet(t);
      const Entity from = tools.edit.entity(c[0]), to = tools.edit.entity(c[1]);
      if (!tools.contractor.contract(c[0], c[1])) continue;
      ++contracted[from.dimension];
      CHECK(from.dimension > 0);
      if (is_on_boundary(from)) CHECK(is_on_boundary(to));
      CHECK(tools.edit.vertex_tet(c[0]) == -1);
    }
    CHECK(contracted[3] > 0);
    CHECK(contracted[2] > 0);
    CHECK(contracted[1] > 0);
    tools.edit.finish();
    check(s, tools.geometry);
    CHECK(s.mesh.points.size() == points - contracted[1] - contracted[2] - contracted[3]);
    CHECK(s.mesh.segments.size() == 48 - contracted[1]);
    CHECK(sample::volume(s.mesh) == doctest::Approx(volume));
  }
}

// Two tetrahedra on the triangle (0, 1, 2), whose sides all lie on the boundary, and on each of them another
// one over the edge (0, 2).
TEST_CASE("an edge round which the boundary runs in a ring of three is not contracted") {
  sample::Sample s;
  s.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {-1, 0, 1}, {-1, 0, -1}};
  s.mesh.point_entity.assign(7, {0, 0});
  s.mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 3, 2, 5}, {0, 2, 4, 6}};
  for (Tet& t : s.mesh.tets) {
    const Vec3 &a = s.mesh.points[t[0]], &b = s.mesh.points[t[1]], &c = s.mesh.points[t[2]];
    if (dot(area_vector(a, b, c), s.mesh.points[t[3]] - a) < 0) std::swap(t[0], t[1]);
  }
  sample::link(s.mesh);
  Index faces = 0;
  sample::add_boundary(s.mesh, [&](const Triangle&) { return faces++; });
  EditMesh mesh(s.mesh);
  CHECK(breaks_link(mesh, 0, 1));
  CHECK(breaks_link(mesh, 1, 0));
  CHECK_FALSE(breaks_link(mesh, 5, 3));
  CHECK_FALSE(breaks_link(mesh, 0, 5));
}

TEST_CASE("a trial that is taken back leaves every byte as it was") {
  auto s = sample::two_boxes(0.2, 4);
  const VolumeMesh before = s.mesh;
  Tools tools(s);
  int changes = 0;
  for (Index t = 0; t < tools.edit.slot_count(); ++t)
    for (int place = 0; place < Inserter::kPlaces; ++place) {
      tools.edit.begin_trial();
      if (tools.inserter.insert(t, place)) {
        const Index v = tools.edit.vertex_count() - 1;
        const auto star = tools.edit.star(v);
        const std::vector<Index> around(star.begin(), star.end());
        for (const Index n : around) {
          if (tools.edit.removed(n)) continue;
          const Tet c = tools.edit.tet(n);
          changes += tools.smoother.smooth_worst(c[0], 1) + tools.flipper.improve(n);
          if (!tools.edit.removed(n)) changes += tools.flipper.improve_boundary(n, tools.geometry);
          if (!tools.edit.removed(n)) changes += tools.contractor.contract(c[1], c[0]);
        }
      }
      tools.edit.end_trial(false);
    }
  CHECK(changes > 1000);
  CHECK(s.mesh.points == before.points);
  CHECK(s.mesh.point_entity == before.point_entity);
  CHECK(s.mesh.tets == before.tets);
  CHECK(s.mesh.neighbours == before.neighbours);
  CHECK(s.mesh.tet_solid == before.tet_solid);
  CHECK(s.mesh.triangles == before.triangles);
  CHECK(s.mesh.triangle_face == before.triangle_face);
  CHECK(s.mesh.segments == before.segments);
  CHECK(s.mesh.segment_edge == before.segment_edge);
  for (Index t = 0; t < tools.edit.slot_count(); ++t)
    CHECK(tools.edit.bad(t) == tools.edit.compute_bad(tools.edit.tet(t)));
}

TEST_CASE("poor elements are rescued, none that a rescue touches gets worse") {
  auto s = sample::slab(4, 0.5, 5);
  Tools tools(s);
  const auto count_poor = [&] {
    int count = 0;
    for (Index t = 0; t < tools.edit.slot_count(); ++t)
      count += !tools.edit.removed(t) && tools.edit.bad(t) >= badness_at(25);
    return count;
  };
  const int poor = count_poor();
  int rescued = 0;
  for (int round = 0; round < 3; ++round)
    for (Index t = 0; t < tools.edit.slot_count(); ++t) {
      if (tools.edit.removed(t) || tools.edit.bad(t) < badness_at(25)) continue;
      const auto before = sample::angles_of(tools.edit);
      rescued += tools.rescuer.rescue(t, Rescuer::kMostEffort);
      const auto now = sample::angles_of(tools.edit);
      CHECK(sample::keeps(before, now, 1e-6));
    }
  CHECK(rescued > 10);
  CHECK(poor > 50);
  CHECK(count_poor() == 0);
  tools.edit.finish();
  check(s, tools.geometry);
  CHECK(sample::volume(s.mesh) == doctest::Approx(32));
}

TEST_CASE("edges from side to side through a wall are divided inside it") {
  auto s = sample::box(1, 0);  // all corners on the boundary, one edge is not
  Tools tools(s);
  int inside = 0;
  for (int place = 1; place <= 6; ++place) {
    tools.edit.begin_trial();
    if (tools.inserter.insert(0, place)) inside += tools.edit.interior(tools.edit.vertex_count() - 1);
    tools.edit.end_trial(false);
  }
  CHECK(inside == 1);
  CHECK(tools.inserter.insert(0, 1));  // the longest
  CHECK(distance(tools.edit.point(tools.edit.vertex_count() - 1), {0.5, 0.5, 0.5}) < 0.1);
  tools.edit.finish();
  check(s, tools.geometry);
  CHECK(sample::volume(s.mesh) == doctest::Approx(1));
}

// Elements of more than 166 degrees were refused as flat: a needle of a boundary edge has no others at first.
TEST_CASE("a point may be put where new elements are nearly flat at first, not flat") {
  auto s = sample::slab(4, 0.1, 5);
  Tools tools(s);
  AngleCosines all;
  for (Index t = 0; t < tools.edit.slot_count(); ++t) {
    tools.edit.begin_trial();
    if (tools.inserter.insert(t, 0))
      for (const Index n : tools.edit.star(tools.edit.vertex_count() - 1))
        all.include(tools.edit.cosines(tools.edit.tet(n)));
    tools.edit.end_trial(false);
  }
  CHECK(all.blunt < -0.98);    // 168.5 degrees
  CHECK(all.blunt > -0.9994);  // 178
  CHECK(all.sharp < 0.99985);  // 1
}

// Where CAD faces lie on each other, a triangle of one is one of the other too.
TEST_CASE("boundary triangles and segments that are listed twice stay with all their points") {
  auto s = sample::box(4, 0.1, 3);
  const auto triangles = s.mesh.triangles.size(), segments = s.mesh.segments.size();
  for (std::size_t k = 0; k < triangles; k += 3) {
    s.mesh.triangles.push_back(s.mesh.triangles[k]);
    s.mesh.triangle_face.push_back(s.mesh.triangle_face[k]);
  }
  for (std::size_t k = 0; k < segments; k += 5) {
    s.mesh.segments.push_back(s.mesh.segments[k]);
    s.mesh.segment_edge.push_back(s.mesh.segment_edge[k]);
  }
  const VolumeMesh before = s.mesh;
  Tools tools(s);
  int contracted = 0;
  for (Index t = 0; t < tools.edit.slot_count(); ++t)
    for (int place = 0; place < Inserter::kPlaces; ++place) {
      if (tools.edit.removed(t)) continue;
      const Tet c = tools.edit.tet(t);
      contracted += tools.contractor.contract(c[place % 4], c[(place + 1) % 4]);
      if (!tools.edit.removed(t) && t % 7 == 0) tools.inserter.insert(t, place);
    }
  CHECK(contracted > 20);
  for (std::size_t k = 0; k < triangles; k += 3) CHECK(s.mesh.triangles[k] == before.triangles[k]);
  for (std::size_t k = triangles; k < before.triangles.size(); ++k)
    for (const Index v : s.mesh.triangles[k]) CHECK(tools.edit.vertex_tet(v) >= 0);
  for (std::size_t k = segments; k < before.segments.size(); ++k)
    for (const Index v : s.mesh.segments[k]) CHECK(tools.edit.vertex_tet(v) >= 0);
}

TEST_CASE("the clock tells whose neighbourhood has changed, by trials only when they are kept") {
  auto s = sample::box(4, 0.2, 3);
  Tools tools(s);
  for (const bool keep : {false, true}) {
    const Index start = tools.edit.now(), count = tools.edit.vertex_count();
    tools.edit.begin_trial();
    Index t = 0;
    while (tools.edit.removed(t) || !tools.inserter.insert(t, 0)) ++t;
    const Index v = tools.edit.vertex_count() - 1;
    const auto star = tools.edit.star(v);
    std::vector<char> beside(count + 1, 0);
    for (const Index n : star)
      for (const Index w : tools.edit.tet(n)) beside[w] = 1;
    tools.edit.end_trial(keep);
    for (Index w = 0; w < tools.edit.vertex_count(); ++w)
      CHECK((tools.edit.last_change(w) > start) == (keep && beside[w]));
  }
}

TEST_CASE("a rescue that failed is not tried again until something beside it has changed") {
  auto s = sample::slab(4, 0.15, 5);
  Tools tools(s);
  Index stuck = -1;
  for (Index t = 0; stuck < 0 && t < tools.edit.slot_count(); ++t)
    if (!tools.edit.removed(t) && tools.edit.bad(t) > badness_at(25) &&
        !tools.rescuer.rescue(t, Rescuer::kMostEffort))
      stuck = t;
  REQUIRE(stuck >= 0);
  const auto tries = tools.rescuer.tries();
  CHECK(tries > 0);
  CHECK(!tools.rescuer.rescue(stuck, Rescuer::kMostEffort));
  CHECK(tools.rescuer.tries() == tries);
}
