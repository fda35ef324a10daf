#include "surfaces/absorb.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>

#include "shapes.h"
#include "surfaces/crossings.h"
#include "surfaces/remesh.h"

using namespace dm;
using shapes::Shape;

namespace {

// A profile in the (x, z) plane, counterclockwise seen from -y and star-shaped about its first point, as a
// prism of the depth d along y.  Faces: one per side of the profile, then front and back.
Shape prism(const std::vector<std::array<double, 2>>& profile, double d) {
  Shape s;
  const std::size_t n = profile.size();
  const auto at = [&](std::size_t i, double y) { return Vec3{profile[i % n][0], y, profile[i % n][1]}; };
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = at(i, 0), b = at(i + 1, 0);
    s.quad(s.face(shapes::plane(a, cross({0, 1, 0}, b - a)), 1), a, at(i, d), at(i + 1, d), b);
  }
  const Index front = s.face(shapes::plane(at(0, 0), {0, -1, 0}), 1),
              back = s.face(shapes::plane(at(0, d), {0, 1, 0}), 1);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    s.triangle(front, at(0, 0), at(i, 0), at(i + 1, 0));
    s.triangle(back, at(0, d), at(i + 1, d), at(i, d));
  }
  for (const double y : {0.0, d})
    for (std::size_t i = 0; i < n; ++i) {
      s.corner(at(i, y));
      s.line(at(i, y), at(i + 1, y));
    }
  for (std::size_t i = 0; i < n; ++i) s.line(at(i, 0), at(i, d));
  return s;
}

// A block of 20 x 20 x 10 with a step of the height `step` across its top.
Shape stepped_block(double step) {
  return prism({{10, 10 - step}, {10, 10}, {0, 10}, {0, 0}, {20, 0}, {20, 10 - step}}, 20);
}

// A cylinder with its upper rim chamfered, the points of the two circles staggered; or with several points
// on the upper one for each segment of the lower one, all in triangles with its first point.
Shape chamfered_cylinder(double radius, double height, double chamfer, int n, int per_segment = 1) {
  Shape s;
  const Vec3 z{0, 0, 1};
  const double r = radius - chamfer, h = height - chamfer;
  const auto low = shapes::circle(radius, 0, n), middle = shapes::circle(radius, h, n);
  auto high = shapes::circle(r, height, n * per_segment);
  for (Vec3& p : high) {
    const double a = std::atan2(p.y, p.x) + (per_segment == 1 ? std::numbers::pi / n : 0);
    p = {r * std::cos(a), r * std::sin(a), height};
  }
  high.back() = high.front();
  const Index wall = s.face({SurfaceKind::cylinder, {}, z, radius, 0, -1}, 1),
              cone = s.face({SurfaceKind::cone, {0, 0, h + radius}, -z, std::numbers::pi / 4, 0, -1}, 1),
              floor = s.face(shapes::plane({}, -z), 1), roof = s.face(shapes::plane({0, 0, height}, z), 1);
  for (int i = 0; i < n; ++i) {
    s.quad(wall, low[i], low[i + 1], middle[i + 1], middle[i]);
    s.triangle(floor, low[0], low[i + 1], low[i]);
    const int first = i * per_segment, last = first + per_segment;
    for (int k = first; k < last; ++k) {
      s.triangle(cone, middle[i], high[k + 1], high[k]);
      s.triangle(roof, high[0], high[k], high[k + 1]);
    }
    s.triangle(cone, middle[i], middle[i + 1], high[last]);
  }
  s.edge({CurveKind::circle, {}, z, radius, -1}, low);
  s.edge({CurveKind::circle, {0, 0, h}, z, radius, -1}, middle);
  s.edge({CurveKind::circle, {0, 0, height}, z, r, -1}, high);
  return s;
}

