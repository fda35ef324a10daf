#include "surfaces/crossings.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "base/random.h"

using namespace dm;

namespace {

// By solving for the edge's point in the triangle's plane; for points in general position.
bool edge_hits(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = area_vector(a, b, c);
  const double s = dot(n, p - a), t = dot(n, q - a);
  if (s * t >= 0) return false;
  const Vec3 x = p + (s / (s - t)) * (q - p);
  return dot(n, area_vector(a, b, x)) > 0 && dot(n, area_vector(b, c, x)) > 0 &&
         dot(n, area_vector(c, a, x)) > 0;
}

std::vector<std::array<Index, 2>> crossings(const std::vector<Vec3>& points,
                                            const std::vector<Triangle>& triangles,
                                            std::size_t most = SIZE_MAX) {
  Context context;
  return find_crossings(points, triangles, context, most);
}

}  // namespace

TEST_CASE("crossing triangles: the same pairs as by testing all") {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (Index t = 0; t < 220; ++t) {
    Random random(1, 2, t);
    const Vec3 centre = 5.0 * random.in_ball();
    for (int i = 0; i < 3; ++i) points.push_back(centre + random.in_ball());
    triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const auto corner = [&](Index t, int i) { return points[triangles[t][i % 3]]; };
  std::vector<std::array<Index, 2>> expected;
  for (Index s = 0; s < 220; ++s)
    for (Index t = s + 1; t < 220; ++t) {
      bool cross_each_other = false;
      for (int i = 0; i < 3; ++i)
        cross_each_other |=
            edge_hits(corner(s, i), corner(s, i + 1), corner(t, 0), corner(t, 1), corner(t, 2)) ||
            edge_hits(corner(t, i), corner(t, i + 1), corner(s, 0), corner(s, 1), corner(s, 2));
      if (cross_each_other) expected.push_back({s, t});
    }
  CHECK(expected.size() > 5);
  CHECK(crossings(points, triangles) == expected);
}

TEST_CASE("triangles that overlap in a common plane cross") {
  // Random triangles of a plane against a shared interior point found by sampling: where one triangle holds a
  // point of the other's inside, they overlap.
  const Vec3 u = normalized(Vec3{1, 2, 0}), v{0, 0, 1};
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (Index t = 0; t < 60; ++t) {
    Random random(3, 4, t);
    const Vec3 centre = 4.0 * random.in_ball();
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = centre + random.in_ball();
      points.push_back(p.x * u + p.y * v);
    }
    triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const auto inside = [&](const Vec3& x, Index t) {
    const Vec3 &a = points[3 * t], &b = points[3 * t + 1], &c = points[3 * t + 2], n = area_vector(a, b, c);
    return dot(n, area_vector(a, b, x)) > 0 && dot(n, area_vector(b, c, x)) > 0 &&
           dot(n, area_vector(c, a, x)) > 0;
  };
  const auto found = crossings(points, triangles);
  Index sampled = 0;
  for (Index s = 0; s < 60; ++s)
    for (Index t = s + 1; t < 60; ++t) {
      bool overlap = false;
      Random random(5, s, t);
      for (int k = 0; k < 3000 && !overlap; ++k) {
        double a = random.uniform(), b = random.uniform();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        overlap = inside(
            points[3 * s] + a * (points[3 * s + 1] - points[3 * s]) + b * (points[3 * s + 2] - points[3 * s]),
            t);
      }
      sampled += overlap;
      const bool listed = std::binary_search(found.begin(), found.end(), std::array<Index, 2>{s, t});
      CHECK((!overlap || listed));
    }
  CHECK(sampled > 20);
  CHECK(found.size() < static_cast<std::size_t>(sampled) + sampled / 10);  // sampling misses small overlaps
}

TEST_CASE("contacts are no crossings") {
  const std::vector<Vec3> points{{0, 0, 0},     {2, 0, 0}, {0, 2, 0}, {0, 0, 1},
                                 {0.5, 0.5, 0}, {1, 1, 1}, {0, 1, 1}};
  CHECK(crossings(points, {{0, 1, 2}, {0, 1, 3}}).empty());  // a common edge
  CHECK(crossings(points, {{0, 1, 2}, {0, 3, 6}}).empty());  // a common corner
  CHECK(crossings(points, {{0, 1, 2}, {4, 5, 6}}).empty());  // a corner in the other's inside
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0},  {0, 1, 0},
                                 {2, 0, 0}, {2, 1, 0}, {0.5, 0, 0}};
  CHECK(crossings(square, {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}).empty());  // neighbours in a plane
  CHECK(crossings({}, {}).empty());
}

TEST_CASE("crossing triangles: the search ends at the wanted number") {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (Index t = 0; t < 100; ++t) {  // all through one line, each turned a little further
    const double a = 0.03 * t;
    const Vec3 across{std::cos(a), std::sin(a), 0}, low{0, 0, -0.01 * t};
    for (const Vec3& p : {low - across, low + across, Vec3{0, 0, 1 + 0.01 * t}}) points.push_back(p);
    triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  CHECK(crossings(points, triangles).size() > 4000);
  const auto some = crossings(points, triangles, 500);
  CHECK(some.size() >= 500);
  CHECK(some.size() < 600);
}

TEST_CASE("crossing triangles: the search can be cancelled") {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> triangles(500, {0, 1, 2});
  Context context([](const char*, double) { return false; });
  CHECK_THROWS_AS(find_crossings(points, triangles, context), Cancelled);
}
