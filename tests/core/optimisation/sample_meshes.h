// Small tetrahedral meshes of known shape for the tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "base/tet_geometry.h"
#include "base/volume_mesh.h"
#include "optimisation/quality.h"
#include "plc/geometry.h"

namespace sample {

using namespace dm;

// Orients the tetrahedra and links neighbours.
inline void link(VolumeMesh& mesh) {
  mesh.neighbours.assign(mesh.tets.size(), {-1, -1, -1, -1});
  mesh.tet_solid.resize(mesh.tets.size(), 1);
  std::map<Triangle, Index> open;
  for (Index t = 0; t < static_cast<Index>(mesh.tets.size()); ++t) {
    Tet& c = mesh.tets[t];
    const Vec3& a = mesh.points[c[0]];
    if (dot(area_vector(a, mesh.points[c[1]], mesh.points[c[2]]), mesh.points[c[3]] - a) < 0)
      std::swap(c[2], c[3]);
    for (int i = 0; i < 4; ++i) {
      Triangle key{c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4]};
      std::sort(key.begin(), key.end());
      const auto [it, fresh] = open.emplace(key, 4 * t + i);
      if (fresh) continue;
      mesh.neighbours[t][i] = it->second;
      mesh.neighbours[it->second / 4][it->second % 4] = 4 * t + i;
      open.erase(it);
    }
  }
}

// Outer faces of the tetrahedra with outward normals; face_of gives the CAD face of each.
template <class FaceOf>
void add_boundary(VolumeMesh& mesh, FaceOf face_of) {
  static constexpr int kFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int i = 0; i < 4; ++i) {
      if (mesh.neighbours[t][i] >= 0) continue;
      const Tet& c = mesh.tets[t];
      mesh.triangles.push_back({c[kFace[i][0]], c[kFace[i][1]], c[kFace[i][2]]});
      mesh.triangle_face.push_back(face_of(mesh.triangles.back()));
    }
}

// Neither angle gets worse but inside what the guard leaves free (quality.h).
inline bool keeps(const AngleRange& before, const AngleRange& after, double rounding) {
  const bool poor = before.min < 26.5 || before.max > 140;
  return after.min >= std::min(before.min, poor ? 26.5 : 30.0) - rounding &&
         after.max <= std::max(before.max, poor ? 140.0 : 136.0) + rounding;
}

inline double volume(const VolumeMesh& mesh) {
  double v = 0;
  for (const Tet& t : mesh.tets) {
    const Vec3& a = mesh.points[t[0]];
    v += dot(area_vector(a, mesh.points[t[1]], mesh.points[t[2]]), mesh.points[t[3]] - a) / 6;
  }
  return v;
}

