#include "surfaces/remesh.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "shapes.h"
#include "surfaces/remesh_patch.h"

using namespace dm;
using shapes::Shape;

namespace {

struct Case {
  std::string name;
  Shape shape;
  double max_size;
  double area;            // exact
  double area_tolerance;  // relative
};

std::vector<Case> cases() {
  const double pi = std::numbers::pi;
  std::vector<Case> list;
  list.push_back({"box", shapes::box(30, 20, 10), 2.5, 2 * (600 + 200 + 300), 1e-9});
  list.push_back({"two boxes", shapes::two_boxes(), 1.5, 6 * 100 + 2 * 150 + 2 * 150 + 100, 1e-9});
  list.push_back({"cylinder", shapes::turned(10, 10, 30, 0, 24), 3, 2 * pi * 100 + 600 * pi, 0.02});
  list.push_back({"tube", shapes::turned(10, 10, 30, 4, 20), 3, 2 * pi * 84 + 840 * pi, 0.02});
  list.push_back(
      {"frustum", shapes::turned(10, 4, 20, 0, 24), 2, pi * 116 + 14 * pi * std::hypot(6, 20), 0.02});
  list.push_back({"cone", shapes::turned(8, 0, 20, 0, 24), 2, pi * 64 + 8 * pi * std::hypot(8, 20), 0.02});
  list.push_back({"sphere", shapes::sphere(10, 24), 2, 400 * pi, 0.02});
  list.push_back({"torus", shapes::torus(20, 6, 48, 20), 3, 480 * pi * pi, 0.02});
  return list;
}

struct Run {
  Geometry geometry;
  Context context;
  SizeField size;
  SurfaceMesh mesh;
  static SizeOptions size_options(double max_size) {
    SizeOptions options;
    options.max_size = max_size;
    options.elements_across = 0;
    return options;
  }
  static Context make_context(int threads) {
    Context c;
    c.threads = threads;
    return c;
  }
  Run(const Shape& shape, const SizeOptions& options, int threads = 1)
      : geometry(shape.plc, shape.records),
        context(make_context(threads)),
        size(shape.plc, geometry, options, context),
        mesh(mesh_surfaces(shape.plc, geometry, size, {}, context)) {
    check_plc(shape.plc, context);
    check_surface_mesh(mesh, shape.plc, geometry);
  }
};

double min_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  auto at = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    return std::acos(std::clamp(dot(normalized(q - p), normalized(r - p)), -1.0, 1.0)) * 180 /
           std::numbers::pi;
  };
  return std::min({at(a, b, c), at(b, c, a), at(c, a, b)});
}

struct Statistics {
  double area = 0, min_angle = 180, least_alignment = 1, median_ratio = 0;
};

Statistics measure(const Run& run) {
  Statistics s;
  std::vector<double> ratios;
  const auto& points = run.mesh.points;
  for (std::size_t t = 0; t < run.mesh.triangles.size(); ++t) {
    const auto [i, j, k] = run.mesh.triangles[t];
    const Vec3 n = area_vector(points[i], points[j], points[k]);
    const Vec3 centre = (1.0 / 3) * (points[i] + points[j] + points[k]);
    s.area += norm(n) / 2;
    s.min_angle = std::min(s.min_angle, min_angle(points[i], points[j], points[k]));
    s.least_alignment = std::min(s.least_alignment,
                                 dot(normalized(n), run.geometry.normal(run.mesh.triangle_face[t], centre)));
    for (const auto& [a, b] : {std::pair{i, j}, std::pair{j, k}, std::pair{k, i}})
      if (a < b)
        ratios.push_back(distance(points[a], points[b]) / (0.8 * run.size.at(0.5 * (points[a] + points[b]))));
  }
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                   ratios.end());
  s.median_ratio = ratios[ratios.size() / 2];
  return s;
}

}  // namespace

