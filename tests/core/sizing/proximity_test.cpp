#include "sizing/proximity.h"

#include <doctest/doctest.h>

#include "field.h"

using namespace dm;
using test::across;
using test::Field;

TEST_CASE("boundary edges of a free wall are twice its thickness") {
  const double h = 2 / kBoundaryEdge;
  Field f(test::box({0, 0, 0}, {50, 50, 1}), across(10));
  for (double x = 3; x < 50; x += 4) CHECK(f.at({x, 25, 0.5}) == doctest::Approx(h).epsilon(0.1));
  CHECK(f.field.warnings().empty());
  Field finer(test::box({0, 0, 0}, {50, 50, 1}), across(10, 4));
  CHECK(finer.at({25, 25, 0}) == doctest::Approx(h / 2).epsilon(0.1));
  Field off(test::box({0, 0, 0}, {50, 50, 1}), across(10, 0));
  CHECK(off.at({25, 25, 0}) == 10);
}

TEST_CASE("boundary edges of a wall with a tight gap beside it are 1.48 times its thickness") {
  test::Shape shape;
  test::add_box(shape.plc, {0, 0, 0}, {20, 20, 1});
  test::add_box(shape.plc, {0, 0, 2}, {20, 20, 3});
  Field f(shape, across(10));
  CHECK(f.at({10, 10, 1}) == doctest::Approx(1.48 / kBoundaryEdge).epsilon(0.1));
}

TEST_CASE("a narrow gap between thick solids") {
  test::Shape shape;
  test::add_box(shape.plc, {0, 0, 0}, {20, 20, 20});
  test::add_box(shape.plc, {21, 0, 0}, {40, 20, 20});
  Field f(shape, across(10));
  const double h = 4.8 / kBoundaryEdge;
  CHECK(f.at({20, 10, 10}) == doctest::Approx(h).epsilon(0.1));
  CHECK(f.at({10, 10, 10}) == doctest::Approx(h + 2.5).epsilon(0.1));
}

TEST_CASE("a wedge is no wall") {
  for (const double degrees : {89.0, 60.0, 59.0, 45.0, 30.0, 15.0, 5.0, 1.0}) {
    Field f(test::wedge(degrees), across(0.05));
    CHECK(f.field.smallest() == 0.05);
  }
}

TEST_CASE("elements grow smoothly while a plate gets thinner, and stay in the budget") {
  double before = 0;
  for (double t = 10; t > 0.04; t *= 0.8) {
    Field f(test::box({0, 0, 0}, {100, 100, t}), across(10));
    const double elements = f.field.predicted_tetrahedra();
    CHECK(elements < 130'000);
    if (before > 0) CHECK(elements < 2.3 * before);
    before = elements;
    const bool limited = !f.field.warnings().empty();
    if (f.field.smallest() < 1.84 / kBoundaryEdge * t) CHECK_FALSE(limited);
    if (f.field.smallest() > 2.08 / kBoundaryEdge * t) CHECK(limited);
  }
}

TEST_CASE("the size floor ends what walls ask for") {
  SizeOptions options = across(10);
  options.min_size = 4;
  Field f(test::box({0, 0, 0}, {100, 100, 0.5}), options);
  CHECK(f.field.smallest() == 4);
  CHECK(f.at({50, 50, 0}) == doctest::Approx(4).epsilon(0.02));
}

TEST_CASE("cylinders almost touching: small only at the contact") {
  for (const double gap : {1.0, 0.1, 1e-2, 1e-3, 1e-4}) {
    test::Shape shape;
    test::add_cylinder(shape, {0, 0, 0}, 10, 20, 36);
    test::add_cylinder(shape, {20 + gap, 0, 0}, 10, 20, 36);
    test::finish(shape);
    Field f(shape, across(5));
    CHECK(f.at({10, 0, 10}) < std::max(6.6 * gap, 0.22));
    CHECK(f.at({-10, 0, 10}) > 4.5);
    CHECK(f.field.predicted_tetrahedra() < 350'000);
  }
}

// A ball of radius 10 above a box, nearest at `gap`: the size there.
static double size_below_ball(double gap, double max_size) {
  test::Shape shape = test::ball({0, 0, 10 + gap}, 10, 5);
  test::add_box(shape.plc, {-20, -20, -10}, {20, 20, 0});
  for (int f = 0; f < 6; ++f) {
    Vec3 place{0, 0, -5}, normal;
    normal[f / 2] = f % 2 ? 1 : -1;
    place = place + (f < 4 ? 20.0 : 5.0) * normal;
    shape.records.faces.push_back({SurfaceKind::plane, place, normal, 0, 0, -1});
  }
  return Field(shape, across(max_size)).at({0.3, 0.3, 0});
}

TEST_CASE("where a ball all but touches a plane, no small elements") {
  CHECK(size_below_ball(0.002, 4) == 4);
  CHECK(size_below_ball(0.002, 0.5) < 0.3);  // many elements lie in the gap
}
