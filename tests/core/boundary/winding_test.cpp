// Winding numbers of closed surfaces, together and by themselves.
#include "boundary/winding.h"

#include <doctest/doctest.h>

#include "../surfaces/shapes.h"

using namespace dm;

TEST_CASE("winding: 1 inside, 0 outside, 2 where two bodies overlap") {
  shapes::Shape s = shapes::sphere(5, 40);
  shapes::box_walls(s, {3, -1, -1}, {9, 1, 1}, 1, false, 0);
  const WindingNumber winding(s.plc.points, s.plc.triangles);
  CHECK(winding.at({0, 0, 0}) == doctest::Approx(1).epsilon(0.02));
  CHECK(winding.at({8, 0, 0}) == doctest::Approx(1).epsilon(0.02));
  CHECK(winding.at({4, 0, 0}) == doctest::Approx(2).epsilon(0.02));
  CHECK(winding.at({0, 0, 8}) == doctest::Approx(0).epsilon(0.02));
  CHECK(winding.at({100, 20, 30}) == doctest::Approx(0).epsilon(0.02));
}

TEST_CASE("winding: changes across a triangle, however near") {
  const shapes::Shape s = shapes::box(6, 4, 3);
  const WindingNumber winding(s.plc.points, s.plc.triangles);
  for (const double d : {1.0, 1e-3, 1e-9}) {
    CHECK(winding.at({2.1, 1.7, 3 - d}) == doctest::Approx(1).epsilon(0.02));
    CHECK(winding.at({2.1, 1.7, 3 + d}) == doctest::Approx(0).epsilon(0.02));
  }
}
