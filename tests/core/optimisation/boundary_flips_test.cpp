#include <doctest/doctest.h>

#include "optimisation/check_mesh.h"
#include "optimisation/flips.h"
#include "sample_meshes.h"

using namespace dm;

namespace {

// A pyramid over a rhombus whose long diagonal is an edge; the base is CAD face 0.  Points 0 and 1 are the
// ends of the diagonal, 4 the apex.
sample::Sample pyramid(double half_long, double half_short) {
  sample::Sample s;
  s.mesh.points = {
      {-half_long, 0, 0}, {half_long, 0, 0}, {0, half_short, 0}, {0, -half_short, 0}, {0, 0, 0.8}};
  s.mesh.point_entity.assign(5, {0, 0});
  s.mesh.tets = {{0, 1, 2, 4}, {0, 1, 3, 4}};
  sample::link(s.mesh);
  Index sides = 0;
  sample::add_boundary(s.mesh,
                       [&](const Triangle& t) { return t[0] < 4 && t[1] < 4 && t[2] < 4 ? 0 : ++sides; });
  s.records.faces.resize(5);
  s.records.faces[0].kind = SurfaceKind::plane;
  s.records.faces[0].axis = {0, 0, 1};
  s.plc = sample::boundary_plc(s.mesh, 5, 0);
  return s;
}

bool flip_any(sample::Sample& s) {
  const Geometry geometry(s.plc, s.records);
  EditMesh edit(s.mesh);
  Flipper flipper(edit);
  const bool done = flipper.improve_boundary(0, geometry) || flipper.improve_boundary(1, geometry);
  edit.finish();
  check_volume_mesh(s.mesh);
  return done;
}

}  // namespace

TEST_CASE("the long diagonal of two boundary triangles is exchanged with the elements behind it") {
  auto s = pyramid(1.3, 0.5);
  const auto before = sample::angles(s.mesh);
  const double volume = sample::volume(s.mesh);
  CHECK(flip_any(s));
  CHECK(sample::angles(s.mesh).min > before.min);
  CHECK(sample::volume(s.mesh) == doctest::Approx(volume));
  for (std::size_t k = 0; k < s.mesh.triangles.size(); ++k) {
    if (s.mesh.triangle_face[k] != 0) continue;
    const Triangle& t = s.mesh.triangles[k];
    const bool has_short = (t[0] == 2 || t[1] == 2 || t[2] == 2) && (t[0] == 3 || t[1] == 3 || t[2] == 3);
    CHECK(has_short);
    CHECK(area_vector(s.mesh.points[t[0]], s.mesh.points[t[1]], s.mesh.points[t[2]]).z < 0);  // outward
  }
  CHECK(!flip_any(s));
}

TEST_CASE("the short diagonal stays") {
  auto s = pyramid(0.5, 1.3);
  CHECK(!flip_any(s));
}

TEST_CASE("a diagonal that is a segment or lies between two CAD faces stays") {
  auto s = pyramid(1.3, 0.5);
  s.mesh.segments = {{0, 1}};
  s.mesh.segment_edge = {0};
  CHECK(!flip_any(s));
  auto two = pyramid(1.3, 0.5);
  for (std::size_t k = 0; k < two.mesh.triangles.size(); ++k)
    if (two.mesh.triangle_face[k] == 0) {
      two.mesh.triangle_face[k] = 1;
      break;
    }
  CHECK(!flip_any(two));
}

TEST_CASE("boundary flips keep every invariant of a random mesh") {
  int flips = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto s = sample::box(4, 0.24, seed);
    const Geometry geometry(s.plc, s.records);
    EditMesh edit(s.mesh);
    Flipper flipper(edit);
    for (Index t = 0; t < edit.slot_count(); ++t)
      if (!edit.removed(t)) flips += flipper.improve_boundary(t, geometry);
    edit.finish();
    check_volume_mesh(s.mesh);
    check_on_geometry(s.mesh, geometry, 1e-9);
    CHECK(sample::volume(s.mesh) == doctest::Approx(64));
  }
  CHECK(flips > 0);
}

// Below the base of the pyramid, bent down at its short diagonal: two triangles of the base are its own, and
// one of them may be folded back on the other.
TEST_CASE("a flat tetrahedron with two triangles of a CAD face is peeled off, or put back by a trial") {
  Vec3 end;
  SUBCASE("side by side") { end = {0.5, 0, 0}; }
  SUBCASE("folded") { end = {-0.1, 0, -0.07}; }
  auto s = pyramid(0.5, 0.5);
  s.mesh.points[1] = end;
  s.mesh.points[2].z = s.mesh.points[3].z = -0.1;
  s.mesh.tets.push_back({0, 1, 2, 3});
  s.mesh.tet_solid.push_back(1);
  sample::link(s.mesh);
  s.mesh.triangles.clear();
  s.mesh.triangle_face.clear();
  Index sides = 0;
  sample::add_boundary(s.mesh,
                       [&](const Triangle& t) { return t[0] < 4 && t[1] < 4 && t[2] < 4 ? 0 : ++sides; });
  s.plc = sample::boundary_plc(s.mesh, 5, 0);
  const Geometry geometry(s.plc, s.records);
  const VolumeMesh before = s.mesh;
  EditMesh edit(s.mesh);
  Flipper flipper(edit);
  edit.start_clock();
  edit.begin_trial();
  CHECK(flipper.improve_boundary(2, geometry));
  edit.end_trial(false);
  CHECK(s.mesh.tets == before.tets);
  CHECK(s.mesh.neighbours == before.neighbours);
  CHECK(s.mesh.triangles == before.triangles);
  const Index start = edit.now();
  CHECK(!flipper.improve_boundary(0, geometry));
  CHECK(flipper.improve_boundary(2, geometry));
  for (Index v = 0; v < 5; ++v) CHECK(edit.last_change(v) > start);
  edit.finish();
  check_volume_mesh(s.mesh);
  CHECK(s.mesh.tets.size() == 2);
  for (std::size_t k = 0; k < s.mesh.triangles.size(); ++k) {
    if (s.mesh.triangle_face[k] != 0) continue;
    const Triangle& t = s.mesh.triangles[k];
    CHECK(((t[0] == 0 || t[1] == 0 || t[2] == 0) && (t[0] == 1 || t[1] == 1 || t[2] == 1)));
    CHECK(area_vector(s.mesh.points[t[0]], s.mesh.points[t[1]], s.mesh.points[t[2]]).z < 0);  // outward
  }
}
