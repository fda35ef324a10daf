// A source of the size field that has extent: a point, segment or triangle, all of which has the same size.
#pragma once

#include <array>
#include <cstdint>

#include "plc/plc.h"

namespace dm {

struct SizeSource {
  Vec3 a, b, c;
  double size = 0;
  std::int8_t corners = 3;  // 1: a | 2: a, b | 3: a, b, c
  // Triangle of the boundary: where nothing will be meshed, +1 on the side of its right-hand normal, -1 on
  // the other, 0 on neither.
  std::int8_t empty_side = 0;

  static SizeSource point(const Vec3& p, double size) { return {p, p, p, size, 1, 0}; }
  static SizeSource segment(const Vec3& p, const Vec3& q, double size) { return {p, q, q, size, 2, 0}; }
  static SizeSource triangle(const std::array<Vec3, 3>& p, double size, int empty_side) {
    return {p[0], p[1], p[2], size, 3, static_cast<std::int8_t>(empty_side)};
  }
  Vec3 nearest(const Vec3& p) const;
  // distance, less twice the height over the triangle on its empty side: continues the distance inside
  // linearly through the triangle.
  double continued_distance(const Vec3& p) const;
};

// For SizeSource::empty_side.
inline int empty_side(const Plc& plc, Index face) {
  const auto& [behind, front] = plc.face_solids[face];
  return (front == 0) - (behind == 0);
}

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace dm
