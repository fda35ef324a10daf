#include "sizing/size_field.h"

#include <doctest/doctest.h>

#include "field.h"

using namespace dm;
using test::Field;
using test::kPerArea;
using test::kPerVolume;
using test::plain;
using test::random_in;

TEST_CASE("without sources the field is constant") {
  Field f(test::box({0, 0, 0}, {10, 20, 30}), plain(2));
  CHECK(f.field.smallest() == 2);
  CHECK(f.field.largest() == 2);
  CHECK(f.field.at({1, 2, 3}) == 2);
  CHECK(f.field.predicted_tetrahedra() == doctest::Approx(kPerVolume * 6000 / 8 + kPerArea * 2200 / 4));
}

TEST_CASE("a face size grows linearly from the face") {
  SizeOptions options = plain(5);
  options.face_size = {0.5};
  Field f(test::box({0, 0, 0}, {10, 10, 10}), options);
  CHECK(f.field.smallest() == doctest::Approx(0.5).epsilon(0.1));
  CHECK(f.field.largest() == doctest::Approx(3).epsilon(0.1));
  Random random(1);
  const int n = 20000;
  double worst = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3 p = random_in(random, {0, 0, 0}, {10, 10, 10});
    const double h = 0.5 + 0.25 * p.x;
    worst = std::max(worst, std::abs(f.field.at(p) / h - 1));
  }
  CHECK(worst < 0.1);
  // Integrals of 1 / (0.5 + x / 4)^3 over the box and of 1 / (0.5 + x / 4)^2 over its faces.
  const double volume = 100 * 2 * (1 / 0.25 - 1 / 9.0);
  const double area = 100 * (1 / 0.25 + 1 / 9.0) + 4 * 10 * 4 * (1 / 0.5 - 1 / 3.0);
  CHECK(f.field.predicted_tetrahedra() ==
        doctest::Approx(kPerVolume * volume + kPerArea * area).epsilon(0.1));
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
  CHECK(worst < 0.14);
}

TEST_CASE("curvature gives elements per circle") {
  SizeOptions options = plain(5);
  options.elements_per_circle = 12;
  test::Shape shape;
  test::add_cylinder(shape, {0, 0, 0}, 1, 20, 36);
  test::finish(shape);
  Field f(shape, options);
  const double h = 2 * std::numbers::pi / 12 / kBoundaryEdge;
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
  CHECK(f.field.predicted_tetrahedra() ==
        doctest::Approx(kPerVolume * integral + kPerArea * 1256.6 / 0.25).epsilon(0.1));
}

TEST_CASE("the field is Lipschitz up to the error of interpolation and never below the floor") {
  SizeOptions options = plain(4);
  options.min_size = 0.2;
  options.face_size = {HUGE_VAL, HUGE_VAL, 0.6};
  options.points = {{3, 4, 5}, {8, 8, 2}, {5, 5, 30}};
  options.point_size = {0.05, 0.4, 0.2};
  for (const double growth : {0.1, 0.25, 0.4}) {
    options.growth = growth;
    Field f(test::box({0, 0, 0}, {10, 10, 10}), options);
    Random random(7);
    double worst = 0, smallest = HUGE_VAL;
    for (int i = 0; i < 50000; ++i) {
      const Vec3 p = random_in(random, {0, 0, 0}, {10, 10, 10}),
                 q = random_in(random, {0, 0, 0}, {10, 10, 10});
      const double a = f.at(p), b = f.at(q), least = std::min(a, b);
      worst = std::max(worst, (std::abs(a - b) - growth * distance(p, q)) / least);
      smallest = std::min(smallest, least);
    }
    CHECK(worst < 0.2);
    CHECK(smallest > 0.2 * 0.999);
    CHECK(f.at({3, 4, 5}) == doctest::Approx(0.2).epsilon(0.1));
    CHECK(f.at({8, 8, 2}) == doctest::Approx(0.4).epsilon(0.1));
  }
}