TEST_CASE("every shape: closed, on the surface, well shaped, of the wanted size") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    const Run run(c.shape, Run::size_options(c.max_size));
    const Statistics s = measure(run);
    CHECK(std::abs(s.area / c.area - 1) < c.area_tolerance);
    CHECK(s.min_angle > (c.name == "cone" ? 12 : 24));
    CHECK(s.least_alignment > (c.name == "cone" ? 0.3 : 0.9));
    CHECK(s.median_ratio > 0.85);
    CHECK(s.median_ratio < 1.15);
  }
}

TEST_CASE("the result does not depend on the number of threads") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    const Run one(c.shape, Run::size_options(c.max_size)), three(c.shape, Run::size_options(c.max_size), 3);
    CHECK(one.mesh.points == three.mesh.points);
    CHECK(one.mesh.triangles == three.mesh.triangles);
    CHECK(one.mesh.segments == three.mesh.segments);
  }
}

TEST_CASE("graded field: small edges at one corner, large ones far away") {
  SizeOptions options = Run::size_options(8);
  options.regions.push_back({0, {0, 0, 0}, {}, 1, 0.4, 0});
  const Run run(shapes::box(30, 20, 10), options);
  const Statistics s = measure(run);
  CHECK(s.min_angle > 20);
  CHECK(s.median_ratio > 0.85);
  CHECK(s.median_ratio < 1.15);
}

TEST_CASE("sizes far coarser than the shape neither fold nor lose faces") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    SizeOptions options = Run::size_options(1000);
    options.elements_per_circle = 0;
    const Run run(c.shape, options);
    CHECK(measure(run).least_alignment > 0);
  }
}

// A turned body whose first face is bounded by a rim that another row of its points follows, `height(i)`
// above.
template <class Height>
Shape rim_with_points_beside(Height height) {
  constexpr int n = 24;
  Shape s = shapes::turned(10, 10, 30, 0, n);
  std::vector<Index> rim(n), beside(n);
  for (int i = 0; i < n; ++i) {
    rim[i] = s.point(shapes::circle(10, 0, n)[i]);
    beside[i] = s.point(s.plc.points[rim[i]] + Vec3{0, 0, height(i)});
  }
  for (std::size_t t = 0; t < s.plc.triangles.size(); ++t)
    if (s.plc.triangle_face[t] == 0)
      for (Index& p : s.plc.triangles[t])
        if (const auto at = std::find(rim.begin(), rim.end(), p); at != rim.end())
          p = beside[at - rim.begin()];
  for (int i = 0; i < n; ++i)
    s.quad(0, s.plc.points[rim[i]], s.plc.points[rim[(i + 1) % n]], s.plc.points[beside[(i + 1) % n]],
           s.plc.points[beside[i]]);
  return s;
}

TEST_CASE("points of a face within the tolerance of its outline do not stay") {
  for (const double wanted : {0.3, 0.6, 1.2, 3.0}) {
    CAPTURE(wanted);
    const Shape s = rim_with_points_beside([](int i) { return (i % 3 - 1.5) * 1e-6; });
    const SurfaceMesh mesh = Run(s, Run::size_options(wanted)).mesh;
    int short_edges = 0;
    for (const auto& [a, b, c] : mesh.triangles)
      short_edges +=
          std::min({distance(mesh.points[a], mesh.points[b]), distance(mesh.points[b], mesh.points[c]),
                    distance(mesh.points[c], mesh.points[a])}) < 1e-4;
    CHECK(short_edges == 0);
  }
}

TEST_CASE("a face that is folded back at its outline is not divided for ever") {
  const Shape s = rim_with_points_beside([](int) { return -1e-6; });
  const std::size_t sound =
      Run(rim_with_points_beside([](int) { return 1e-6; }), Run::size_options(0.6)).mesh.points.size();
  CHECK(Run(s, Run::size_options(0.6)).mesh.points.size() < 2 * sound);
}

TEST_CASE("cancelling stops the stage") {
  const Shape shape = shapes::box(30, 20, 10);
  const Geometry geometry(shape.plc, shape.records);
  Context quiet;
  const SizeField size(shape.plc, geometry, Run::size_options(1), quiet);
  Context context([](const char* stage, double) { return std::string(stage) != "surfaces"; });
  CHECK_THROWS_AS(mesh_surfaces(shape.plc, geometry, size, {}, context), Cancelled);
}

