// Exact geometric predicates: semi-static filter, then integers of a fixed width (exact_integer.h).
//
// Filters as derived in docs/kernel.md; the exact stage puts all coordinates of a test on their common grid.
// All signs are exact for every finite input, whatever overflows or underflows in the filter.
// Ties of insphere are broken by the triangulation (Devillers, Teillaud 2003), not here.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/vec3.h"

namespace dm {

// Sign of dot(cross(b - a, c - a), d - a): +1 when (a, b, c, d) is positively oriented, 0 when coplanar.
inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// +1 when e lies strictly inside the sphere through the positively oriented (a, b, c, d), -1 outside, 0 on
// it.
inline int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

// Are a, b, c on one line, exactly?
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

struct PredicateCounters {
  std::uint64_t orient_exact = 0, insphere_exact = 0, insphere_perturbed = 0;
};
PredicateCounters& predicate_counters();  // of the calling thread

namespace filter {

// Half an ulp of 1: the relative error of one rounded operation.
inline constexpr double kUnit = 0x1.0p-53;
// |error of a triple product| <= kTriple * r^3 and |error of insphere| <= kInsphere * r^5 where all four
// points lie within r of the fifth (docs/kernel.md: 8 u * 1.155 and 17 u * 4 * 1.155, rounded up).
inline constexpr double kTriple = 10 * kUnit;
inline constexpr double kInsphere = 80 * kUnit;
// Below this square of a determinant the underflow of a product might matter: leave it to the exact stage.
inline constexpr double kTiny = 1e-200;

// A tetrahedron seen from a point p: the four triple products and the largest squared distance.
// volume[i] = 6 * signed volume of (a, b, c, d) with corner i replaced by p: p is beyond face i when
// negative.
struct Seen {
  double volume[4];
  double square[4];
  double largest;  // of square[]

  double power() const {
    return (square[0] * volume[0] + square[1] * volume[1]) + (square[2] * volume[2] + square[3] * volume[3]);
  }
  // The rounding error of volume[] and of power(), squared.
  double volume_error2() const { return kTriple * kTriple * (largest * largest * largest) + kTiny; }
  double power_error2() const {
    const double l2 = largest * largest;
    return kInsphere * kInsphere * (l2 * l2 * largest) + kTiny;
  }
};

inline Seen see(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p) {
  const Vec3 A = a - p, B = b - p, C = c - p, D = d - p;
  const double ab = A.x * B.y - A.y * B.x, ac = A.x * C.y - A.y * C.x, ad = A.x * D.y - A.y * D.x;
  const double bc = B.x * C.y - B.y * C.x, bd = B.x * D.y - B.y * D.x, cd = C.x * D.y - C.y * D.x;
  Seen s;
  s.volume[0] = (B.z * cd - C.z * bd) + D.z * bc;
  s.volume[1] = (C.z * ad - A.z * cd) - D.z * ac;
  s.volume[2] = (A.z * bd - B.z * ad) + D.z * ab;
  s.volume[3] = (B.z * ac - A.z * bc) - C.z * ab;
  s.square[0] = norm2(A), s.square[1] = norm2(B), s.square[2] = norm2(C), s.square[3] = norm2(D);
  s.largest = std::max(std::max(s.square[0], s.square[1]), std::max(s.square[2], s.square[3]));
  return s;
}

// Signs after the filter failed.
int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
int insphere_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

}  // namespace filter

inline int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  const filter::Seen s = filter::see(a, b, c, d, e);
  const double power = s.power();
  if (power * power > s.power_error2()) return power > 0 ? 1 : -1;
  return filter::insphere_exact(a, b, c, d, e);
}

inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 A = a - d, B = b - d, C = c - d;
  const double volume =
      -((A.z * (B.x * C.y - B.y * C.x) + B.z * (C.x * A.y - C.y * A.x)) + C.z * (A.x * B.y - A.y * B.x));
  const double largest = std::max(norm2(A), std::max(norm2(B), norm2(C)));
  if (volume * volume > filter::kTriple * filter::kTriple * (largest * largest * largest) + filter::kTiny)
    return volume > 0 ? 1 : -1;
  return filter::orient3d_exact(a, b, c, d);
}

}  // namespace dm
