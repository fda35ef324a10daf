#include "refinement/certificate.h"

#include <algorithm>
#include <unordered_map>

#include "base/tet_geometry.h"
#include "boundary/complex.h"

namespace dm {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

double angle_between(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(dot(normalized(a), normalized(b)), -1.0, 1.0)) * kDegrees;
}

// Points at which the input itself is sharp: on a CAD edge with acute faces, or at a corner of acute CAD
// edges.
std::vector<char> sharp_points(const VolumeMesh& mesh) {
  std::vector<char> sharp(mesh.points.size(), 0);
  std::unordered_map<std::uint64_t, std::vector<Vec3>> wings;  // per segment, directions into its triangles
  for (const auto& [a, b] : mesh.segments) wings[BoundaryComplex::key(a, b)];
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      const auto it = wings.find(BoundaryComplex::key(a, b));
      if (it == wings.end()) continue;
      const Vec3 axis = normalized(mesh.points[b] - mesh.points[a]);
      const Vec3 w = mesh.points[c] - mesh.points[a];
      it->second.push_back(w - dot(w, axis) * axis);
    }
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = mesh.points[t[i]];
      const double corner = angle_between(mesh.points[t[(i + 1) % 3]] - p, mesh.points[t[(i + 2) % 3]] - p);
      if (corner < kAcuteAngle / 2 && mesh.point_entity[t[i]].dimension == 0) sharp[t[i]] = 1;
    }
  }
  for (const auto& [a, b] : mesh.segments) {
    const auto& w = wings[BoundaryComplex::key(a, b)];
    for (std::size_t i = 0; i < w.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (angle_between(w[i], w[j]) < kAcuteAngle) sharp[a] = sharp[b] = 1;
  }
  return sharp;
}

BelowTarget explain(const VolumeMesh& mesh, const SizeField& size, const std::vector<char>& sharp, Index tet,
                    double angle) {
  const Tet& v = mesh.tets[tet];
  BelowTarget out{tet, angle, "fallback", {}, {}};
  for (const Index p : v) {
    out.place += 0.25 * mesh.points[p];
    const Entity e = mesh.point_entity[p];
    if (e.dimension < 3 && (out.entity.dimension < 0 || e.dimension > out.entity.dimension)) out.entity = e;
  }
  if (std::any_of(v.begin(), v.end(), [&](Index p) { return sharp[p] != 0; }))
    out.reason = "input_angle";
  else if (size.smallest() < size.largest() && size.at(out.place) <= 1.001 * size.smallest())
    out.reason = "size_floor";
  return out;
}

}  // namespace

std::vector<BelowTarget> certify(const VolumeMesh& mesh, const SizeField& size, double target_angle) {
  std::vector<BelowTarget> out;
  std::vector<char> sharp;
  for (Index t = 0; t < static_cast<Index>(mesh.tets.size()); ++t) {
    const auto [a, b, c, d] = mesh.tets[t];
    const double angle = dihedral_range(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]).min;
    if (angle >= target_angle) continue;
    if (sharp.empty()) sharp = sharp_points(mesh);
    out.push_back(explain(mesh, size, sharp, t, angle));
  }
  return out;
}

}  // namespace dm
