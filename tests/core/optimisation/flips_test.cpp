#include "optimisation/flips.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "optimisation/check_mesh.h"
#include "optimisation/collapse.h"
#include "sample_meshes.h"

using namespace dm;

namespace {

// Improves tetrahedron 0 as often as it goes, checks every invariant, returns the number of tetrahedra.
int improve_all(VolumeMesh& mesh) {
  check_volume_mesh(mesh);
  const auto before = sample::angles(mesh);
  const double volume = sample::volume(mesh);
  EditMesh edit(mesh);
  Flipper flipper(edit);
  bool changed = true;
  while (changed) {
    changed = false;
    for (Index t = 0; t < edit.slot_count(); ++t)
      if (!edit.removed(t) && flipper.improve(t)) changed = true;
  }
  edit.finish();
  check_volume_mesh(mesh);
  const auto after = sample::angles(mesh);
  CHECK(sample::keeps(before, after, 1e-2));
  CHECK(sample::volume(mesh) == doctest::Approx(volume));
  return static_cast<int>(mesh.tets.size());
}

}  // namespace

TEST_CASE("a long edge with three tetrahedra gives way to two") {
  auto s = sample::ring(3, 1.2);
  CHECK(improve_all(s.mesh) == 2);
}

TEST_CASE("two flat tetrahedra become three round a new edge") {
  auto s = sample::bipyramid(0.2);
  auto slim = sample::bipyramid(1.5);  // pointed: the new edge would be long, nothing to gain
  CHECK(improve_all(slim.mesh) == 2);
  CHECK(improve_all(s.mesh) == 3);
}

TEST_CASE("the long diagonal of an octahedron is exchanged for a short one") {
  auto s = sample::ring(4, 1.6, 0.1);
  CHECK(improve_all(s.mesh) == 4);
  CHECK(sample::angles(s.mesh).max < 110);
}

TEST_CASE("a long edge with five tetrahedra is removed") {
  auto s = sample::ring(5, 1.9);
  CHECK(improve_all(s.mesh) == 6);
  CHECK(sample::angles(s.mesh).max < 120);
}

TEST_CASE("edges with good rings stay, and rings that are too long are left alone") {
  for (int n = 5; n <= 12; ++n) {
    auto s = sample::ring(n, 0.5);
    CHECK(improve_all(s.mesh) == n);
  }
}

TEST_CASE("boundary edges stay, whatever their angle") {
  VolumeMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.4, 0.4, 0.1}};
  mesh.point_entity.assign(4, {0, 0});
  mesh.tets = {{0, 1, 2, 3}};
  sample::link(mesh);
  Index faces = 0;
  sample::add_boundary(mesh, [&](const Triangle&) { return faces++; });
  CHECK(improve_all(mesh) == 1);
}

TEST_CASE("no interior triangle appears with its corners on one CAD face") {
  auto s = sample::ring(3, 1.2);
  std::fill(s.mesh.triangle_face.begin(), s.mesh.triangle_face.end(), 0);
  CHECK(improve_all(s.mesh) == 3);  // the flip would put a triangle between three points of that face
}

TEST_CASE("a random mesh keeps every invariant under all flips") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    auto s = sample::box(5, 0.24, seed);
    const auto tets = s.mesh.tets;
    improve_all(s.mesh);
    CHECK(s.mesh.tets != tets);
  }
}

TEST_CASE("the cheap flips raise the worst or the mean") {
  for (const FlipGoal goal : {FlipGoal::worst, FlipGoal::mean}) {
    auto s = sample::box(5, 0.24, 3);
    const auto before = sample::angles(s.mesh);
    EditMesh edit(s.mesh);
    Flipper flipper(edit);
    const auto excess = [&] {  // relative to an average element
      double sum = 0;
      for (Index t = 0; t < edit.slot_count(); ++t)
        if (!edit.removed(t)) sum += edit.bad(t) - 0.29;
      return sum;
    };
    const double at_start = excess();
    int flips = 0;
    for (Index t = 0; t < edit.slot_count(); ++t)
      if (!edit.removed(t) && flipper.improve_blunt(t, goal)) ++flips;
    CHECK(flips > 0);
    if (goal == FlipGoal::mean) CHECK(excess() < at_start);
    edit.finish();
    check_volume_mesh(s.mesh);
    CHECK(sample::keeps(before, sample::angles(s.mesh), 1e-2));
  }
}

TEST_CASE("contraction removes an interior point that crowds its neighbours") {
  auto s = sample::box(3, 0);
  const auto crowd = std::find(s.mesh.points.begin(), s.mesh.points.end(), Vec3{1, 1, 1});
  REQUIRE(crowd != s.mesh.points.end());
  *crowd = {1.95, 1, 1};
  const auto before = sample::angles(s.mesh);
  EditMesh edit(s.mesh);
  Index worst = 0;
  for (Index t = 0; t < edit.slot_count(); ++t)
    if (edit.bad(t) > edit.bad(worst)) worst = t;
  const Geometry geometry(s.plc, s.records);
  CHECK(Contractor(edit, geometry).collapse_best(worst));
  edit.finish();
  check_volume_mesh(s.mesh);
  CHECK(s.mesh.points.size() == 63);
  CHECK(sample::angles(s.mesh).min > before.min);
  CHECK(sample::volume(s.mesh) == doctest::Approx(27));
}
