#include "sizing/size_source.h"

#include <algorithm>
#include <cmath>

namespace dm {

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double l2 = norm2(d);
  if (!(l2 > 0)) return a;
  return a + std::clamp(dot(p - a, d) / l2, 0.0, 1.0) * d;
}

// Ericson, Real-Time Collision Detection (2005), 5.1.5: by the Voronoi regions of corners, edges, inside.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 > d3 ? a + (d1 / (d1 - d3)) * ab : a;
  const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 > d6 ? a + (d2 / (d2 - d6)) * ac : a;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double l = (d4 - d3) + (d5 - d6);
    return l > 0 ? b + ((d4 - d3) / l) * (c - b) : b;
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

Vec3 SizeSource::nearest(const Vec3& p) const {
  if (corners == 1) return a;
  return corners == 2 ? nearest_on_segment(p, a, b) : nearest_on_triangle(p, a, b, c);
}

double SizeSource::continued_distance(const Vec3& p) const {
  const Vec3 out = p - nearest(p);
  const double d = norm(out);
  if (empty_side == 0 || d == 0) return d;
  const Vec3 normal = area_vector(a, b, c);
  const double length = norm(normal);
  if (!(length > 0)) return d;
  return d - 2 * std::max(0.0, empty_side * dot(out, normal) / length);
}

}  // namespace dm
