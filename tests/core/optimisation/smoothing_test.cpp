#include "optimisation/smoothing.h"

#include <doctest/doctest.h>

#include "optimisation/check_mesh.h"
#include "sample_meshes.h"

using namespace dm;

TEST_CASE("the fan gives the badness of the plain formula, for both sides") {
  Random random(5);
  Fan fan;
  fan.start({0.1, 0, 0});
  std::vector<std::array<Vec3, 3>> bases;
  for (int i = 0; i < 37; ++i) {
    bases.push_back({random.in_ball(), random.in_ball(), random.in_ball()});
    fan.add(bases[i][0], bases[i][1], bases[i][2]);
  }
  fan.close();
  const Vec3 apex = random.in_ball();
  float bad[Fan::kCapacity], turned[Fan::kCapacity];
  fan_badness(fan, apex, 1, bad);
  fan_badness(fan, apex, -1, turned);
  double sum = 0;
  AngleCosines extremes;
  for (int i = 0; i < 37; ++i) {
    const auto& [a, b, c] = bases[i];
    const double expected =
        std::min(badness(angle_cosines(a, b, c, apex)), badness(angle_cosines(a, c, b, apex)));
    if (expected > 0.66) continue;  // nearly flat: may count as flat
    CHECK(bad[i] == doctest::Approx(badness(angle_cosines(a, b, c, apex))).epsilon(1e-4));
    CHECK(turned[i] == doctest::Approx(badness(angle_cosines(a, c, b, apex))).epsilon(1e-4));
    CHECK((bad[i] == kInverted) != (turned[i] == kInverted));
    extremes.include(angle_cosines(a, b, c, apex));
  }
  const FanScore score = fan_score(fan, apex, true, bad);
  for (int i = 0; i < 37; ++i) {
    const auto& [a, b, c] = bases[i];
    const AngleCosines angles = angle_cosines(a, b, c, apex);
    const double soft = std::max(angles.sharp - 1.0 / 3, 0.35 * (1.0 / 3 - angles.blunt));
    sum += bad[i] == kInverted ? kInverted * kInverted : soft * soft;
  }
  CHECK(score.sum == doctest::Approx(sum));
  CHECK(score.extremes.sharp == doctest::Approx(extremes.sharp));
  CHECK(score.extremes.blunt == doctest::Approx(extremes.blunt));
}

TEST_CASE("a flat fan is inverted, not a number") {
  Fan fan;
  fan.start({0.1, 0, 0});
  fan.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  fan.add({0, 0, 0}, {0, 0, 0}, {0, 1, 0});
  fan.close();
  float bad[Fan::kCapacity];
  fan_badness(fan, {0.2, 0.2, 0}, 1, bad);
  CHECK(bad[0] == kInverted);
  CHECK(bad[1] == kInverted);
}

TEST_CASE("an interior point goes back to the middle of its star") {
  auto s = sample::box(2, 0);
  const Geometry geometry(s.plc, s.records);
  s.mesh.points[13] = {1.3, 0.8, 1.25};
  EditMesh edit(s.mesh);
  Smoother smoother(edit, geometry);
  const double before = sample::angles(s.mesh).min;
  for (int i = 0; i < 10; ++i) smoother.smooth_worst(13, 4);
  CHECK(sample::angles(s.mesh).min > before + 5);
  check_volume_mesh(s.mesh);
}

TEST_CASE("one soft step takes an interior point all the way to the middle of its neighbours") {
  auto s = sample::box(2, 0);
  const Geometry geometry(s.plc, s.records);
  s.mesh.points[13] = {1.3, 0.7, 1.3};
  EditMesh edit(s.mesh);
  Smoother smoother(edit, geometry);
  CHECK(smoother.smooth_soft(13, 1));
  CHECK(distance(edit.point(13), {1, 1, 1}) < 0.1);
}

TEST_CASE("an angle gets worse only in the range that is free, wider where the other one was bad") {
  const auto angles = [](double sharp, double blunt) {
    return AngleCosines{std::cos(sharp * std::numbers::pi / 180), std::cos(blunt * std::numbers::pi / 180)};
  };
  CHECK(keeps_angles(angles(40, 100), angles(31, 135)));
  CHECK(!keeps_angles(angles(40, 100), angles(29, 135)));
  CHECK(!keeps_angles(angles(29, 100), angles(31, 137)));
  CHECK(keeps_angles(angles(18, 136), angles(26, 139)));
  CHECK(!keeps_angles(angles(18, 136), angles(26, 141)));
  CHECK(!keeps_angles(angles(18, 136), angles(17.9, 120)));
  CHECK(keeps_angles(angles(31, 150), angles(27, 145)));
  CHECK(!keeps_angles(angles(31, 150), angles(26, 145)));
}

