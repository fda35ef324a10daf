#include "refinement/boundary_flip.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "refinement/angle_test.h"

namespace dm {

namespace {

// Angle between the two labelled faces, seen from the tetrahedron, below which it is never handed over.
constexpr double kBluntAngle = 150;  // degrees

struct Ear {
  int i, j;             // the two labelled faces
  Index first, second;  // their labels
};

// The two labelled faces of one CAD face, if exactly two faces are labelled.
std::optional<Ear> find_ear(const LabelledTriangulation& mesh, Index tet) {
  if (std::popcount(mesh.tets.marks(tet)) != 2) return {};
  Ear ear{-1, -1, -1, -1};
  for (int i = 0; i < 4; ++i)
    if (mesh.tets.marked(tet, i)) (ear.i < 0 ? ear.i : ear.j) = i;
  ear.first = label_of(mesh, tet, ear.i);
  ear.second = label_of(mesh, tet, ear.j);
  if (mesh.boundary.face(ear.first) != mesh.boundary.face(ear.second)) return {};
  return ear;
}

double angle_between(const LabelledTriangulation& mesh, const Ear& ear) {
  const auto& p = mesh.tets.points();
  const auto normal = [&](Index t) {
    const Triangle& q = mesh.boundary.corners(t);
    return normalized(area_vector(p[q[0]], p[q[1]], p[q[2]]));
  };
  const double c = dot(normal(ear.first), normal(ear.second));
  return 180 - std::acos(std::clamp(c, -1.0, 1.0)) * 180 / std::numbers::pi;
}

bool beyond(const LabelledTriangulation& mesh, Index tet, int i, const Vec3& centre) {
  const Tet& v = mesh.tets.corners(tet);
  const auto& p = mesh.tets.points();
  const Vec3 a = p[v[(i + 1) & 3]];
  const Vec3 n = area_vector(a, p[v[(i + 2) & 3]], p[v[(i + 3) & 3]]);
  return dot(n, p[v[i]] - a) * dot(n, centre - a) < 0;
}

bool hand_over(LabelledTriangulation& mesh, Index tet, const Ear& ear) {
  Triangulation& tets = mesh.tets;
  const std::uint16_t other = tets.tag(tets.neighbour(tet, ear.i) / 4);
  if (tets.tag(tets.neighbour(tet, ear.j) / 4) != other) return false;
  int k = -1, l = -1;
  for (int m = 0; m < 4; ++m)
    if (m != ear.i && m != ear.j) (k < 0 ? k : l) = m;
  const Tet& v = tets.corners(tet);
  EdgeFlip flip;
  if (!can_flip(mesh.boundary, tets.points(), v[k], v[l], flip)) return false;
  if (!flip_keeps_angles(tets.points(), flip)) return false;
  do_flip(mesh.boundary, flip);
  for (const int m : {ear.i, ear.j}) set_marked_both(tets, 4 * tet + m, false);
  for (const int m : {k, l}) set_marked_both(tets, 4 * tet + m, true);
  tets.set_tag(tet, other);
  return true;
}

}  // namespace

bool peel(LabelledTriangulation& mesh, Index tet, const Vec3& circumcentre, bool sliver) {
  const auto ear = find_ear(mesh, tet);
  if (!ear) return false;
  const bool misplaced = sliver || beyond(mesh, tet, ear->i, circumcentre) || is_flat(mesh.tets, tet);
  return misplaced && angle_between(mesh, *ear) >= kBluntAngle && hand_over(mesh, tet, *ear);
}

bool flip_in(LabelledTriangulation& mesh, Index tet, std::uint16_t tag) {
  if (mesh.tets.is_ghost(tet)) return false;
  const auto ear = find_ear(mesh, tet);
  if (!ear || mesh.tets.tag(mesh.tets.neighbour(tet, ear->i) / 4) != tag) return false;
  if (angle_between(mesh, *ear) < kBluntAngle) return false;
  const auto [a, b, c, d] = mesh.tets.corners(tet);
  const auto& p = mesh.tets.points();
  const Vec3 centre = circumsphere(p[a], p[b], p[c], p[d]).centre;
  if (!beyond(mesh, tet, ear->i, centre) && !beyond(mesh, tet, ear->j, centre)) return false;
  return hand_over(mesh, tet, *ear);
}

}  // namespace dm
