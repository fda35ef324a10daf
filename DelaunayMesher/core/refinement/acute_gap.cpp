#include "refinement/acute_gap.h"

#include <algorithm>

namespace dm {

namespace {

constexpr double kThin = 0.5;  // gap over edge below which the gap decides the angles
constexpr double kLong = 2;  // edge over the wanted one from which on the tetrahedron is refined all the same

}  // namespace

AcuteGaps::AcuteGaps(const LabelledTriangulation& mesh, const Geometry& geometry)
    : mesh_(mesh), geometry_(geometry) {
  BoundaryComplex::Fan fan;
  for (const auto& [key, unused] : mesh.boundary.acute_segments()) {
    const auto [a, b] = BoundaryComplex::segment_of_key(key);
    const int n = mesh.boundary.triangles_at(a, b, fan);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Index f = mesh.boundary.face(fan[i]), g = mesh.boundary.face(fan[j]);
        if (f != g) pairs_.push_back({f, g});
      }
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
}

bool AcuteGaps::holds(Index tet, double edge) const {
  if (pairs_.empty()) return false;
  const Tet& v = mesh_.tets.corners(tet);
  for (int i = 0; i < 4; ++i) {
    if (!mesh_.boundary.on_boundary(v[i])) return false;
    for (int j = 0; j < i; ++j)
      if (distance(mesh_.tets.point(v[i]), mesh_.tets.point(v[j])) > kLong * edge) return false;
  }
  for (const Index t : mesh_.boundary.triangles_at(v[0])) {
    const Index f = mesh_.boundary.face(t);
    for (auto it = std::lower_bound(pairs_.begin(), pairs_.end(), std::array<Index, 2>{f, -1});
         it != pairs_.end() && (*it)[0] == f; ++it)
      if (spans(v, *it, kThin * edge)) return true;
  }
  return false;
}

// Are all corners on the two faces, some of them off each, and not farther than `gap` from it?
bool AcuteGaps::spans(const Tet& v, const std::array<Index, 2>& faces, double gap) const {
  int off[2] = {0, 0};
  for (const Index p : v) {
    const bool first = on_face(p, faces[0]), second = on_face(p, faces[1]);
    if (!first && !second) return false;
    off[0] += !first, off[1] += !second;
  }
  if (!off[0] || !off[1]) return false;
  for (const Index p : v)
    for (const Index f : faces) {
      if (on_face(p, f)) continue;
      const Vec3& place = mesh_.tets.point(p);
      if (distance(place, geometry_.project_to_face(f, place)) > gap) return false;
    }
  return true;
}

bool AcuteGaps::on_face(Index v, Index face) const {
  const auto near = mesh_.boundary.triangles_at(v);
  return std::any_of(near.begin(), near.end(), [&](Index t) { return mesh_.boundary.face(t) == face; });
}

}  // namespace dm