namespace {

// A shaft with grooves of a triangular profile whose floor is a ring of the width `floor`.
Shape grooved_shaft(int grooves, double floor, int n) {
  Shape s;
  const Vec3 z{0, 0, 1};
  const double outer = 3.1, inner = 2.65, slope = (outer - inner) * std::tan(std::numbers::pi / 6);
  std::vector<std::array<double, 2>> profile{{outer, 0}};  // radius, height
  for (int k = 0; k < grooves; ++k) {
    const double low = 0.3 + 0.7 * k;
    profile.push_back({outer, low});
    profile.push_back({inner, low + slope});
    profile.push_back({inner, low + slope + floor});
    profile.push_back({outer, low + 2 * slope + floor});
  }
  profile.push_back({outer, 0.7 * grooves + 0.3});
  std::vector<std::vector<Vec3>> circles;
  for (const auto& [r, height] : profile) {
    circles.push_back(shapes::circle(r, height, n));
    s.corner(circles.back()[0]);
    s.edge({CurveKind::circle, {0, 0, height}, z, r, -1}, circles.back());
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto [r, low] = profile[i];
    const auto [q, high] = profile[i + 1];
    SurfaceRecord wall{SurfaceKind::cylinder, {}, z, r, 0, -1};
    if (r != q) {
      const double apex = low + r * (high - low) / (r - q);
      wall = {SurfaceKind::cone,
              {0, 0, apex},
              r > q ? -z : z,
              std::atan(std::abs((r - q) / (high - low))),
              0,
              -1};
    }
    const Index face = s.face(wall, 1);
    for (int k = 0; k < n; ++k)
      s.quad(face, circles[i][k], circles[i][k + 1], circles[i + 1][k + 1], circles[i + 1][k]);
  }
  const Index bottom = s.face(shapes::plane({}, -z), 1), top = s.face(shapes::plane(circles.back()[0], z), 1);
  for (int k = 1; k + 1 < n; ++k) {
    s.triangle(bottom, circles[0][0], circles[0][k + 1], circles[0][k]);
    s.triangle(top, circles.back()[0], circles.back()[k], circles.back()[k + 1]);
  }
  return s;
}

}  // namespace

TEST_CASE("narrow rings get smaller triangles, also where old curve points had to be kept before") {
  const Run run(grooved_shaft(3, 0.06, 24), Run::size_options(2));
  CHECK(measure(run).min_angle > 10);
}

namespace {

// A block whose top has a wedge of a face: from a point of one edge to `width` on the opposite one.
Shape block_with_wedge_on_top(double length, double depth, double height, double width) {
  Shape s;
  const auto at = [&](double x, double y, double z) { return Vec3{x, y, z}; };
  const double y = depth / 2;
  const Vec3 a = at(0, 0, 0), b = at(length, 0, 0), c = at(length, depth, 0), d = at(0, depth, 0);
  const Vec3 e = at(0, 0, height), f = at(length, 0, height), g = at(length, depth, height),
             h = at(0, depth, height), tip = at(0, y, height), p = at(length, y, height),
             q = at(length, y + width, height);
  const auto polygon = [&](const std::vector<Vec3>& corners) {
    const Vec3 normal = area_vector(corners[0], corners[1], corners[2]);
    const Index face = s.face(shapes::plane(corners[0], normal), 1);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      s.triangle(face, corners[0], corners[i], corners[i + 1]);
  };
  polygon({tip, p, q});  // face 0
  polygon({tip, e, f, p});
  polygon({tip, q, g, h});
  polygon({d, c, b, a});
  polygon({a, b, f, e});
  polygon({c, d, h, g});
  polygon({b, c, g, q, p, f});
  polygon({a, e, tip, h, d});
  for (const Vec3& corner : {a, b, c, d, e, f, g, h, tip, p, q}) s.corner(corner);
  for (const auto& [v, w] : {std::pair{a, b},
                             {b, c},
                             {c, d},
                             {d, a},
                             {a, e},
                             {b, f},
                             {c, g},
                             {d, h},
                             {e, f},
                             {f, p},
                             {p, q},
                             {q, g},
                             {g, h},
                             {h, tip},
                             {tip, e},
                             {tip, p},
                             {tip, q}})
    s.line(v, w);
  return s;
}

}  // namespace

