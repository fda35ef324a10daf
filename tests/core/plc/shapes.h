// Small PLCs for the tests.
#pragma once

#include <functional>
#include <numbers>

#include "plc/plc.h"

namespace dm::test {

constexpr double pi = std::numbers::pi;

// One open face: the grid of nu x nv cells over f(u, v), normals along df/du x df/dv.
inline Plc patch(const std::function<Vec3(double, double)>& f, std::array<double, 4> range, int nu, int nv) {
  Plc plc;
  for (int i = 0; i <= nu; ++i) {
    for (int j = 0; j <= nv; ++j) {
      plc.points.push_back(
          f(range[0] + (range[1] - range[0]) * i / nu, range[2] + (range[3] - range[2]) * j / nv));
    }
  }
  for (Index i = 0; i < nu; ++i) {
    for (Index j = 0; j < nv; ++j) {
      const Index a = i * (nv + 1) + j, b = a + nv + 1;
      plc.triangles.push_back({a, b, b + 1});
      plc.triangles.push_back({a, b + 1, a + 1});
    }
  }
  plc.triangle_face.assign(plc.triangles.size(), 0);
  plc.face_solids = {{1, 0}};
  plc.solid_count = 1;
  return plc;
}

// One edge: n segments along f(t); a closed one ends where it starts.
inline Plc path(const std::function<Vec3(double)>& f, double first, double last, int n, bool closed) {
  Plc plc;
  for (int i = 0; i < n + (closed ? 0 : 1); ++i) plc.points.push_back(f(first + (last - first) * i / n));
  for (Index i = 0; i < n; ++i) {
    plc.segments.push_back({i, (i + 1) % static_cast<Index>(plc.points.size())});
  }
  plc.segment_edge.assign(plc.segments.size(), 0);
  plc.edge_count = 1;
  return plc;
}

// The box [0, x] x [0, y] x [0, z] with its six faces, twelve edges and eight vertices.
inline Plc box(double x = 1, double y = 1, double z = 1) {
  Plc plc;
  for (Index i = 0; i < 8; ++i) plc.points.push_back({i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0});
  const Index quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (Index face = 0; face < 6; ++face) {
    const auto& q = quads[face];
    plc.triangles.push_back({q[0], q[1], q[2]});
    plc.triangles.push_back({q[0], q[2], q[3]});
    plc.triangle_face.insert(plc.triangle_face.end(), 2, face);
    plc.face_solids.push_back({1, 0});
  }
  for (Index i = 0; i < 8; ++i) {
    for (Index bit = 1; bit < 8; bit *= 2) {
      if (i & bit) continue;
      plc.segments.push_back({i, i | bit});
      plc.segment_edge.push_back(plc.edge_count++);
    }
    plc.corners.push_back(i);
    plc.corner_vertex.push_back(i);
  }
  plc.vertex_count = 8;
  plc.solid_count = 1;
  return plc;
}

// Two boxes side by side in x that share Face7 (index 6), each with its own five other faces.
inline Plc two_boxes() {
  Plc plc;
  for (Index i = 0; i < 12; ++i) {
    plc.points.push_back({static_cast<double>(i % 3), i / 3 % 2 ? 1.0 : 0.0, i >= 6 ? 1.0 : 0.0});
  }
  const auto quad = [&](Index a, Index b, Index c, Index d, Index behind, Index front) {
    plc.triangles.push_back({a, b, c});
    plc.triangles.push_back({a, c, d});
    plc.triangle_face.insert(plc.triangle_face.end(), 2, static_cast<Index>(plc.face_solids.size()));
    plc.face_solids.push_back({behind, front});
  };
  for (Index s = 0; s < 2; ++s) {
    quad(s, s + 3, s + 4, s + 1, s + 1, 0);
    quad(s + 6, s + 7, s + 10, s + 9, s + 1, 0);
    quad(s, s + 1, s + 7, s + 6, s + 1, 0);
    quad(s + 3, s + 9, s + 10, s + 4, s + 1, 0);
    if (s == 0) quad(0, 6, 9, 3, 1, 0);
    if (s == 1) quad(2, 5, 11, 8, 2, 0);
  }
  quad(1, 4, 10, 7, 1, 2);
  plc.solid_count = 2;
  return plc;
}

}  // namespace dm::test
