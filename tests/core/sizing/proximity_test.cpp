#include "sizing/proximity.h"

#include <doctest/doctest.h>

#include "field.h"

using namespace dm;
using test::across;
using test::Field;

TEST_CASE("a free wall gets 2.5 times its thickness") {
  Field f(test::box({0, 0, 0}, {50, 50, 1}), across(10));
  for (double x = 3; x < 50; x += 4) CHECK(f.at({x, 25, 0.5}) == doctest::Approx(2.5).epsilon(0.1));
  CHECK(f.field.warnings().empty());
  Field finer(test::box({0, 0, 0}, {50, 50, 1}), across(10, 4));
  CHECK(finer.at({25, 25, 0}) == doctest::Approx(1.25).epsilon(0.1));
  Field off(test::box({0, 0, 0}, {50, 50, 1}), across(10, 0));
  CHECK(off.at({25, 25, 0}) == 10);
}

TEST_CASE("a wall with a tight gap beside it gets 1.85 times its thickness") {
  test::Shape shape;
  test::add_box(shape.plc, {0, 0, 0}, {20, 20, 1});
  test::add_box(shape.plc, {0, 0, 2}, {20, 20, 3});
  Field f(shape, across(10));
  CHECK(f.at({10, 10, 1}) == doctest::Approx(1.85).epsilon(0.1));
}

TEST_CASE("a narrow gap between thick solids") {
  test::Shape shape;
  test::add_box(shape.plc, {0, 0, 0}, {20, 20, 20});
  test::add_box(shape.plc, {21, 0, 0}, {40, 20, 20});
  Field f(shape, across(10));
  CHECK(f.at({20, 10, 10}) == doctest::Approx(6).epsilon(0.1));
  CHECK(f.at({10, 10, 10}) == doctest::Approx(6 + 2.5).epsilon(0.1));
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
    if (f.field.smallest() < 2.3 * t) CHECK_FALSE(limited);
    if (f.field.smallest() > 2.6 * t) CHECK(limited);
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