inline AngleRange angles(const VolumeMesh& mesh) {
  AngleRange all{180, 0};
  for (const Tet& t : mesh.tets) {
    const auto r = dihedral_range(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
    all = {std::min(all.min, r.min), std::max(all.max, r.max)};
  }
  return all;
}

// The same while it is being edited.
template <class Edit>
AngleRange angles_of(const Edit& mesh) {
  AngleCosines all;
  for (Index t = 0; t < mesh.slot_count(); ++t)
    if (!mesh.removed(t)) all.include(mesh.cosines(mesh.tet(t)));
  const auto degrees = [](double cosine) { return std::acos(cosine) * 180 / std::numbers::pi; };
  return {degrees(all.sharp), degrees(all.blunt)};
}

// The boundary of the mesh as a PLC, each CAD face between solid 1 and the outside.
inline Plc boundary_plc(const VolumeMesh& mesh, Index faces, Index edges) {
  Plc plc;
  plc.points = mesh.points;
  plc.triangles = mesh.triangles;
  plc.triangle_face = mesh.triangle_face;
  plc.segments = mesh.segments;
  plc.segment_edge = mesh.segment_edge;
  plc.face_solids.assign(faces, {1, 0});
  plc.edge_count = edges;
  plc.solid_count = 1;
  return plc;
}

struct Sample {
  VolumeMesh mesh;
  Plc plc;
  GeometryRecords records;
};

// A box of n * n * n unit cubes, six tetrahedra each (Kuhn), points moved at random by up to `noise` within
// their CAD element.  CAD face 2 * axis + side.
inline Sample box(Index n, double noise, std::uint64_t seed = 1) {
  Sample s;
  const auto at = [n](Index i, Index j, Index k) { return (i * (n + 1) + j) * (n + 1) + k; };
  const auto edge_of = [n](const std::array<Index, 3>& p) {  // 4 * free axis + sides of the other two
    int axis = 0;
    while (p[axis] == 0 || p[axis] == n) ++axis;
    return 4 * axis + 2 * (p[(axis + 1) % 3] == n) + (p[(axis + 2) % 3] == n);
  };
  for (Index i = 0; i <= n; ++i)
    for (Index j = 0; j <= n; ++j)
      for (Index k = 0; k <= n; ++k) {
        const std::array<Index, 3> p{i, j, k};
        Random random(seed, i, j, k);
        Vec3 x;
        int fixed = 0;
        Index face = 0;
        for (int a = 0; a < 3; ++a) {
          const bool at_side = p[a] == 0 || p[a] == n;
          x[a] = p[a] + (at_side ? 0 : noise * random.symmetric());
          if (at_side) face = 2 * a + (p[a] == n), ++fixed;
        }
        s.mesh.points.push_back(x);
        s.mesh.point_entity.push_back(fixed == 0   ? Entity{3, 1}
                                      : fixed == 1 ? Entity{2, face}
                                      : fixed == 2 ? Entity{1, edge_of(p)}
                                                   : Entity{0, at(i > 0, j > 0, k > 0)});
      }
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      for (Index k = 0; k < n; ++k) {
        std::array<int, 3> order{0, 1, 2};
        do {
          std::array<Index, 3> p{i, j, k};
          Tet t{at(i, j, k)};
          for (int step = 0; step < 3; ++step) ++p[order[step]], t[step + 1] = at(p[0], p[1], p[2]);
          s.mesh.tets.push_back(t);
        } while (std::next_permutation(order.begin(), order.end()));
      }
  link(s.mesh);
  add_boundary(s.mesh, [&](const Triangle& t) {
    for (int a = 0; a < 3; ++a)
      for (const double side : {0.0, static_cast<double>(n)})
        if (s.mesh.points[t[0]][a] == side && s.mesh.points[t[1]][a] == side &&
            s.mesh.points[t[2]][a] == side)
          return 2 * a + (side > 0);
    return -1;
  });
  for (Index i = 0; i < n; ++i)
    for (int a = 0; a < 3; ++a)
      for (int sides = 0; sides < 4; ++sides) {
        std::array<Index, 3> p{}, q{};
        p[a] = i, q[a] = i + 1;
        p[(a + 1) % 3] = q[(a + 1) % 3] = sides & 2 ? n : 0;
        p[(a + 2) % 3] = q[(a + 2) % 3] = sides & 1 ? n : 0;
        s.mesh.segments.push_back({at(p[0], p[1], p[2]), at(q[0], q[1], q[2])});
        s.mesh.segment_edge.push_back(4 * a + sides);
      }
  for (int f = 0; f < 6; ++f) {
    SurfaceRecord r;
    r.kind = SurfaceKind::plane;
    r.origin[f / 2] = f % 2 * n;
    r.axis[f / 2] = 1;
    s.records.faces.push_back(r);
  }
  for (int e = 0; e < 12; ++e) {
    CurveRecord r;
    r.kind = CurveKind::line;
    r.axis[e / 4] = 1;
    r.origin[(e / 4 + 1) % 3] = e & 2 ? n : 0;
    r.origin[(e / 4 + 2) % 3] = e & 1 ? n : 0;
    s.records.edges.push_back(r);
  }
  s.plc = boundary_plc(s.mesh, 6, 12);
  return s;
}

// A box flattened to a part of its height: the angles are poor everywhere.
inline Sample slab(Index n, double part, std::uint64_t seed) {
  Sample s = box(n, 0.2, seed);
  for (Vec3& p : s.mesh.points) p.z *= part;
  s.records.faces[5].origin.z *= part;
  for (CurveRecord& edge : s.records.edges) edge.origin.z *= part;
  s.plc = boundary_plc(s.mesh, 6, 12);
  return s;
}

// box(4) as two solids that share CAD face 6 at x = 2.
inline Sample two_boxes(double noise, std::uint64_t seed) {
  auto s = box(4, noise, seed);
  VolumeMesh& m = s.mesh;
  const Index n = 4;
  for (std::size_t v = 0; v < m.points.size(); ++v) {
    if (static_cast<Index>(v) / ((n + 1) * (n + 1)) != 2) continue;
    m.points[v].x = 2;
    Entity& e = m.point_entity[v];
    e = e.dimension == 3 ? Entity{2, 6} : Entity{0, 0};
  }
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    double x = 0;
    for (Index v : m.tets[t]) x += m.points[v].x / 4;
    m.tet_solid[t] = x > 2 ? 2 : 1;
  }
  for (std::size_t t = 0; t < m.tets.size(); ++t)
    for (int i = 0; i < 4; ++i) {
      const Index o = m.neighbours[t][i];
      if (o < 0 || m.tet_solid[t] != 1 || m.tet_solid[o / 4] != 2) continue;
      const Tet& c = m.tets[t];
      static constexpr int kFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
      m.triangles.push_back({c[kFace[i][0]], c[kFace[i][1]], c[kFace[i][2]]});
      m.triangle_face.push_back(6);
    }
  s.records.faces.push_back({SurfaceKind::plane, {2, 0, 0}, {1, 0, 0}, 0, 0, -1});
  s.plc = boundary_plc(m, 7, 12);
  s.plc.face_solids[6] = {1, 2};
  s.plc.face_solids[1] = {2, 0};
  s.plc.solid_count = 2;
  return s;
}

