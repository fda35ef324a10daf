#include "refinement/certificate.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "base/tet_geometry.h"
#include "boundary/complex.h"

namespace dm {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

double angle_between(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(dot(normalized(a), normalized(b)), -1.0, 1.0)) * kDegrees;
}

// Where the input itself is sharp.
struct SharpInput {
  std::vector<char> point;  // on a CAD edge with acute faces, or at a corner of acute CAD edges
  std::set<std::pair<Index, Index>> faces;         // two that meet at such an edge, the lower one first
  std::vector<std::vector<Index>> corners;         // the faces that meet at such a corner
  std::unordered_multimap<Index, Index> faces_of;  // by point, of all these
};

// The faces at the corners, and which points those of corners and acute edges have.
void collect_faces(const VolumeMesh& mesh, const std::set<Index>& corners, SharpInput& sharp) {
  std::map<Index, std::set<Index>> faces_at;
  std::set<Index> all;
  for (const auto& [f, g] : sharp.faces) all.insert({f, g});
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (const Index p : mesh.triangles[k])
      if (corners.contains(p)) faces_at[p].insert(mesh.triangle_face[k]);
  for (const auto& [p, faces] : faces_at) {
    sharp.corners.emplace_back(faces.begin(), faces.end());
    all.insert(faces.begin(), faces.end());
  }
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (const Index p : mesh.triangles[k])
      if (all.contains(mesh.triangle_face[k])) sharp.faces_of.emplace(p, mesh.triangle_face[k]);
}

// A triangle at a segment.
struct Wing {
  Vec3 direction, normal;  // from the segment into it, and square to it
  Index face;
};

// Does the angle from one wing to another hold a part of a solid?  That of a notch does not.
bool is_sharp_solid(const Wing& from, const Wing& to, const std::vector<std::array<Index, 2>>& face_solids) {
  const bool in_front = dot(from.normal, to.direction) > 0;
  return face_solids[from.face][in_front] != 0 && angle_between(from.direction, to.direction) < kAcuteAngle;
}

SharpInput find_sharp_input(const VolumeMesh& mesh, const std::vector<std::array<Index, 2>>& face_solids) {
  SharpInput sharp{std::vector<char>(mesh.points.size(), 0), {}, {}, {}};
  std::set<Index> corners;
  std::unordered_map<std::uint64_t, std::vector<Wing>> wings;  // by segment
  for (const auto& [a, b] : mesh.segments) wings[BoundaryComplex::key(a, b)];
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[k];
    for (int i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      const Vec3 p = mesh.points[a], w = mesh.points[c] - p, axis = normalized(mesh.points[b] - p);
      if (const auto it = wings.find(BoundaryComplex::key(a, b)); it != wings.end())
        it->second.push_back({w - dot(w, axis) * axis, cross(mesh.points[b] - p, w), mesh.triangle_face[k]});
      if (angle_between(axis, w) < kAcuteAngle / 2 && mesh.point_entity[a].dimension == 0) corners.insert(a);
    }
  }
  for (const auto& [a, b] : mesh.segments) {
    const auto& w = wings[BoundaryComplex::key(a, b)];
    for (std::size_t i = 0; i < w.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (is_sharp_solid(w[i], w[j], face_solids)) {
          sharp.point[a] = sharp.point[b] = 1;
          if (w[i].face != w[j].face) sharp.faces.insert(std::minmax(w[i].face, w[j].face));
        }
  }
  for (const Index p : corners) sharp.point[p] = 1;
  collect_faces(mesh, corners, sharp);
  return sharp;
}

// At a sharp place, from one face of a wedge to the other, or between three faces of a needle.
bool is_in_sharp_part(const SharpInput& sharp, const Tet& v) {
  std::set<Index> touched;
  for (const Index p : v) {
    if (sharp.point[p]) return true;
    const auto [first, last] = sharp.faces_of.equal_range(p);
    for (auto it = first; it != last; ++it) touched.insert(it->second);
  }
  for (const Index f : touched)
    for (const Index g : touched)
      if (sharp.faces.contains({f, g})) return true;
  return std::any_of(sharp.corners.begin(), sharp.corners.end(), [&](const std::vector<Index>& faces) {
    return std::count_if(faces.begin(), faces.end(), [&](Index f) { return touched.contains(f); }) >= 3;
  });
}

BelowTarget explain(const VolumeMesh& mesh, const SizeField& size, const SharpInput& sharp, Index tet,
                    double angle) {
  const Tet& v = mesh.tets[tet];
  BelowTarget out{tet, angle, "fallback", {}, {}};
  for (const Index p : v) {
    out.place += 0.25 * mesh.points[p];
    const Entity e = mesh.point_entity[p];
    if (e.dimension < 3 && (out.entity.dimension < 0 || e.dimension > out.entity.dimension)) out.entity = e;
  }
  if (is_in_sharp_part(sharp, v))
    out.reason = "input_angle";
  else if (size.is_floor(size.at(out.place)))
    out.reason = "size_floor";
  return out;
}

}  // namespace

std::vector<BelowTarget> certify(const VolumeMesh& mesh, const std::vector<std::array<Index, 2>>& face_solids,
                                 const SizeField& size, double target_angle, Context& context) {
  std::vector<BelowTarget> out;
  SharpInput sharp;
  for (Index t = 0; t < static_cast<Index>(mesh.tets.size()); ++t) {
    context.tick(1);
    const auto [a, b, c, d] = mesh.tets[t];
    const double angle = dihedral_range(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]).min;
    if (angle >= target_angle) continue;
    if (out.empty()) sharp = find_sharp_input(mesh, face_solids);
    out.push_back(explain(mesh, size, sharp, t, angle));
  }
  return out;
}

}  // namespace dm
