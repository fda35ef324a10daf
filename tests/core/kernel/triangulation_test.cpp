#include "kernel/triangulation.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <set>
#include <string>

#include "base/failure.h"
#include "base/random.h"
#include "kernel/predicates.h"

using namespace dm;

namespace {

using Points = std::vector<Vec3>;

Points uniform(int n, std::uint64_t seed = 1) {
  Random random(seed);
  Points points(n);
  for (Vec3& p : points) p = {random.uniform(), random.uniform(), random.uniform()};
  return points;
}
Points grid(int n, double step = 1) {
  Points points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) points.push_back({step * i, step * j, step * k});
  return points;
}
// The points that an OCC tessellation gives: angles at equal steps, coordinates rounded once.
Points sphere(int n) {
  Points points = {{0, 0, 10}, {0, 0, -10}};
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double v = std::numbers::pi * i / n, u = std::numbers::pi * j / n;
      points.push_back({10 * std::sin(v) * std::cos(u), 10 * std::sin(v) * std::sin(u), 10 * std::cos(v)});
    }
  return points;
}
Points cylinder(int around, int rows) {
  Points points;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < around; ++i) {
      const double u = 2 * std::numbers::pi * i / around;
      points.push_back({5 * std::cos(u), 5 * std::sin(u), 0.7 * j});
    }
  return points;
}
Points skew_lines(int n) {
  Points points;
  for (int i = 0; i < n; ++i) {
    points.push_back({0.1 * i, 0, 0});
    points.push_back({0, 0.1 * i, 1});
  }
  return points;
}
Points layers(int n) {
  Random random(5);
  Points points;
  for (int i = 0; i < n; ++i) points.push_back({random.uniform(), random.uniform(), 0.1 * (i % 4)});
  return points;
}
Points duplicates(int n) {
  Random random(6);
  Points points = uniform(n, 6);
  for (int i = 0; i < n; ++i) points.push_back(points[random.next() % n]);
  for (int i = 0; i < n; ++i) {
    Vec3 p = points[random.next() % n];
    p.x = std::nextafter(p.x, 2);
    points.push_back(p);
  }
  return points;
}
Points clusters(int n) {
  Random random(7);
  const Points centres = uniform(5, 7);
  Points points;
  for (int i = 0; i < n; ++i) points.push_back(centres[i % 5] + 1e-9 * random.in_ball());
  return points;
}

int scaled(int n) {  // smaller under slow tools
  const char* wanted = std::getenv("DM_TEST_CASES");
  return wanted && std::atoi(wanted) < 100000 ? std::max(8, n / 10) : n;
}

double volume_of(const Triangulation& t) {
  double sum = 0;
  for (Index i = 0; i < t.slot_count(); ++i) {
    if (t.is_free(i) || t.is_ghost(i)) continue;
    const Tet& c = t.corners(i);
    sum += dot(cross(t.point(c[1]) - t.point(c[0]), t.point(c[2]) - t.point(c[0])),
               t.point(c[3]) - t.point(c[0]));
  }
  return sum / 6;
}

std::set<Tet> tets_of(const Triangulation& t) {
  std::set<Tet> tets;
  for (Index i = 0; i < t.slot_count(); ++i) {
    if (t.is_free(i) || t.is_ghost(i)) continue;
    Tet c = t.corners(i);
    std::sort(c.begin(), c.end());
    tets.insert(c);
  }
  return tets;
}

std::string code_of(const Points& points) {
  try {
    const Triangulation t(points);
  } catch (const Failure& failure) {
    return failure.stage + "/" + failure.code;
  }
  return "";
}

}  // namespace

TEST_CASE("every kind of point set becomes a Delaunay triangulation") {
  const std::vector<std::pair<const char*, Points>> sets = {
      {"four points", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {"five points, first four coplanar", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 1}}},
      {"random", uniform(scaled(50000))},
      {"grid", grid(scaled(30))},
      {"grid of decimals", grid(scaled(12), 0.1)},
      {"sphere", sphere(scaled(40))},
      {"cylinder", cylinder(48, scaled(60))},
      {"prism of many sides", cylinder(scaled(1000), 2)},
      {"skew lines", skew_lines(scaled(300))},
      {"coplanar layers", layers(scaled(5000))},
      {"duplicates and near duplicates", duplicates(scaled(3000))},
      {"tight clusters", clusters(scaled(5000))},
  };
  for (const auto& [name, points] : sets) {
    CAPTURE(std::string(name));
    const Triangulation t(points);
    CHECK_NOTHROW(t.check());
    CHECK(t.vertex_count() == static_cast<Index>(points.size()));
  }
}