TEST_CASE("where only a face is a wedge, its triangles get small, and all but those at the tip good") {
  const Run run(block_with_wedge_on_top(30, 20, 10, 1.5), Run::size_options(2));
  int thin = 0, near_the_tip = 0;
  for (std::size_t t = 0; t < run.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = run.mesh.triangles[t];
    const auto& points = run.mesh.points;
    if (min_angle(points[a], points[b], points[c]) > 15) continue;
    ++thin;
    near_the_tip += std::min({points[a].x, points[b].x, points[c].x}) < 3;
  }
  CHECK(thin == near_the_tip);
  CHECK(run.mesh.triangles.size() < 4000);
}

TEST_CASE("a surface that crosses itself over and over is refused, with a face's name") {
  Shape s;
  constexpr int n = 60;
  for (int k = 0; k < n; ++k) {
    Shape bar;
    shapes::box_walls(bar, {-10, -0.5, -0.5 - 0.01 * k}, {10, 0.5, 0.5 + 0.01 * k}, 1, false, 0);
    const double a = std::numbers::pi * k / n;
    const auto turned = [&](const Vec3& p) {
      return Vec3{std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y, p.z};
    };
    const Index first = static_cast<Index>(s.records.faces.size());
    for (const SurfaceRecord& r : bar.records.faces)
      s.face(shapes::plane(turned(r.origin), turned(r.axis)), 1);
    for (std::size_t t = 0; t < bar.plc.triangles.size(); ++t) {
      const auto [p, q, r] = bar.plc.triangles[t];
      s.triangle(first + bar.plc.triangle_face[t], turned(bar.plc.points[p]), turned(bar.plc.points[q]),
                 turned(bar.plc.points[r]));
    }
    for (const Index p : bar.plc.corners) s.corner(turned(bar.plc.points[p]));
    for (const auto& [p, q] : bar.plc.segments) s.line(turned(bar.plc.points[p]), turned(bar.plc.points[q]));
  }
  const Geometry geometry(s.plc, s.records);
  Context context;
  const SizeField size(s.plc, geometry, Run::size_options(4), context);
  try {
    mesh_surfaces(s.plc, geometry, size, {}, context);
    FAIL("it was meshed");
  } catch (const Failure& failure) {
    CHECK(failure.code == "self_intersection");
    CHECK(failure.entity.dimension == 2);
  }
}

TEST_CASE("an edge of a triangle without any width is not divided: its middle would lie on the outline") {
  const Shape box = shapes::box(30, 20, 10);
  const Geometry geometry(box.plc, box.records);
  Context context;
  const SizeField size(box.plc, geometry, Run::size_options(1), context);
  const LengthField lengths(size, 0.85);
  Index bottom = 0;
  while (geometry.project_to_face(bottom, {1, 1, 0}).z != 0 || geometry.normal(bottom, {1, 1, 0}).z == 0)
    ++bottom;
  for (const double width : {0.0, 1.0}) {
    FacePatch patch;
    for (const Vec3& p : {Vec3{2, 2, 0}, Vec3{3, 2 - width, 0}, Vec3{5, 2, 0}, Vec3{3, 4, 0}})
      patch.add_vertex(p, VertexKind::fixed, -1);
    patch.start({0, 1, 2, 0, 2, 3}, {-1, 5, -1, -1, -1, 1});
    REQUIRE_NOTHROW(patch.check());
    const Index across = patch.find_edge(0, 2);
    REQUIRE(patch.twin[across] >= 0);
    PatchRemesher remesher(patch, bottom, geometry, lengths, {}, 1, {});
    CHECK(remesher.split_at_middle(across) == (width > 0));
  }
}
