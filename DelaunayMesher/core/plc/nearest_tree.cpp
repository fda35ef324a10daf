#include "plc/nearest_tree.h"

namespace dm {

NearestPoint SegmentItem::nearest(const Vec3& p) const {
  const Vec3 along = b_ - a_;
  const double length2 = norm2(along);
  NearestPoint result;
  result.s = length2 > 0 ? std::clamp(dot(p - a_, along) / length2, 0.0, 1.0) : 0;
  result.point = result.s < 1 ? a_ + result.s * along : b_;
  result.distance2 = norm2(p - result.point);
  return result;
}

TriangleItem::TriangleItem(const Vec3& a, const Vec3& b, const Vec3& c) : corner_{a, b, c} {
  const double longest2 = std::max({norm2(b - a), norm2(c - a), norm2(c - b)});
  flat_ = norm2(area_normal()) <= 1e-24 * longest2 * longest2;
}

NearestPoint TriangleItem::nearest_on_edges(const Vec3& p) const {
  NearestPoint best;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    NearestPoint found = SegmentItem(corner_[i], corner_[j]).nearest(p);
    if (found.distance2 >= best.distance2) continue;
    const double along = found.s;
    found.s = i == 0 ? along : i == 1 ? 1 - along : 0;
    found.t = i == 0 ? 0 : i == 1 ? along : 1 - along;
    best = found;
  }
  return best;
}

// By Voronoi regions (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
NearestPoint TriangleItem::nearest(const Vec3& p) const {
  if (flat_) return nearest_on_edges(p);
  const Vec3 &a = corner_[0], &b = corner_[1], &c = corner_[2];
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  NearestPoint result;
  if (d1 <= 0 && d2 <= 0) {
  } else if (d3 >= 0 && d4 <= d3) {
    result.s = 1;
  } else if (d6 >= 0 && d5 <= d6) {
    result.t = 1;
  } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    result.s = d1 / (d1 - d3);
  } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    result.t = d2 / (d2 - d6);
  } else if (va <= 0 && d4 >= d3 && d5 >= d6) {
    result.t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    result.s = 1 - result.t;
  } else {
    const double inverse = 1 / (va + vb + vc);
    result.s = vb * inverse, result.t = vc * inverse;
  }
  result.point = result.s == 1 ? b : result.t == 1 ? c : a + result.s * ab + result.t * ac;
  result.distance2 = norm2(p - result.point);
  return result;
}

}  // namespace dm
