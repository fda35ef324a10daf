// PLCs with exact geometry for the tests: the tessellations are coarse and thin on purpose, as a CAD
// kernel's.
#pragma once

#include <algorithm>
#include <cmath>

#include <numbers>
#include <vector>

#include "plc/geometry.h"
#include "plc/plc.h"

namespace dm::shapes {

struct Shape {
  Plc plc;
  GeometryRecords records;

  Index point(const Vec3& p) {
    for (std::size_t i = 0; i < plc.points.size(); ++i)
      if (distance(plc.points[i], p) < 1e-9) return static_cast<Index>(i);
    plc.points.push_back(p);
    return static_cast<Index>(plc.points.size()) - 1;
  }
  void corner(const Vec3& p) {
    plc.corners.push_back(point(p));
    plc.corner_vertex.push_back(plc.vertex_count++);
  }
  Index face(const SurfaceRecord& record, Index behind, Index front = 0) {
    records.faces.push_back(record);
    plc.face_solids.push_back({behind, front});
    plc.solid_count = std::max({plc.solid_count, behind, front});
    return static_cast<Index>(records.faces.size()) - 1;
  }
  void triangle(Index face, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Triangle t{point(a), point(b), point(c)};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return;
    plc.triangles.push_back(t);
    plc.triangle_face.push_back(face);
  }
  void quad(Index face, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    triangle(face, a, b, c);
    triangle(face, a, c, d);
  }
  void edge(const CurveRecord& record, const std::vector<Vec3>& path) {
    records.edges.push_back(record);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      plc.segments.push_back({point(path[i]), point(path[i + 1])});
      plc.segment_edge.push_back(plc.edge_count);
    }
    ++plc.edge_count;
  }
  void line(const Vec3& a, const Vec3& b) { edge({CurveKind::line, a, normalized(b - a), 0, -1}, {a, b}); }
};

inline SurfaceRecord plane(const Vec3& origin, const Vec3& normal) {
  return {SurfaceKind::plane, origin, normalized(normal), 0, 0, -1};
}

inline std::vector<Vec3> circle(double r, double z, int n) {
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i) {
    const double a = 2 * std::numbers::pi * (i % n) / n;
    points.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return points;
}

inline void box_walls(Shape& s, const Vec3& lo, const Vec3& hi, Index solid, bool skip_low_x,
                      Index high_x_front) {
  auto p = [&](int i) { return Vec3{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; };
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (int f = skip_low_x ? 1 : 0; f < 6; ++f) {
    const Vec3 a = p(quads[f][0]), b = p(quads[f][1]), c = p(quads[f][2]), d = p(quads[f][3]);
    s.quad(s.face(plane(a, area_vector(a, b, c)), solid, f == 1 ? high_x_front : 0), a, b, c, d);
  }
  for (int i = 0; i < 8; ++i) {
    if (skip_low_x && !(i & 1)) continue;
    s.corner(p(i));
  }
  for (int i = 0; i < 8; ++i)
    for (int bit : {1, 2, 4})
      if (!(i & bit) && !(skip_low_x && bit != 1 && !(i & 1))) s.line(p(i), p(i | bit));
}

inline Shape box(double a, double b, double c) {
  Shape s;
  box_walls(s, {0, 0, 0}, {a, b, c}, 1, false, 0);
  return s;
}

// Two boxes with a shared face.
inline Shape two_boxes() {
  Shape s;
  box_walls(s, {0, 0, 0}, {10, 10, 10}, 1, false, 2);
  box_walls(s, {10, 0, 0}, {25, 10, 10}, 2, true, 0);
  return s;
}

// Cylinder (a tube when inner > 0), or a frustum or cone when the radii at top and bottom differ.
// The tessellation has n strips from bottom to top and no inner points.
inline Shape turned(double bottom, double top, double height, double inner, int n) {
  Shape s;
  const Vec3 z{0, 0, 1};
  SurfaceRecord wall{SurfaceKind::cylinder, {}, z, bottom, 0, -1};
  if (bottom != top) {
    const double apex = height * bottom / (bottom - top);
    wall = {SurfaceKind::cone, {0, 0, apex}, -z, std::atan(bottom / apex), 0, -1};
  }
  const auto low = circle(bottom, 0, n), high = circle(top, height, n);
  const auto low_in = circle(inner, 0, n), high_in = circle(inner, height, n);
  const Index side = s.face(wall, 1), floor = s.face(plane({}, -z), 1);
  const Index roof = top > 0 ? s.face(plane({0, 0, height}, z), 1) : -1;
  const Index hole = inner > 0 ? s.face({SurfaceKind::cylinder, {}, z, inner, 0, -1}, 1) : -1;
  for (int i = 0; i < n; ++i) {
    s.quad(side, low[i], low[i + 1], high[i + 1], high[i]);
    if (inner > 0) {
      s.quad(hole, low_in[i + 1], low_in[i], high_in[i], high_in[i + 1]);
      s.quad(floor, low[i + 1], low[i], low_in[i], low_in[i + 1]);
      s.quad(roof, high[i], high[i + 1], high_in[i + 1], high_in[i]);
    } else if (i > 0 && i + 1 < n) {
      s.triangle(floor, low[0], low[i + 1], low[i]);
      if (top > 0) s.triangle(roof, high[0], high[i], high[i + 1]);
    }
  }
  s.corner(low[0]);
  s.corner(high[0]);
  s.edge({CurveKind::circle, {}, z, bottom, -1}, low);
  if (top > 0) s.edge({CurveKind::circle, {0, 0, height}, z, top, -1}, high);
  if (inner > 0) {
    s.edge({CurveKind::circle, {}, z, inner, -1}, low_in);
    s.edge({CurveKind::circle, {0, 0, height}, z, inner, -1}, high_in);
  }
  return s;
}

// Closed surfaces without any feature: n by m patches.
inline Shape sphere(double r, int n) {
  Shape s;
  const Index f = s.face({SurfaceKind::sphere, {}, {0, 0, 1}, r, 0, -1}, 1);
  auto at = [&](int i, int j) {
    const double u = 2 * std::numbers::pi * (i % n) / n, v = std::numbers::pi * j / (n / 2);
    if (j == 0 || j == n / 2) return Vec3{0, 0, j == 0 ? -r : r};
    return Vec3{r * std::sin(v) * std::cos(u), r * std::sin(v) * std::sin(u), -r * std::cos(v)};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n / 2; ++j) s.quad(f, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  s.corner({0, 0, -r});
  s.corner({0, 0, r});
  return s;
}

inline Shape torus(double major, double minor, int n, int m) {
  Shape s;
  const Index f = s.face({SurfaceKind::torus, {}, {0, 0, 1}, major, minor, -1}, 1);
  auto at = [&](int i, int j) {
    const double u = 2 * std::numbers::pi * (i % n) / n, v = 2 * std::numbers::pi * (j % m) / m;
    const double r = major + minor * std::cos(v);
    return Vec3{r * std::cos(u), r * std::sin(u), minor * std::sin(v)};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) s.quad(f, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return s;
}

}  // namespace dm::shapes
