// Plain floating-point geometry of one tetrahedron: circumsphere, dihedral and solid angles.
#pragma once

#include <algorithm>
#include <numbers>

#include "base/vec3.h"

namespace dm {

struct Sphere {
  Vec3 centre;
  double radius2 = 0;
};

// Radius infinite for a flat tetrahedron.
inline Sphere circumsphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 n = cross(u, v);
  const double det = 2 * dot(n, w);
  if (det == 0) return {a, HUGE_VAL};
  const Vec3 o = (1 / det) * (norm2(u) * cross(v, w) + norm2(v) * cross(w, u) + norm2(w) * n);
  return {a + o, norm2(o)};
}

// The corners of face i, counter-clockwise seen from corner i: (f0, f1, f2, corner i) is positively oriented.
inline constexpr int kFaceCorners[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

// Pairs of faces whose common edge is (other two corners): the six dihedral angles in one order everywhere.
inline constexpr int kFacePairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// Cosines of the six dihedral angles, in the order of kFacePairs; the angle between faces i and j lies at the
// edge joining the other two corners.
inline std::array<double, 6> dihedral_cosines(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::array<Vec3, 4> n = {cross(d - b, c - b), cross(c - a, d - a), cross(d - a, b - a),
                                 cross(b - a, c - a)};
  std::array<double, 4> l{};
  for (int i = 0; i < 4; ++i) l[i] = norm2(n[i]);
  std::array<double, 6> cosines{};
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = kFacePairs[k];
    const double s = std::sqrt(l[i] * l[j]);
    cosines[k] = s > 0 ? std::clamp(-dot(n[i], n[j]) / s, -1.0, 1.0) : 1;
  }
  return cosines;
}

struct AngleRange {
  double min, max;  // degrees
};
inline AngleRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto cosines = dihedral_cosines(a, b, c, d);
  const auto [low, high] = std::minmax_element(cosines.begin(), cosines.end());
  return {std::acos(*high) * 180 / std::numbers::pi, std::acos(*low) * 180 / std::numbers::pi};
}

// The solid angle of a triangle seen from the origin, positive when it is seen clockwise from there (Van
// Oosterom and Strackee 1983).
inline double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = norm(a), lb = norm(b), lc = norm(c);
  const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return 2 * std::atan2(dot(a, cross(b, c)), below);
}

}  // namespace dm
