// Shape of a triangle in space.
#pragma once

#include <cmath>

#include "base/vec3.h"

namespace dm {

// 1 for the equilateral triangle, 0 for a degenerate one: area over the sum of squared edges.
inline double triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double sum = norm2(b - a) + norm2(c - b) + norm2(a - c);
  return sum > 0 ? 2 * std::sqrt(3.0) * norm(area_vector(a, b, c)) / sum : 0;
}

}  // namespace dm
