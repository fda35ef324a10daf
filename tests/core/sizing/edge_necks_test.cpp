#include "sizing/edge_necks.h"

#include <doctest/doctest.h>

#include "field.h"

using namespace dm;

namespace {

constexpr double kLength = 20;

// A profile (x, z), counter-clockwise, and the triangles that fill it, extruded along y; all points are
// corners.
test::Shape extrusion(const std::vector<std::array<double, 2>>& profile, const std::vector<Triangle>& caps) {
  test::Shape shape;
  Plc& plc = shape.plc;
  const auto n = static_cast<Index>(profile.size());
  for (const double y : {0.0, kLength})
    for (const auto& [x, z] : profile) plc.points.push_back({x, y, z});
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    test::add_quad(plc, i, i + n, j + n, j, i);
  }
  for (const auto& [a, b, c] : caps) {
    plc.triangles.push_back({a, b, c});
    plc.triangles.push_back({a + n, c + n, b + n});
    plc.triangle_face.insert(plc.triangle_face.end(), {n, n + 1});
  }
  plc.face_solids.assign(n + 2, {1, 0});
  plc.solid_count = 1;
  test::finish(shape);
  for (Index i = 0; i < 2 * n; ++i) {
    plc.corners.push_back(i);
    plc.corner_vertex.push_back(i);
  }
  plc.vertex_count = 2 * n;
  return shape;
}

// A block, and a wedge that stands on it with its edge cut off: a neck of this width at (10, 10).
test::Shape hourglass(double width) {
  return extrusion(
      {{0, 0}, {20, 0}, {20, 10}, {10 + width / 2, 10}, {20, 20}, {0, 20}, {10 - width / 2, 10}, {0, 10}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 6}, {0, 6, 7}, {3, 4, 5}, {3, 5, 6}});
}

// A block with a groove of this width and 5 deep.
test::Shape grooved(double width) {
  return extrusion({{0, 0},
                    {20, 0},
                    {20, 10},
                    {10 + width / 2, 10},
                    {10 + width / 2, 5},
                    {10 - width / 2, 5},
                    {10 - width / 2, 10},
                    {0, 10}},
                   {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}});
}

std::vector<EdgeNeck> necks_of(const test::Shape& shape, double local_size) {
  Context context;
  check_plc(shape.plc, context);
  const std::vector<double> sizes(shape.plc.triangles.size(), local_size);
  return find_edge_necks(shape.plc, sizes, local_size / 50, context);
}

}  // namespace

TEST_CASE("both edges of a neck are found whole, with its width") {
  for (const double width : {3.0, 1.0, 0.1}) {
    double length = 0;
    for (const EdgeNeck& neck : necks_of(hourglass(width), 4)) {
      CHECK(neck.width == doctest::Approx(width).epsilon(1e-9));
      CHECK(std::abs(std::abs(neck.a.x - 10) - width / 2) < 1e-9);
      CHECK(norm(neck.b - neck.a) <= 2 * width + 1e-9);
      length += norm(neck.b - neck.a);
    }
    CHECK(length == doctest::Approx(2 * kLength));
  }
}

TEST_CASE("a neck wider than the size is none, nor is the bottom of a groove, nor a block") {
  CHECK(necks_of(hourglass(3), 2).empty());
  for (const double width : {3.0, 0.1}) CHECK(necks_of(grooved(width), 4).empty());
  CHECK(necks_of(test::box({0, 0, 0}, {1, 1, 1}), 10).empty());
}

TEST_CASE("the size at a neck is two and a half widths, and grows from there") {
  test::Field f(hourglass(0.5), test::across(5));
  for (double y = 1; y < kLength; y += 2) {
    CHECK(f.at({10, y, 10}) == doctest::Approx(1.25).epsilon(0.1));
    CHECK(f.at({10, y, 6}) == doctest::Approx(1.25 + 4 * 0.25).epsilon(0.1));
  }
}

TEST_CASE("elements grow smoothly while a neck gets narrower, and stay in the budget") {
  double before = 0;
  for (double width = 5; width > 1e-3; width *= 0.8) {
    test::Field f(hourglass(width), test::across(5));
    const double elements = f.field.predicted_tetrahedra();
    CHECK(elements < 130'000);
    if (before > 0) CHECK(elements < 1.5 * before);
    before = elements;
    CHECK(f.field.warnings().empty() == (2.5 * width >= 0.99 * f.field.smallest()));
  }
}
