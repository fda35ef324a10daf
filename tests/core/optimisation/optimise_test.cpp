#include "optimisation/optimise.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "optimisation/check_mesh.h"
#include "optimisation/quality.h"
#include "sample_meshes.h"

using namespace dm;

namespace {

OptimiseReport run(sample::Sample& s, Context& context) {
  const Geometry geometry(s.plc, s.records);
  const auto report = optimise(s.mesh, geometry, {}, context);
  check_volume_mesh(s.mesh);
  check_on_geometry(s.mesh, geometry, 1e-9);
  return report;
}

double mean_angle(const VolumeMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets)
    sum += dihedral_range(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]).min;
  return sum / static_cast<double>(mesh.tets.size());
}

double share_below_30(const VolumeMesh& mesh) {
  double count = 0;
  for (const Tet& t : mesh.tets)
    count +=
        dihedral_range(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]).min < 30;
  return count / static_cast<double>(mesh.tets.size());
}

}  // namespace

TEST_CASE("the angles get better at both ends and on average, the volume stays") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto s = sample::box(6, 0.25, seed);
    const auto before = sample::angles(s.mesh);
    const double mean = mean_angle(s.mesh);
    Context context;
    const auto report = run(s, context);
    const auto after = sample::angles(s.mesh);
    CHECK(report.min_before == doctest::Approx(before.min));
    CHECK(report.max_before == doctest::Approx(before.max));
    CHECK(report.min_after == doctest::Approx(after.min));
    CHECK(report.max_after == doctest::Approx(after.max));
    CHECK(after.min > before.min);
    CHECK(after.max < before.max);
    CHECK(mean_angle(s.mesh) > mean);
    CHECK(sample::volume(s.mesh) == doctest::Approx(216));
    CHECK(report.flipped > 0);
    CHECK(report.smoothed > 0);
  }
}

TEST_CASE("the mean of the smallest angles is what the rounds over the mesh raise") {
  auto s = sample::box(14, 0.3, 1);
  Context context;
  run(s, context);
  CHECK(mean_angle(s.mesh) > 49.6);  // 49.39 where large angles count as much as the guard does
}

TEST_CASE("the boundary keeps its triangles and its CAD elements") {
  auto s = sample::cylinder(1, 2, 12, 4);
  const auto faces = s.mesh.triangle_face;
  const auto edges = s.mesh.segment_edge;
  Context context;
  run(s, context);
  CHECK(s.mesh.triangles.size() == faces.size());
  CHECK(s.mesh.triangle_face == faces);
  CHECK(s.mesh.segment_edge == edges);
}

TEST_CASE("same mesh, same bytes") {
  auto a = sample::box(5, 0.3, 9), b = a;
  Context first, second;
  second.threads = 4;
  run(a, first);
  run(b, second);
  REQUIRE(a.mesh.points.size() == b.mesh.points.size());
  CHECK(std::memcmp(a.mesh.points.data(), b.mesh.points.data(), a.mesh.points.size() * sizeof(Vec3)) == 0);
  CHECK(a.mesh.tets == b.mesh.tets);
  CHECK(a.mesh.neighbours == b.mesh.neighbours);
}

TEST_CASE("optimising twice changes little and spoils nothing") {
  auto s = sample::box(5, 0.25, 4);
  Context context;
  run(s, context);
  const auto once = sample::angles(s.mesh);
  run(s, context);
  const auto twice = sample::angles(s.mesh);
  CHECK(sample::keeps(once, twice, 1e-2));
}

TEST_CASE("two solids keep the faces between them") {
  auto s = sample::two_boxes(0.2, 6);
  VolumeMesh& m = s.mesh;
  check_volume_mesh(m);
  const Geometry geometry(s.plc, s.records);
  Context context;
  const auto before = sample::angles(m);
  optimise(m, geometry, {}, context);
  check_volume_mesh(m);
  check_on_geometry(m, geometry, 1e-9);
  CHECK(sample::angles(m).min >= before.min);
  double first = 0;
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    const Tet& c = m.tets[t];
    if (m.tet_solid[t] == 1)
      first +=
          dot(area_vector(m.points[c[0]], m.points[c[1]], m.points[c[2]]), m.points[c[3]] - m.points[c[0]]) /
          6;
  }
  CHECK(first == doctest::Approx(32));
}

// Without rescues the smallest angle is 24.6 degrees here.
TEST_CASE("a flattened box, poor everywhere, gets good angles") {
  auto s = sample::slab(4, 0.5, 5);
  Context context;
  const auto report = run(s, context);
  CHECK(report.rescued > 0);
  CHECK(report.min_after > 25);
  CHECK(report.max_after < 142);
  CHECK(sample::volume(s.mesh) == doctest::Approx(32));
}

// Ten of them with all kinds of rescue tried at once for one element after the other.
TEST_CASE("slabs far thinner than their elements get the several points that they need") {
  int good = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    auto s = sample::slab(4, 0.25, seed);
    Context context;
    const auto report = run(s, context);
    good += report.min_after > 20 && report.max_after < 142;
  }
  CHECK(good >= 13);
}

TEST_CASE("a rescue beside an element that is as bad and stays counts") {
  double share = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    auto s = sample::slab(8, 0.4, seed);
    Context context;
    run(s, context);
    share += share_below_30(s.mesh) / 15;
  }
  CHECK(share < 0.002);  // it was 0.016
}

// Without shifts 9 of the 20.
TEST_CASE("elements that no step of smoothing betters are bettered by shifts") {
  int good = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    auto s = sample::slab(6, 0.5, seed);
    Context context;
    const auto report = run(s, context);
    good += report.min_after > 29.99;
  }
  CHECK(good >= 18);
}

TEST_CASE("large walls get the rescues that small ones get, because those that help earn more") {
  auto s = sample::slab(20, 0.15, 3);
  Context context;
  const auto report = run(s, context);
  CHECK(report.min_after > 25);           // it was 20.5
  CHECK(share_below_30(s.mesh) < 0.005);  // it was 0.106
}

TEST_CASE("the number of threads changes no byte") {
  auto one = sample::box(12, 0.25, 2);
  auto many = one;
  Context context;
  run(one, context);
  context.threads = 3;
  run(many, context);
  CHECK(one.mesh.points == many.mesh.points);
  CHECK(one.mesh.tets == many.mesh.tets);
  CHECK(one.mesh.triangles == many.mesh.triangles);
}

TEST_CASE("it can be cancelled while several threads work") {
  auto s = sample::box(12, 0.25, 4);
  int calls = 0;
  Context context([&](const char* stage, double) {
    if (std::strcmp(stage, "optimisation") != 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(40));  // the next poll is a report again
    return ++calls < 2;
  });
  context.threads = 2;
  CHECK_THROWS_AS(run(s, context), Cancelled);
  CHECK(calls == 2);
}

TEST_CASE("it can be cancelled") {
  auto s = sample::box(5, 0.25, 4);
  Context context([](const char* stage, double) { return std::strcmp(stage, "optimisation") != 0; });
  CHECK_THROWS_AS(run(s, context), Cancelled);
}