TEST_CASE("smoothing never lowers the worst of a star and keeps points on their CAD elements") {
  auto s = sample::box(4, 0.3, 11);
  const Geometry geometry(s.plc, s.records);
  EditMesh edit(s.mesh);
  Smoother smoother(edit, geometry);
  int moved = 0;
  for (const bool soft : {true, false, true, false})
    for (Index v = 0; v < edit.vertex_count(); ++v) {
      AngleCosines before, after;
      for (Index t : edit.star(v)) before.include(edit.cosines(edit.tet(t)));
      const Vec3 old = edit.point(v);
      const bool changed = soft ? smoother.smooth_soft(v, 2) : smoother.smooth_worst(v, 2);
      for (Index t : edit.star(v)) {
        after.include(edit.cosines(edit.tet(t)));
        CHECK(edit.bad(t) == doctest::Approx(badness(edit.cosines(edit.tet(t)))).epsilon(1e-4));
      }
      const bool poor = before.sharp > 0.894 || before.blunt < -0.765;
      CHECK(after.sharp <= std::max(before.sharp, poor ? 0.895 : 0.866) + 1e-5);
      CHECK(after.blunt >= std::min(before.blunt, poor ? -0.7661 : -0.7193) - 1e-5);
      CHECK(changed == !(edit.point(v) == old));
      if (edit.entity(v).dimension == 0) CHECK(!changed);
      moved += changed;
    }
  CHECK(moved > 100);
  check_volume_mesh(s.mesh);
  check_on_geometry(s.mesh, geometry, 1e-9);
}

TEST_CASE("a shift keeps every tetrahedron positive and points on their CAD elements") {
  for (const bool round : {false, true}) {
    auto s = round ? sample::cylinder(1, 2, 9, 3) : sample::box(4, 0.3, 11);
    const Geometry geometry(s.plc, s.records);
    EditMesh edit(s.mesh);
    Smoother smoother(edit, geometry);
    std::array<int, 4> shifted{};  // by the dimension of what the point lies on
    for (Index v = 0; v < edit.vertex_count(); ++v)
      for (int k = 0; k < 8; ++k) {
        const Vec3 old = edit.point(v);
        if (!smoother.shift(v, k)) continue;
        ++shifted[edit.entity(v).dimension];
        CHECK(!(edit.point(v) == old));
        for (Index t : edit.star(v))
          CHECK(edit.bad(t) == doctest::Approx(badness(edit.cosines(edit.tet(t)))).epsilon(1e-4));
      }
    CHECK(shifted[0] == 0);
    for (int dimension = 1; dimension < 4; ++dimension) CHECK(shifted[dimension] > 0);
    check_volume_mesh(s.mesh);
    check_on_geometry(s.mesh, geometry, 1e-9);
  }
}

TEST_CASE("boundary points slide on a curved face") {
  auto s = sample::cylinder(1, 2, 9, 3);
  const Geometry geometry(s.plc, s.records);
  for (std::size_t v = 0; v < s.mesh.points.size(); ++v) {
    const Entity e = s.mesh.point_entity[v];
    const Vec3 shift = 0.12 * Random(3, v).in_ball();
    if (e.dimension >= 2) s.mesh.points[v] = geometry.project(e, s.mesh.points[v] + shift);
  }
  check_volume_mesh(s.mesh);
  const auto before = sample::angles(s.mesh);
  EditMesh edit(s.mesh);
  Smoother smoother(edit, geometry);
  int moved = 0;
  for (int i = 0; i < 4; ++i)
    for (Index v = 0; v < edit.vertex_count(); ++v)
      if (edit.entity(v).dimension < 3) moved += smoother.smooth_worst(v, 2);
  CHECK(moved > 0);
  CHECK(sample::angles(s.mesh).min >= before.min);
  check_volume_mesh(s.mesh);
  check_on_geometry(s.mesh, geometry, 1e-9);
}

TEST_CASE("a point at which two parts touch stays") {
  VolumeMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.point_entity.assign(7, {2, 0});
  mesh.tets = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  mesh.neighbours.assign(2, {-1, -1, -1, -1});
  mesh.tet_solid = {1, 1};
  EditMesh edit(mesh);
  CHECK(edit.pinched(0));
  for (Index v = 1; v < 7; ++v) CHECK_FALSE(edit.pinched(v));
}