TEST_CASE("the volume is that of the convex hull") {
  CHECK(volume_of(Triangulation(grid(8))) == doctest::Approx(343));
  CHECK(volume_of(Triangulation(cylinder(400, 5))) ==
        doctest::Approx(0.5 * 400 * 25 * std::sin(2 * std::numbers::pi / 400) * 2.8));
}

TEST_CASE("duplicates: the later one has no tetrahedron, each place has exactly one vertex") {
  Points points = uniform(500);
  const Points copy = points;
  points.insert(points.end(), copy.begin(), copy.end());
  const Triangulation t(points);
  for (Index i = 0; i < 500; ++i) {
    CHECK(t.vertex_tet(i) >= 0);
    CHECK(t.vertex_tet(i + 500) == -1);
  }
}

TEST_CASE("degenerate input is refused") {
  const Points layer = layers(400);
  Points plane;
  for (const Vec3& p : layer)
    if (p.z == 0) plane.push_back({p.x, p.y, 0.1});
  CHECK(code_of({}) == "kernel/degenerate_points");
  CHECK(code_of({{1, 2, 3}}) == "kernel/degenerate_points");
  CHECK(code_of(Points(10, Vec3{1, 2, 3})) == "kernel/degenerate_points");
  CHECK(code_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}) == "kernel/degenerate_points");
  CHECK(code_of(plane) == "kernel/degenerate_points");
  CHECK(code_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, NAN}}) == "kernel/not_finite");
  CHECK(code_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, HUGE_VAL}}) == "kernel/not_finite");
}

TEST_CASE("the result does not depend on how the points came in") {
  for (const Points& points : {uniform(2000, 3), grid(9), cylinder(24, 20), layers(600), skew_lines(60)}) {
    const Triangulation all(points);
    Triangulation grown(std::span<const Vec3>(points).first(points.size() / 3));
    Cavity cavity;
    bool degenerate = false;
    for (std::size_t i = points.size() / 3; i < points.size(); ++i) {
      const Index start = grown.locate(points[i], 0);
      degenerate |= start < 0;
      if (start < 0) break;
      grown.find_cavity(points[i], start, false, cavity);
      CHECK(grown.insert(points[i], cavity) == static_cast<Index>(i));
    }
    if (degenerate) continue;
    grown.check();
    CHECK(tets_of(all) == tets_of(grown));
  }
}

TEST_CASE("proposals change nothing, commits keep every invariant") {
  Triangulation t(uniform(300, 8));
  const std::set<Tet> before = tets_of(t);
  Random random(9);
  Cavity cavity;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = 1.2 * random.in_ball();
    const Index start = t.locate(p, 0);
    REQUIRE(t.in_conflict(start, p));
    CHECK(t.find_cavity(p, start, false, cavity) == -1);
    CHECK(cavity.border.size() == cavity.outside.size());
    for (const Index tet : cavity.tets) CHECK(t.in_conflict(tet, p));
    for (std::size_t k = 0; k < cavity.border.size(); ++k) {
      CHECK(t.neighbour(cavity.border[k] / 4, cavity.border[k] % 4) == cavity.outside[k]);
      CHECK_FALSE(t.in_conflict(cavity.outside[k] / 4, p));
    }
  }
  CHECK(tets_of(t) == before);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = 1.2 * random.in_ball();
    t.find_cavity(p, t.locate(p, static_cast<Index>(random.next() % 5)), false, cavity);
    const Index v = t.insert(p, cavity);
    REQUIRE(cavity.created.size() == cavity.border.size());
    for (std::size_t k = 0; k < cavity.created.size(); ++k) {
      const Index tet = cavity.created[k];
      CHECK(t.corners(tet)[t.is_ghost(tet) ? 2 : 3] == v);
      CHECK(t.neighbour(tet, t.is_ghost(tet) ? 2 : 3) == cavity.outside[k]);
    }
    if (i % 100 == 0) t.check();
  }
  t.check();
}

TEST_CASE("an existing vertex is no site") {
  const Points points = grid(5);
  const Triangulation t(points);
  Cavity cavity;
  for (Index v = 0; v < t.vertex_count(); ++v) {
    CHECK(t.locate(points[v], 0) == -1);
    CHECK(t.find_cavity(points[v], t.vertex_tet(v), false, cavity) == -1);
    CHECK(cavity.tets.empty());
    CHECK(cavity.border.empty());
  }
}

