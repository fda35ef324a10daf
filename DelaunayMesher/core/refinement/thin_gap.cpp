#include "refinement/thin_gap.h"

#include <algorithm>

namespace dm {

namespace {

constexpr double kThin = 0.5;       // gap over edge below which the gap decides the angles
constexpr double kThinWall = 0.25;  // the same of a wall; those that the size field resolves are thicker
constexpr double kOpposed = -0.9;   // cosine between the normals of a wall's sides
constexpr double kLong = 2;  // edge over the wanted one from which on the tetrahedron is refined all the same

}  // namespace

ThinGaps::ThinGaps(const LabelledTriangulation& mesh, const Geometry& geometry)
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

bool ThinGaps::holds(Index tet, double edge) const {
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
  return in_wall(v, kThinWall * edge);
}

// Between faces at two of the corners that are about parallel, and close to each other?
bool ThinGaps::in_wall(const Tet& v, double gap) const {
  std::array<Index, 2> faces{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j)
      if (opposed(v[i], v[j], faces) && spans(v, faces, gap)) return true;
  return false;
}

bool ThinGaps::opposed(Index a, Index b, std::array<Index, 2>& faces) const {
  const BoundaryComplex& boundary = mesh_.boundary;
  const auto normal = [&](Index t) {
    const Triangle& q = boundary.corners(t);
    return normalized(area_vector(mesh_.tets.point(q[0]), mesh_.tets.point(q[1]), mesh_.tets.point(q[2])));
  };
  for (const Index s : boundary.triangles_at(a)) {
    const Vec3 n = normal(s);
    for (const Index t : boundary.triangles_at(b)) {
      faces = {boundary.face(s), boundary.face(t)};
      if (faces[0] != faces[1] && dot(n, normal(t)) < kOpposed) return true;
    }
  }
  return false;
}

// Are all corners on the two faces, some of them off each, and not farther than `gap` from it?
bool ThinGaps::spans(const Tet& v, const std::array<Index, 2>& faces, double gap) const {
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

bool ThinGaps::on_face(Index v, Index face) const {
  const auto near = mesh_.boundary.triangles_at(v);
  return std::any_of(near.begin(), near.end(), [&](Index t) { return mesh_.boundary.face(t) == face; });
}

}  // namespace dm
