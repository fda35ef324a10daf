// How bad a tetrahedron is: one scale-free number from its smallest and its largest dihedral angle.
//
// badness = max(cos(smallest) - 1/3, kBluntWeight * (1/3 - cos(largest))): 0 for the regular tetrahedron
// (all angles acos 1/3), equal at both ends of the range aimed at (28 and 138 degrees), and cheap: no inverse
// cosine.  A tetrahedron without positive volume is worse than any other.
#pragma once

#include <array>

#include "base/tet_geometry.h"

namespace dm {

inline constexpr double kBluntWeight = 0.5106;  // (cos 28 - 1/3) / (1/3 - cos 138)
inline constexpr double kInverted = 10;         // badness of a flat or inverted tetrahedron
inline constexpr double kRounding = 1e-9;       // angles that the CAD gives may come out so much different

// Cosines of the extreme dihedral angles.
struct AngleCosines {
  double sharp = -1;  // of the smallest angle: the largest cosine
  double blunt = 1;   // of the largest angle
  void include(const AngleCosines& other) {
    sharp = std::max(sharp, other.sharp);
    blunt = std::min(blunt, other.blunt);
  }
};

inline double badness(const AngleCosines& c) {
  return c.blunt > -1 ? std::max(c.sharp - 1.0 / 3, kBluntWeight * (1.0 / 3 - c.blunt)) : kInverted;
}
// Badness of an element whose smallest angle is `degrees` and whose largest is not worse.
inline double badness_at(double degrees) { return std::cos(degrees * std::numbers::pi / 180) - 1.0 / 3; }

// What an element of this badness is short of 30 degrees, squared: the sum over a mesh is what there is left
// to do.
inline double shortfall(double bad) {
  const double over = std::max(0.0, bad - (0.8660254 - 1.0 / 3));
  return over * over;
}

// The guard of every operation: neither the smallest nor the largest angle of the tetrahedra it touches gets
// worse, unless it stays inside a range that is good anyway: 30 to 136 degrees, or, where one of the two was
// worse than that, 26.5 to 140 (equally bad both).  An element of 18 and 136 degrees may so become one of 26
// and 139.
inline bool keeps_angles(const AngleCosines& before, const AngleCosines& after) {
  constexpr AngleCosines kGood{0.866, -0.7193}, kFair{0.8949, -0.7660};
  const AngleCosines& free = badness(before) > badness(kFair) ? kFair : kGood;
  return after.sharp <= std::max(before.sharp, free.sharp) + kRounding &&
         after.blunt >= std::min(before.blunt, free.blunt) - kRounding && after.blunt > -1;
}

inline bool is_positive(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(area_vector(a, b, c), d - a) > 0;
}

inline AngleCosines angle_cosines(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (!is_positive(a, b, c, d)) return {1, -1};
  const auto cosines = dihedral_cosines(a, b, c, d);
  const auto [low, high] = std::minmax_element(cosines.begin(), cosines.end());
  return {*high, *low};
}

}  // namespace dm