TEST_CASE("tags and marks pass to the tetrahedra on the border") {
  Triangulation t(uniform(200, 4));
  Random random(10);
  for (Index tet = 0; tet < t.slot_count(); ++tet) {
    if (t.is_free(tet)) continue;
    t.set_tag(tet, static_cast<std::uint16_t>(random.next() % 1000));
    for (int i = 0; i < 4; ++i) t.set_marked(tet, i, random.next() % 3 == 0);
  }
  Cavity cavity;
  for (int n = 0; n < 100; ++n) {
    const Vec3 p = {random.uniform(), random.uniform(), 1.3 * random.uniform()};
    t.find_cavity(p, t.locate(p, 0), false, cavity);
    std::vector<std::pair<int, bool>> expected;
    for (const Face face : cavity.border) expected.push_back({t.tag(face / 4), t.marked(face / 4, face % 4)});
    t.insert(p, cavity);
    for (std::size_t k = 0; k < cavity.created.size(); ++k) {
      const Index tet = cavity.created[k];
      const int apex = t.is_ghost(tet) ? 2 : 3;
      CHECK(t.tag(tet) == expected[k].first);
      CHECK(t.marks(tet) == (expected[k].second ? 1u << apex : 0u));
    }
  }
}

TEST_CASE("a marked face inside the cavity stops the search") {
  Triangulation t(uniform(500, 5));
  Random random(13);
  Cavity cavity, stopped;
  int stops = 0, passes = 0;
  for (int n = 0; n < 300; ++n) {
    const Index tet = static_cast<Index>(random.next() % t.slot_count());
    const int i = static_cast<int>(random.next() % 4);
    const Face other = t.neighbour(tet, i);
    t.set_marked(tet, i, true);
    t.set_marked(other / 4, other % 4, true);
    const Vec3 p = {random.uniform(), random.uniform(), random.uniform()};
    const Index start = t.locate(p, 0);
    t.find_cavity(p, start, false, cavity);
    const auto has = [&](Index x) { return std::count(cavity.tets.begin(), cavity.tets.end(), x) > 0; };
    bool expected = false;
    for (const Index c : cavity.tets)
      for (int j = 0; j < 4; ++j) expected |= t.marked(c, j) && has(t.neighbour(c, j) / 4);
    const Face face = t.find_cavity(p, start, true, stopped);
    CHECK((face >= 0) == expected);
    if (face >= 0)
      CHECK((t.marked(face / 4, face % 4) && has(face / 4) && has(t.neighbour(face / 4, face % 4) / 4)));
    (expected ? stops : passes) += 1;
  }
  CHECK(stops > 10);
  CHECK(passes > 10);
  t.check();
}

TEST_CASE("rounded midpoints, coplanar with many others, can be inserted") {
  Triangulation t(grid(6, 0.1));
  Random random(14);
  Cavity cavity;
  for (int n = 0; n < 1000; ++n) {
    const auto v = static_cast<Index>(random.next() % t.vertex_count());
    const Tet& c = t.corners(t.vertex_tet(v));
    const Index w = c[random.next() % 3];
    const Vec3 p = 0.5 * (t.point(v) + t.point(w));
    const Index start = t.locate(p, t.vertex_tet(v));
    if (start < 0) continue;
    t.find_cavity(p, start, false, cavity);
    REQUIRE_FALSE(cavity.tets.empty());
    t.insert(p, cavity);
  }
  t.check();
}

TEST_CASE("a triangulation can be cancelled, on every number of threads") {
  const Points points = uniform(3000, 16);
  for (const int threads : {1, 2, 3})
    for (const Index from : {1, 100000}) {
      Context context([](const char*, double) { return false; });
      context.threads = threads;
      CHECK_THROWS_AS(Triangulation(points, context, from), Cancelled);
    }
}

TEST_CASE("the number of threads does not change a byte") {
  for (const Points& points : {uniform(scaled(100000), 15), grid(scaled(24)), cylinder(60, scaled(200))}) {
    const Index from = static_cast<Index>(points.size() / 100);
    Context context;
    const Triangulation one(points, context, from);
    one.check();
    CHECK(tets_of(one) == tets_of(Triangulation(points)));
    for (const int threads : {2, 3, 8}) {
      context.threads = threads;
      const Triangulation many(points, context, from);
      REQUIRE(one.slot_count() == many.slot_count());
      bool same = true;
      for (Index i = 0; i < one.slot_count(); ++i) {
        same &= one.corners(i) == many.corners(i);
        for (int j = 0; j < 4; ++j) same &= one.neighbour(i, j) == many.neighbour(i, j);
      }
      for (Index v = 0; v < one.vertex_count(); ++v) same &= one.vertex_tet(v) == many.vertex_tet(v);
      CHECK(same);
    }
  }
}