// n tetrahedra round the edge from (0, 0, -height) to (0, 0, height), the others on the unit circle at the
// heights `wave` * (+1, -1, ...).  Points 0 and 1 are the edge.  Every outer triangle is a CAD face of its
// own.
inline Sample ring(int n, double height, double wave = 0) {
  Sample s;
  s.mesh.points = {{0, 0, -height}, {0, 0, height}};
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    s.mesh.points.push_back({std::cos(a), std::sin(a), i % 2 ? -wave : wave});
  }
  s.mesh.point_entity.assign(n + 2, {0, 0});
  for (int i = 0; i < n; ++i) s.mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % n});
  link(s.mesh);
  Index faces = 0;
  add_boundary(s.mesh, [&](const Triangle&) { return faces++; });
  s.plc = boundary_plc(s.mesh, faces, 0);
  return s;
}

// The two tetrahedra on an equilateral triangle of side 1 (points 0..2) with the apexes at +-height.
inline Sample bipyramid(double height) {
  Sample s;
  const double r = 1 / std::sqrt(3.0);
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * std::numbers::pi * i / 3;
    s.mesh.points.push_back({r * std::cos(a), r * std::sin(a), 0});
  }
  s.mesh.points.push_back({0, 0, height});
  s.mesh.points.push_back({0, 0, -height});
  s.mesh.point_entity.assign(5, {0, 0});
  s.mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
  link(s.mesh);
  Index faces = 0;
  add_boundary(s.mesh, [&](const Triangle&) { return faces++; });
  s.plc = boundary_plc(s.mesh, faces, 0);
  return s;
}

// The icosahedron on the unit sphere, its triangles split `levels` times.
struct Icosphere {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};
inline Icosphere icosphere(int levels) {
  Icosphere s;
  std::vector<Vec3>& p = s.points;
  const double g = (1 + std::sqrt(5.0)) / 2;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) p.insert(p.end(), {Vec3{0, a, b}, Vec3{a, b, 0}, Vec3{b, 0, a}});
  const auto near = [&](Index i, Index j) { return norm2(p[i] - p[j]) < 4.1; };
  for (Index i = 0; i < 12; ++i)
    for (Index j = i + 1; j < 12; ++j)
      for (Index k = j + 1; k < 12; ++k)
        if (near(i, j) && near(j, k) && near(i, k)) s.triangles.push_back({i, j, k});
  for (int level = 0; level < levels; ++level) {
    std::map<Segment, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [it, fresh] =
          middles.emplace(Segment{std::min(a, b), std::max(a, b)}, static_cast<Index>(p.size()));
      if (fresh) p.push_back(0.5 * (p[a] + p[b]));
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    s.triangles = finer;
  }
  for (Vec3& x : p) x = normalized(x);
  return s;
}

inline SurfaceRecord sphere(double r) {
  SurfaceRecord record;
  record.kind = SurfaceKind::sphere;
  record.a = r;
  return record;
}

// A ball of radius r: an icosphere joined to the centre.  One CAD face.
inline Sample ball(double r, int levels) {
  Sample s;
  const Icosphere ico = icosphere(levels);
  for (const Vec3& x : ico.points) s.mesh.points.push_back(r * x);
  s.mesh.point_entity.assign(ico.points.size(), {2, 0});
  const Index centre = static_cast<Index>(s.mesh.points.size());
  s.mesh.points.push_back({});
  s.mesh.point_entity.push_back({3, 1});
  for (const Triangle& t : ico.triangles) s.mesh.tets.push_back({t[0], t[1], t[2], centre});
  link(s.mesh);
  add_boundary(s.mesh, [](const Triangle&) { return 0; });
  s.records.faces = {sphere(r)};
  s.plc = boundary_plc(s.mesh, 1, 0);
  return s;
}

