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

// The guard of every operation: neither the smallest nor the largest angle of the tetrahedra it touches gets
// worse, unless it stays inside a range that is good anyway (30 to 136 degrees).
inline bool keeps_angles(const AngleCosines& before, const AngleCosines& after) {
  constexpr double kSharpFree = 0.866, kBluntFree = -0.7193;  // cos 30, cos 136
  return after.sharp <= std::max(before.sharp, kSharpFree) &&
         after.blunt >= std::min(before.blunt, kBluntFree) && after.blunt > -1;
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