TEST_CASE("regions: inside, transition, growth") {
  SizeOptions options = plain(4);
  options.regions = {{0, {5, 5, 5}, {}, 2, 0.5, 0},
                     {1, {15, 0, 0}, {17, 3, 3}, 0, 0.4, 14.4},
                     {2, {2, 15, 5}, {6, 15, 5}, 1, 0.3, 0}};
  Field f(test::box({0, 0, 0}, {20, 20, 20}), options);
  CHECK(f.at({5, 5, 5}) == doctest::Approx(0.5).epsilon(0.1));
  CHECK(f.at({6, 6, 6}) == doctest::Approx(0.5).epsilon(0.1));
  CHECK(f.at({5, 5, 10}) == doctest::Approx(0.5 + 0.25 * 3).epsilon(0.1));
  CHECK(f.at({16, 1, 1}) == doctest::Approx(0.4).epsilon(0.1));
  CHECK(f.at({16, 1, 7}) == doctest::Approx(0.4 + 0.25 * 4).epsilon(0.1));
  CHECK(f.at({16, 1, 13}) == doctest::Approx(0.4 + 0.25 * 10).epsilon(0.1));
  CHECK(f.at({4, 15.5, 5}) == doctest::Approx(0.3).epsilon(0.1));
  CHECK(f.at({4, 18, 5}) == doctest::Approx(0.3 + 0.25 * 2).epsilon(0.1));
  CHECK(f.at({8, 15, 5}) == doctest::Approx(0.3 + 0.25 * 2).epsilon(0.1));
}

TEST_CASE("a solid's size holds inside it and grows into its neighbour") {
  SizeOptions options = plain(4);
  options.solid_size = {0.5};
  test::Shape shape;
  test::add_box(shape.plc, {0, 0, 0}, {10, 10, 10});
  test::add_box(shape.plc, {10.5, 0, 0}, {20, 10, 10});
  Field f(shape, options);
  Random random(3);
  for (int i = 0; i < 1000; ++i)
    REQUIRE(f.at(random_in(random, {0.1, 0.1, 0.1}, {9.9, 9.9, 9.9})) == doctest::Approx(0.5).epsilon(0.1));
  CHECK(f.at({15, 5, 5}) == doctest::Approx(0.5 + 5 * 0.25).epsilon(0.1));
}

TEST_CASE("facets without CAD give curvature by their angles") {
  SizeOptions options = plain(5);
  options.elements_per_circle = 12;
  test::Shape shape;
  test::add_cylinder(shape, {0, 0, 0}, 1, 20, 36);
  test::add_segments(shape.plc);
  shape.records = {};
  Field f(shape, options);
  CHECK(f.at({1, 0, 10}) == doctest::Approx(2 * std::numbers::pi / 12 / kBoundaryEdge).epsilon(0.15));
}

TEST_CASE("same field, byte for byte, and for a scaled model the scaled field") {
  SizeOptions options = plain(4);
  options.elements_across = 2;
  options.face_size = {0.5};
  options.points = {{3, 4, 1}};
  options.point_size = {0.2};
  const Vec3 size{10, 10, 1.3};
  Field first(test::box({0, 0, 0}, size), options), second(test::box({0, 0, 0}, size), options);
  CHECK(first.field.predicted_tetrahedra() == second.field.predicted_tetrahedra());
  for (const double scale : {1e-3, 1e3}) {
    SizeOptions scaled = options;
    scaled.max_size *= scale;
    scaled.face_size = {0.5 * scale};
    scaled.points = {scale * options.points[0]};
    scaled.point_size = {0.2 * scale};
    Field other(test::box({0, 0, 0}, scale * size), scaled);
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = random_in(random, {0, 0, 0}, size);
      REQUIRE(first.at(p) == second.at(p));
      REQUIRE(other.at(scale * p) == doctest::Approx(scale * first.at(p)).epsilon(0.02));
    }
    CHECK(other.field.predicted_tetrahedra() ==
          doctest::Approx(first.field.predicted_tetrahedra()).epsilon(0.02));
  }
}

