#include "sizing/size_field.h"

#include <doctest/doctest.h>

#include "base/random.h"
#include "shapes.h"

using namespace dm;

namespace {

struct Field {
  test::Shape shape;
  Context context;
  Geometry geometry;
  SizeField field;
  Field(test::Shape s, const SizeOptions& options)
      : shape(std::move(s)),
        geometry(shape.plc, shape.records),
        field(shape.plc, geometry, options, context) {}
};

// Size only by what the test asks for.
SizeOptions plain(double max_size) {
  SizeOptions options;
  options.max_size = max_size;
  options.elements_per_circle = options.elements_across = 0;
  return options;
}

Vec3 random_in(Random& random, const Vec3& a, const Vec3& b) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {a.x + x * (b.x - a.x), a.y + y * (b.y - a.y), a.z + z * (b.z - a.z)};
}

constexpr double kElement = 0.106;  // volume of an element over h^3

}  // namespace

TEST_CASE("without sources the field is constant") {
  Field f(test::box({0, 0, 0}, {10, 20, 30}), plain(2));
  CHECK(f.field.smallest() == 2);
  CHECK(f.field.largest() == 2);
  CHECK(f.field.at({1, 2, 3}) == 2);
  CHECK(f.field.predicted_tetrahedra() == doctest::Approx(6000 / (8 * kElement)));
}

TEST_CASE("a face size grows linearly from the face") {
  SizeOptions options = plain(5);
  options.face_size = {0.5};
  Field f(test::box({0, 0, 0}, {10, 10, 10}), options);
  CHECK(f.field.smallest() == doctest::Approx(0.5).epsilon(0.1));
  CHECK(f.field.largest() == doctest::Approx(3).epsilon(0.1));
  Random random(1);
  double integral = 0;
  const int n = 20000;
  double worst = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3 p = random_in(random, {0, 0, 0}, {10, 10, 10});
    const double h = 0.5 + 0.25 * p.x;
    worst = std::max(worst, std::abs(f.field.at(p) / h - 1));
  }
  CHECK(worst < 0.1);
  // Integral of 1 / (0.5 + x / 4)^3 over the box.
  integral = 100 * 2 * (1 / 0.25 - 1 / 9.0);
  CHECK(f.field.predicted_tetrahedra() == doctest::Approx(integral / kElement).epsilon(0.1));
}

TEST_CASE("edge and vertex sizes") {
  SizeOptions options = plain(5);
  test::Shape shape = test::box({0, 0, 0}, {10, 10, 10});
  shape.plc.corners = {7};
  shape.plc.corner_vertex = {3};
  options.vertex_size = {HUGE_VAL, HUGE_VAL, HUGE_VAL, 0.1};
  options.edge_size.assign(12, HUGE_VAL);
  options.edge_size[0] = 0.2;
  Vec3 a = shape.plc.points[shape.plc.segments[0][0]], b = a;
  for (std::size_t s = 0; s < shape.plc.segments.size(); ++s)
    if (shape.plc.segment_edge[s] == 0)
      a = shape.plc.points[shape.plc.segments[s][0]], b = shape.plc.points[shape.plc.segments[s][1]];
  Field f(shape, options);
  CHECK(f.field.at({10, 10, 10}) == doctest::Approx(0.1).epsilon(0.1));
  for (double t = 0; t <= 1; t += 0.01) CHECK(f.field.at((1 - t) * a + t * b) < 0.22);
  Random random(2);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random_in(random, {0, 0, 0}, {10, 10, 10});
    const double t = std::clamp(dot(p - a, b - a) / norm2(b - a), 0.0, 1.0);
    const double h =
        std::min(0.1 + 0.25 * distance(p, {10, 10, 10}), 0.2 + 0.25 * distance(p, (1 - t) * a + t * b));
    worst = std::max(worst, std::abs(f.field.at(p) / h - 1));
  }
  CHECK(worst < 0.12);
}

TEST_CASE("curvature gives elements per circle") {
  SizeOptions options = plain(5);
  options.elements_per_circle = 12;
  test::Shape shape;
  test::add_cylinder(shape, {0, 0, 0}, 1, 20, 36);
  test::finish(shape);
  Field f(shape, options);
  const double h = 2 * std::numbers::pi / 12;
  CHECK(f.field.at({1, 0, 10}) == doctest::Approx(h).epsilon(0.1));
  CHECK(f.field.at({0, 0, 10}) == doctest::Approx(h + 0.25).epsilon(0.1));
}

TEST_CASE("the prediction in a graded ball") {
  SizeOptions options = plain(5);
  options.face_size = {0.5};
  Field f(test::ball({1, 2, 3}, 10, 4), options);
  // h = 0.5 + (10 - r) / 4 = 3 - r / 4: integral of 4 pi r^2 / h^3.
  double integral = 0;
  const int n = 10000;
  for (int i = 0; i < n; ++i) {
    const double r = 10 * (i + 0.5) / n, h = 3 - r / 4;
    integral += 4 * std::numbers::pi * r * r / (h * h * h) * 10 / n;
  }
  CHECK(f.field.predicted_tetrahedra() == doctest::Approx(integral / kElement).epsilon(0.1));
}