// A box of 10 x 10 x 10 whose front is divided by two lines that come as near as `gap` at the top.
Shape tiny_edge(double gap) {
  Shape s;
  const Vec3 o{0, 0, 0}, x{10, 0, 0}, xz{10, 0, 10}, z{0, 0, 10};
  const Vec3 low_left{2, 0, 0}, low_right{8, 0, 0}, left{5, 0, 10}, right{5 + gap, 0, 10};
  const Vec3 y{0, 10, 0}, xy{10, 10, 0}, all{10, 10, 10}, yz{0, 10, 10};
  const Vec3 forward{0, -1, 0};
  const auto face = [&](const Vec3& normal, const std::vector<Vec3>& loop) {
    const Index f = s.face(shapes::plane(loop[0], normal), 1);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) s.triangle(f, loop[0], loop[i], loop[i + 1]);
  };
  face(forward, {o, low_left, left, z});
  face(forward, {low_left, low_right, right, left});
  face(forward, {low_right, x, xz, right});
  face({0, 0, 1}, {yz, z, left, right, xz, all});
  face({0, 0, -1}, {y, xy, x, low_right, low_left, o});
  face({-1, 0, 0}, {o, z, yz, y});
  face({1, 0, 0}, {x, xy, all, xz});
  face({0, 1, 0}, {y, yz, all, xy});
  for (const Vec3& p : {o, low_left, low_right, x, xz, right, left, z, y, xy, all, yz}) s.corner(p);
  const std::vector<Vec3> rim{o, low_left, low_right, x, xz, right, left, z, o};
  for (std::size_t i = 0; i + 1 < rim.size(); ++i) s.line(rim[i], rim[i + 1]);
  s.line(low_left, left);
  s.line(low_right, right);
  for (const auto& [a, b] :
       {std::pair{o, y}, {x, xy}, {xz, all}, {z, yz}, {y, xy}, {xy, all}, {all, yz}, {yz, y}})
    s.line(a, b);
  return s;
}

// A box of 10 x 10 x 10 whose front is divided by an arc of n segments from one end of its lower edge, o, to
// `end`: its other end, or a point of the right side.
Shape arc_on_front(const Vec3& centre, const Vec3& end, int n) {
  Shape s;
  const Vec3 o{0, 0, 0}, x{10, 0, 0}, xz{10, 0, 10}, z{0, 0, 10};
  const Vec3 y{0, 10, 0}, xy{10, 10, 0}, all{10, 10, 10}, yz{0, 10, 10};
  const double radius = norm(centre), side = centre.z > 0 ? -1 : 1;
  std::vector<Vec3> arc{o};
  for (int i = 1; i < n; ++i) {
    const double along = end.x * i / n - centre.x;
    arc.push_back({end.x * i / n, 0, centre.z + side * std::sqrt(radius * radius - along * along)});
  }
  arc.push_back(end);
  const auto face = [&](const Vec3& normal, const std::vector<Vec3>& loop) {
    const Index f = s.face(shapes::plane(loop[0], normal), 1);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) s.triangle(f, loop[0], loop[i], loop[i + 1]);
  };
  const bool lens = norm(end - x) == 0;
  std::vector<Vec3> below{lens ? o : x}, above{z}, right{all, xz, end};
  if (!lens) {
    right.push_back(x);
    s.corner(end);
    s.line(x, end);
  }
  below.insert(below.end(), arc.rbegin(), arc.rend() - lens);
  above.insert(above.end(), arc.begin(), arc.end());
  above.push_back(xz);
  right.push_back(xy);
  face({0, -1, 0}, below);
  face({0, -1, 0}, above);
  face({1, 0, 0}, right);
  face({-1, 0, 0}, {o, z, yz, y});
  face({0, 0, -1}, {y, xy, x, o});
  face({0, 0, 1}, {yz, z, xz, all});
  face({0, 1, 0}, {y, yz, all, xy});
  for (const Vec3& p : {o, x, xz, z, y, xy, all, yz}) s.corner(p);
  s.line(end, xz);
  s.edge({CurveKind::circle, centre, {0, 1, 0}, radius, -1}, arc);
  for (const auto& [a, b] : {std::pair{o, x},
                             {xz, z},
                             {z, o},
                             {o, y},
                             {x, xy},
                             {xz, all},
                             {z, yz},
                             {y, xy},
                             {xy, all},
                             {all, yz},
                             {yz, y}})
    s.line(a, b);
  return s;
}

// An arc that leaves the lower edge tangentially.
Shape tangent_arc(double radius) {
  return arc_on_front({0, 0, radius}, {10, 0, radius - std::sqrt(radius * radius - 100)}, 6);
}

// With a point inside a face, in the plane y = 0 or z = 10, in place of the triangle round it.
void put_inside(Shape& s, const Vec3& p) {
  std::vector<Triangle>& triangles = s.plc.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    const auto part = [&](Index i, Index j) {
      return dot(area_vector(s.plc.points[i], s.plc.points[j], p),
                 area_vector(s.plc.points[a], s.plc.points[b], s.plc.points[c]));
    };
    const bool in_plane = std::abs(dot(area_vector(s.plc.points[a], s.plc.points[b], s.plc.points[c]),
                                       p - s.plc.points[a])) < 1e-12;
    if (!in_plane || part(a, b) <= 0 || part(b, c) <= 0 || part(c, a) <= 0) continue;
    const Index v = static_cast<Index>(s.plc.points.size());
    s.plc.points.push_back(p);
    triangles[t] = {a, b, v};
    for (const Triangle& more : {Triangle{b, c, v}, Triangle{c, a, v}}) {
      triangles.push_back(more);
      s.plc.triangle_face.push_back(s.plc.triangle_face[t]);
    }
    return;
  }
  FAIL("no triangle there");
}

