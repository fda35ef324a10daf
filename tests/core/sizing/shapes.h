// Small PLCs for the tests of the size field.
#pragma once

#include <map>
#include <numbers>

#include "plc/geometry.h"
#include "plc/plc.h"

namespace dm::test {

struct Shape {
  Plc plc;
  GeometryRecords records;  // empty = facets
};

inline void add_quad(Plc& plc, Index a, Index b, Index c, Index d, Index face) {
  plc.triangles.push_back({a, b, c});
  plc.triangles.push_back({a, c, d});
  plc.triangle_face.insert(plc.triangle_face.end(), 2, face);
}

// Segments wherever two faces meet; one CAD edge per pair of faces.
inline void add_segments(Plc& plc) {
  std::map<Segment, Index> face_of;
  std::map<std::array<Index, 2>, Index> edge_of;
  for (std::size_t t = 0; t < plc.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      Index a = plc.triangles[t][i], b = plc.triangles[t][(i + 1) % 3];
      if (a > b) std::swap(a, b);
      const auto [at, fresh] = face_of.try_emplace({a, b}, plc.triangle_face[t]);
      if (fresh || at->second == plc.triangle_face[t]) continue;
      const std::array<Index, 2> pair{std::min(at->second, plc.triangle_face[t]),
                                      std::max(at->second, plc.triangle_face[t])};
      const Index edge = edge_of.try_emplace(pair, static_cast<Index>(edge_of.size())).first->second;
      plc.segments.push_back({a, b});
      plc.segment_edge.push_back(edge);
    }
  plc.edge_count = static_cast<Index>(edge_of.size());
}

// A hexahedron by its corners (x fastest), faces x-, x+, y-, y+, z-, z+ outwards; another solid is added to
// plc.
inline void add_hexahedron(Plc& plc, const std::array<Vec3, 8>& p) {
  const auto o = static_cast<Index>(plc.points.size());
  const auto f = static_cast<Index>(plc.face_solids.size());
  plc.points.insert(plc.points.end(), p.begin(), p.end());
  ++plc.solid_count;
  constexpr Index kQuads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (Index i = 0; i < 6; ++i) {
    const auto& q = kQuads[i];
    add_quad(plc, o + q[0], o + q[1], o + q[2], o + q[3], f + i);
    plc.face_solids.push_back({plc.solid_count, 0});
  }
}

inline void add_box(Plc& plc, const Vec3& a, const Vec3& b) {
  std::array<Vec3, 8> p;
  for (int i = 0; i < 8; ++i) p[i] = {i & 1 ? b.x : a.x, i & 2 ? b.y : a.y, i & 4 ? b.z : a.z};
  add_hexahedron(plc, p);
}

inline Shape box(const Vec3& a, const Vec3& b) {
  Shape shape;
  add_box(shape.plc, a, b);
  add_segments(shape.plc);
  return shape;
}

// Wedge with its acute edge along y at x = z = 0, of length 1 and width 1; faces: bottom, top, back, sides.
inline Shape wedge(double degrees) {
  const double height = std::tan(degrees * std::numbers::pi / 180);
  Shape shape;
  Plc& plc = shape.plc;
  plc.points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, height}, {1, 1, height}};
  add_quad(plc, 0, 1, 3, 2, 0);
  add_quad(plc, 0, 4, 5, 1, 1);
  add_quad(plc, 2, 3, 5, 4, 2);
  plc.triangles.push_back({0, 2, 4});
  plc.triangles.push_back({1, 5, 3});
  plc.triangle_face.insert(plc.triangle_face.end(), {3, 4});
  plc.face_solids.assign(5, {1, 0});
  plc.solid_count = 1;
  add_segments(plc);
  return shape;
}

// A cylinder round the z direction, one side face with n facets and two plane caps; appended as a new solid.
inline void add_cylinder(Shape& shape, const Vec3& base, double radius, double height, Index n) {
  Plc& plc = shape.plc;
  const auto o = static_cast<Index>(plc.points.size());
  const auto f = static_cast<Index>(plc.face_solids.size());
  for (Index i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    const Vec3 p = base + Vec3{radius * std::cos(angle), radius * std::sin(angle), 0};
    plc.points.push_back(p);
    plc.points.push_back(p + Vec3{0, 0, height});
  }
  for (Index i = 0; i < n; ++i) {
    const Index a = o + 2 * i, b = o + 2 * ((i + 1) % n);
    add_quad(plc, a, b, b + 1, a + 1, f);
  }
  for (Index i = 1; i + 1 < n; ++i) {
    plc.triangles.push_back({o, o + 2 * (i + 1), o + 2 * i});
    plc.triangles.push_back({o + 1, o + 2 * i + 1, o + 2 * (i + 1) + 1});
    plc.triangle_face.insert(plc.triangle_face.end(), {f + 1, f + 2});
  }
  ++plc.solid_count;
  plc.face_solids.insert(plc.face_solids.end(), 3, {plc.solid_count, 0});
  shape.records.faces.push_back({SurfaceKind::cylinder, base, {0, 0, 1}, radius, 0, -1});
  shape.records.faces.push_back({SurfaceKind::plane, base, {0, 0, -1}, 0, 0, -1});
  shape.records.faces.push_back({SurfaceKind::plane, base + Vec3{0, 0, height}, {0, 0, 1}, 0, 0, -1});
}

// Give every CAD edge a record: polylines.
inline void finish(Shape& shape) {
  add_segments(shape.plc);
  shape.records.edges.assign(shape.plc.edge_count, CurveRecord{});
}

// A sphere round c from a subdivided octahedron: 8 * 4^level triangles, one face.
inline Shape ball(const Vec3& c, double radius, int level) {
  Shape shape;
  Plc& plc = shape.plc;
  plc.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  plc.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int l = 0; l < level; ++l) {
    std::map<Segment, Index> middle;
    const auto mid = [&](Index a, Index b) {
      const auto [at, fresh] =
          middle.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<Index>(plc.points.size()));
      if (fresh) plc.points.push_back(normalized(plc.points[a] + plc.points[b]));
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, d] : plc.triangles) {
      const Index e = mid(a, b), f = mid(b, d), g = mid(d, a);
      finer.insert(finer.end(), {{a, e, g}, {e, b, f}, {g, f, d}, {e, f, g}});
    }
    plc.triangles.swap(finer);
  }
  for (Vec3& p : plc.points) p = c + radius * p;
  plc.triangle_face.assign(plc.triangles.size(), 0);
  plc.face_solids = {{1, 0}};
  plc.solid_count = 1;
  shape.records.faces.push_back({SurfaceKind::sphere, c, {0, 0, 1}, radius, 0, -1});
  return shape;
}

}  // namespace dm::test
