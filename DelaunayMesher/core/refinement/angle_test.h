// The test that decides whether a proposed site is taken: the sharpest dihedral angle of the new tetrahedra.
//
// Angles are compared through c |c| of their cosine c, which needs neither a square root nor acos.
#pragma once

#include "boundary/recovery.h"
#include "curves/length_field.h"

namespace dm {

// Monotone in the cosine: cos * |cos|.
inline double sharpness_of_angle(double degrees) {
  const double c = std::cos(degrees * std::numbers::pi / 180);
  return c * std::abs(c);
}

// Largest cos|cos| over the six dihedral angles (the sharpest angle); bit k of `exempt` skips kFacePairs[k].
inline double sharpness(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, unsigned exempt = 0) {
  const Vec3 u = b - a, v = c - a, w = d - a, x = c - b, y = d - b;
  const Vec3 n[4] = {cross(y, x), cross(v, w), cross(w, u), cross(u, v)};
  const double l[4] = {1 / norm2(n[0]), 1 / norm2(n[1]), 1 / norm2(n[2]), 1 / norm2(n[3])};
  if (!(l[0] + l[1] + l[2] + l[3] < HUGE_VAL)) return 1;  // a face without area: the worst there is
  double worst = -1;
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = kFacePairs[k];
    const double s = -dot(n[i], n[j]);
    const double q = s * std::abs(s) * l[i] * l[j];
    if (q > worst && !(exempt >> k & 1)) worst = q;
  }
  return worst;
}

// Bits of the dihedral angles of (corners, site) that lie on acute segments of the input.
unsigned exempt_angles(const BoundaryComplex& complex, Index v0, Index v1, Index v2, Index v3);

// Sharpness of a tetrahedron of the mesh, acute segments left out.
double tet_sharpness(const LabelledTriangulation& mesh, Index tet);

// Is the tetrahedron as flat as CAD's points in a plane are: six times its volume below 1e-7 of its longest
// edge cubed?
bool is_flat(const std::vector<Vec3>& points, const Tet& tet);
inline bool is_flat(const Triangulation& tets, Index tet) {
  return is_flat(tets.points(), tets.corners(tet));
}

// Circumradius bound of the refinement: rho(x)^2.
struct RadiusBound {
  const LengthField& size;
  double factor = 0.72;
  double squared(const Vec3& p) const {
    const double r = factor * size.at(p);
    return r * r;
  }
  // The sphere's radius over the bound where that lies between 1 and `most`; elsewhere any on the same side.
  double excess(const Sphere& sphere, double most) const {
    const double length = std::sqrt(sphere.radius2) / factor;
    return length / size.at_between(sphere.centre, length / most, length);
  }
};

inline constexpr double kRejected = 2;  // sharpness of no candidate at all

// Sharpness of the worst tetrahedron that site p would make and that would stay: on a labelled face, or with
// a circumradius within the bound.  Stops early once it exceeds `give_up`; kRejected
// when a new tetrahedron would not be positive.
double evaluate_site(const LabelledTriangulation& mesh, const Cavity& cavity, const Vec3& p,
                     const RadiusBound& bound, double target, double give_up);

}  // namespace dm