// The space between two spheres: icospheres of the given radii, prisms between them in three tetrahedra each.
// CAD faces: 0 inner, 1 outer.
inline Sample shell(const std::vector<double>& radii, int levels) {
  Sample s;
  const Icosphere ico = icosphere(levels);
  const Index n = static_cast<Index>(ico.points.size());
  for (std::size_t l = 0; l < radii.size(); ++l)
    for (const Vec3& x : ico.points) {
      s.mesh.points.push_back(radii[l] * x);
      const bool inner = l == 0, outer = l + 1 == radii.size();
      s.mesh.point_entity.push_back(inner ? Entity{2, 0} : outer ? Entity{2, 1} : Entity{3, 1});
    }
  for (Index l = 0; l + 1 < static_cast<Index>(radii.size()); ++l)
    for (Triangle t : ico.triangles) {
      std::sort(t.begin(), t.end());
      for (Index& v : t) v += l * n;
      s.mesh.tets.push_back({t[0], t[1], t[2], t[2] + n});
      s.mesh.tets.push_back({t[0], t[1], t[1] + n, t[2] + n});
      s.mesh.tets.push_back({t[0], t[0] + n, t[1] + n, t[2] + n});
    }
  link(s.mesh);
  add_boundary(s.mesh, [&](const Triangle& t) { return t[0] < n ? 0 : 1; });
  s.records.faces = {sphere(radii.front()), sphere(radii.back())};
  s.plc = boundary_plc(s.mesh, 2, 0);
  return s;
}

// A cylinder of radius r and height h round the z axis: n sectors, three layers of prisms, three tetrahedra
// each.  CAD faces: 0 wall, 1 bottom, 2 top; edges: 0 bottom circle, 1 top circle.
inline Sample cylinder(double r, double h, int n, int layers) {
  Sample s;
  const auto at = [n](int layer, int k) { return layer * (n + 1) + k; };  // k = n: the axis
  for (int l = 0; l <= layers; ++l)
    for (int k = 0; k <= n; ++k) {
      const double a = 2 * std::numbers::pi * k / n;
      s.mesh.points.push_back(k < n ? Vec3{r * std::cos(a), r * std::sin(a), h * l / layers}
                                    : Vec3{0, 0, h * l / layers});
      const bool cap = l == 0 || l == layers;
      const Index side = l > 0;
      s.mesh.point_entity.push_back(k < n ? (cap ? Entity{1, side} : Entity{2, 0})
                                          : (cap ? Entity{2, 1 + side} : Entity{3, 1}));
    }
  for (int l = 0; l < layers; ++l)
    for (int k = 0; k < n; ++k) {
      std::array<Index, 3> low{at(l, k), at(l, (k + 1) % n), at(l, n)};
      std::sort(low.begin(), low.end());  // diagonals from the lower number: neighbours agree
      const Index up = n + 1;
      s.mesh.tets.push_back({low[0], low[1], low[2], low[2] + up});
      s.mesh.tets.push_back({low[0], low[1], low[1] + up, low[2] + up});
      s.mesh.tets.push_back({low[0], low[0] + up, low[1] + up, low[2] + up});
    }
  link(s.mesh);
  add_boundary(s.mesh, [&](const Triangle& t) {
    const auto all_at = [&](double z) {
      return s.mesh.points[t[0]].z == z && s.mesh.points[t[1]].z == z && s.mesh.points[t[2]].z == z;
    };
    return all_at(0) ? 1 : all_at(h) ? 2 : 0;
  });
  for (int k = 0; k < n; ++k)
    for (int side = 0; side < 2; ++side) {
      s.mesh.segments.push_back({at(side * layers, k), at(side * layers, (k + 1) % n)});
      s.mesh.segment_edge.push_back(side);
    }
  s.records.faces.resize(3);
  s.records.edges.resize(2);
  s.records.faces[0] = {SurfaceKind::cylinder, {0, 0, 0}, {0, 0, 1}, r, 0, -1};
  for (int side = 0; side < 2; ++side) {
    s.records.faces[1 + side] = {SurfaceKind::plane, {0, 0, side * h}, {0, 0, 1}, 0, 0, -1};
    s.records.edges[side] = {CurveKind::circle, {0, 0, side * h}, {0, 0, 1}, r, -1};
  }
  s.plc = boundary_plc(s.mesh, 3, 2);
  return s;
}

}  // namespace sample