struct Result {
  Absorbed absorbed;
  Plc plc;
  SurfaceMesh mesh;
  double smallest_angle = 180, area = 0;

  explicit Result(const Shape& shape, double max_size, double min_size = 0,
                  std::vector<double> face_size = {}) {
    Context context;
    check_plc(shape.plc, context);
    const Geometry geometry(shape.plc, shape.records);
    SizeOptions sizes;
    sizes.max_size = max_size;
    sizes.min_size = min_size;
    sizes.face_size = std::move(face_size);
    plc = absorb_small_features(shape.plc, geometry, sizes, context, absorbed);
    check_plc(plc, context);
    const SizeField field(plc, geometry, sizes, context);
    mesh = mesh_surfaces(plc, geometry, field, {}, context);
    check_surface_mesh(mesh, plc, geometry);
    for (const auto& [a, b, c] : mesh.triangles) {
      area += 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
      for (const auto& [i, j, k] : {Triangle{a, b, c}, Triangle{b, c, a}, Triangle{c, a, b}}) {
        const Vec3 u = mesh.points[j] - mesh.points[i], v = mesh.points[k] - mesh.points[i];
        const double angle = std::atan2(norm(cross(u, v)), dot(u, v));
        smallest_angle = std::min(smallest_angle, angle * 180 / std::numbers::pi);
      }
    }
  }
};

}  // namespace

TEST_CASE("a step far lower than the elements becomes a line") {
  const Result r(stepped_block(0.01), 4);
  CHECK(r.absorbed.faces == std::vector<Index>{0});
  CHECK(r.absorbed.edges.size() == 3);
  CHECK(r.absorbed.vertices.size() == 2);
  CHECK(r.smallest_angle > 25);
  CHECK(r.mesh.triangles.size() < 400);
}

TEST_CASE("a step that elements can show stays, and so does one with a size of its own or a minimum size") {
  CHECK_FALSE(Result(stepped_block(0.5), 4).absorbed.any());
  CHECK_FALSE(Result(stepped_block(0.05), 4, 0, {0.2}).absorbed.any());
  CHECK_FALSE(Result(stepped_block(0.05), 4, 0.02).absorbed.any());
  CHECK(Result(stepped_block(0.05), 4).absorbed.any());
}

TEST_CASE("a face or an edge that a load refers to stays") {
  Shape step = stepped_block(0.05);
  const std::vector<Index> gone = Result(step, 4).absorbed.edges;
  REQUIRE(!gone.empty());
  step.plc.kept_faces = {0};
  CHECK_FALSE(Result(step, 4).absorbed.any());
  step.plc.kept_faces.clear();
  step.plc.kept_edges = {gone[0]};
  const std::vector<Index> now = Result(step, 4).absorbed.edges;
  CHECK(std::find(now.begin(), now.end(), gone[0]) == now.end());
}

TEST_CASE("a step exactly as small as rounding is absorbed") {
  const Result r(stepped_block(1e-7), 4);
  CHECK(r.absorbed.faces == std::vector<Index>{0});
  CHECK(r.smallest_angle > 25);
}

TEST_CASE("the rim of a thin plate stays") {
  CHECK_FALSE(Result(shapes::box(20, 20, 0.05), 10).absorbed.any());
}

TEST_CASE("a narrow ring whose points do not face each other") {
  const Result r(chamfered_cylinder(10, 20, 0.02, 24), 3);
  CHECK(r.absorbed.faces == std::vector<Index>{1});
  CHECK(r.absorbed.edges == std::vector<Index>{2});
  CHECK(r.smallest_angle > 25);
}

TEST_CASE(
    "a ring far narrower than its segments bulge, with points that face others than their triangles say") {
  for (const double chamfer : {0.02, 1e-3, 1e-5})
    for (const int per_segment : {2, 3, 4}) {
      const Result r(chamfered_cylinder(10, 20, chamfer, 24, per_segment), 3);
      CHECK(r.absorbed.faces == std::vector<Index>{1});
      CHECK(r.absorbed.edges == std::vector<Index>{2});
      CHECK(r.smallest_angle > 20);
      Context context;
      CHECK(find_crossings(r.mesh.points, r.mesh.triangles, context).empty());
    }
}

TEST_CASE("a step across a thin plate is absorbed though the rim of the plate stays") {
  const Result r(prism({{10, 0.05 - 1e-4}, {10, 0.05}, {0, 0.05}, {0, 0}, {20, 0}, {20, 0.05 - 1e-4}}, 20),
                 10);
  CHECK(r.absorbed.faces == std::vector<Index>{0});
  CHECK(r.absorbed.vertices.size() == 2);
}