TEST_CASE("impossible options are refused") {
  const auto refused = [](const SizeOptions& options) {
    try {
      Field f(test::box({0, 0, 0}, {1, 1, 1}), options);
    } catch (const Failure& failure) {
      return failure.stage == "sizing";
    }
    return false;
  };
  SizeOptions options = plain(0);
  CHECK(refused(options));
  options = plain(1);
  options.min_size = 2;
  CHECK(refused(options));
  options = plain(1);
  options.face_size = {1, -1};
  CHECK(refused(options));
  options = plain(1);
  options.growth = 0;
  CHECK(refused(options));
  options = plain(std::nan(""));
  CHECK(refused(options));
}

TEST_CASE("a source spreads past others that reached the same places before it") {
  test::Shape shape;
  test::add_box(shape.plc, {0, 0, 0}, {30, 30, 30});
  shape.records.faces.assign(6, SurfaceRecord{});
  test::add_cylinder(shape, {10, 10, 3}, 5, 24, 36);
  test::add_cylinder(shape, {22, 22, 3}, 4, 24, 36);
  test::finish(shape);
  SizeOptions options = plain(6.5);
  options.elements_per_circle = 12;
  options.growth = 0.2;
  for (Index edge = 0; edge < 12; ++edge) {
    options.edge_size.assign(shape.plc.edge_count, HUGE_VAL);
    options.edge_size[edge] = 0.325;
    Vec3 a, b;
    for (std::size_t s = 0; s < shape.plc.segments.size(); ++s)
      if (shape.plc.segment_edge[s] == edge)
        a = shape.plc.points[shape.plc.segments[s][0]], b = shape.plc.points[shape.plc.segments[s][1]];
    Field f(shape, options);
    Random random(6);
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 p = random_in(random, {0, 0, 0}, {30, 30, 30});
      const double t = std::clamp(dot(p - a, b - a) / norm2(b - a), 0.0, 1.0);
      worst = std::max(worst, f.field.at(p) / (0.325 + 0.2 * distance(p, (1 - t) * a + t * b)));
    }
    CHECK(worst < 1.15);
  }
}

TEST_CASE("a face is continued behind itself only, not behind other faces that look past it") {
  // An L: the source is the top of its foot, and the outside of its leg lies above that plane.
  constexpr double kSection[8][2] = {{0, 0},   {10, 0},  {60, 0}, {60, 10},
                                     {10, 10}, {10, 50}, {0, 50}, {0, 10}};
  test::Shape shape;
  Plc& plc = shape.plc;
  for (const double y : {0.0, 40.0})
    for (const auto& [x, z] : kSection) plc.points.push_back({x, y, z});
  const auto cap = [&](Index a, Index b, Index c, Index d) {
    test::add_quad(plc, a, b, c, d, 0);
    test::add_quad(plc, 8 + d, 8 + c, 8 + b, 8 + a, 1);
  };
  cap(0, 1, 4, 7), cap(1, 2, 3, 4), cap(7, 4, 5, 6);
  constexpr Index kFaceOf[8] = {2, 2, 3, 4, 5, 6, 7, 7};
  for (Index k = 0; k < 8; ++k) {
    const Index l = (k + 1) % 8;
    test::add_quad(plc, l, k, 8 + k, 8 + l, kFaceOf[k]);
  }
  plc.solid_count = 1;
  plc.face_solids.assign(8, {1, 0});
  test::add_segments(plc);
  SizeOptions options = plain(20);
  options.growth = 0.3;
  options.face_size.assign(8, HUGE_VAL);
  options.face_size[4] = 1;
  Field f(shape, options);
  Random random(7);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_in(random, {0, 0, 15}, {10, 40, 50});
    const double h = 1 + 0.3 * distance(p, {10, p.y, 10});
    CHECK(f.field.at(p) > 0.85 * h);
    CHECK(f.field.at(p) < 1.15 * h);
  }
}