TEST_CASE("a narrow ring with points closer together than the tolerance") {
  const Result r(chamfered_cylinder(10, 20, 0.05, 240), 20);
  CHECK(r.absorbed.faces == std::vector<Index>{1});
  CHECK(r.absorbed.edges == std::vector<Index>{2});
  CHECK(r.smallest_angle > 20);
}

TEST_CASE("a ring as wide as a fifth of its radius stays") {
  CHECK(Result(chamfered_cylinder(10, 60, 0.5, 24), 120).absorbed.faces == std::vector<Index>{1});
  CHECK_FALSE(Result(chamfered_cylinder(10, 60, 1.6, 24), 120).absorbed.any());
}

TEST_CASE("a tiny edge becomes a point") {
  for (const double gap : {1e-6, 1e-3, 0.02}) {
    const Result r(tiny_edge(gap), 2);
    CHECK(r.absorbed.faces.empty());
    CHECK(r.absorbed.edges.size() == 1);
    CHECK(r.absorbed.vertices.size() == 1);
    CHECK(r.smallest_angle > 20);
    CHECK(r.mesh.triangles.size() < 700);
  }
}

TEST_CASE("a tiny edge becomes a point though the tessellation has another one beside it") {
  for (const double gap : {1e-5, 1e-4, 1e-3}) {
    Shape shape = tiny_edge(gap);
    put_inside(shape, {5 + 0.5 * gap, 0.3 * gap, 10});
    const Result r(shape, 2);
    CHECK(r.absorbed.edges.size() == 1);
    CHECK(r.smallest_angle > 20);
  }
}

// The tip of tangent_arc() is cut off.
void check_tip(const Shape& shape) {
  Shape kept = shape;
  kept.plc.kept_edges = {2};
  REQUIRE(kept.records.edges[2].kind == CurveKind::circle);
  const Result cut(shape, 2), whole(kept, 2);
  CHECK_FALSE(cut.absorbed.any());
  CHECK(cut.smallest_angle > 2 * whole.smallest_angle);
  CHECK(cut.mesh.triangles.size() < 1.4 * whole.mesh.triangles.size());
  CHECK(cut.area == doctest::Approx(600).epsilon(1e-4));
}

TEST_CASE("a tip of a face that runs out tangentially is cut off") {
  for (const double radius : {30.0, 50.0, 80.0}) check_tip(tangent_arc(radius));
}

TEST_CASE("a tip is cut off also where the tessellation has points in it") {
  for (const double radius : {30.0, 50.0, 80.0})
    for (const double share : {0.5, 0.8})
      for (const double step : {0.3, 0.6, 0.9}) {
        Shape shape = tangent_arc(radius);
        for (double x = step; x < 4; x += step) put_inside(shape, {x, 0, share * x * x / (2 * radius)});
        check_tip(shape);
      }
}

TEST_CASE("a tip is cut off also where the other curve has a point near by") {
  for (double radius = 46; radius < 53; radius += 0.125) {
    CAPTURE(radius);
    Shape shape = tangent_arc(radius);
    put_inside(shape, {6, 1, 0});
    check_tip(shape);
  }
}

TEST_CASE("a tip is cut off also where triangles between points of the curves have such points, too") {
  for (const unsigned seed : {5u, 12u, 27u}) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    const double radius = 30 + 50 * share(random);
    Shape shape = tangent_arc(radius);
    const int count = 3 + static_cast<int>(8 * share(random));
    for (int k = 0; k < count; ++k) {
      const double x = 0.3 + 5 * share(random), height = 0.3 + 0.5 * share(random);
      put_inside(shape, {x, 0, height * x * x / (2 * radius)});
    }
    check_tip(shape);
  }
}

TEST_CASE("both tips of a lens are cut off, on one segment") {
  const double rise = 0.06, radius = (25 + rise * rise) / (2 * rise);
  const Result r(arc_on_front({5, 0, rise - radius}, {10, 0, 0}, 8), 2);
  CHECK_FALSE(r.absorbed.any());
  CHECK(r.area == doctest::Approx(600).epsilon(1e-4));
}

TEST_CASE("a lens narrower than the tolerance is absorbed whole, also with points close to its tips") {
  const double rise = 0.003, radius = (25 + rise * rise) / (2 * rise);
  for (const int n : {8, 300}) {
    const Result r(arc_on_front({5, 0, rise - radius}, {10, 0, 0}, n), 2);
    CHECK(r.absorbed.faces == std::vector<Index>{0});
    CHECK(r.smallest_angle > 20);
    CHECK(r.area == doctest::Approx(600).epsilon(1e-4));
  }
}
