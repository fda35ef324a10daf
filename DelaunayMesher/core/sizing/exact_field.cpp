#include "sizing/exact_field.h"

namespace dm {

Vec3 nearest_in_region(const SizeRegion& region, const Vec3& p) {
  if (region.kind == 1) {
    Box box;
    box.add(region.a);
    box.add(region.b);
    return box.nearest(p);
  }
  if (region.kind == 2) {
    const Vec3 axis = region.b - region.a;
    const double l2 = norm2(axis);
    const double t = l2 > 0 ? dot(p - region.a, axis) / l2 : 0;
    const Vec3 foot = region.a + t * axis, out = p - foot;
    const double r = norm(out);
    const Vec3 cap = region.a + std::clamp(t, 0.0, 1.0) * axis;
    return cap + (r > region.radius ? region.radius / r : 1.0) * out;
  }
  const Vec3 out = p - region.a;
  const double r = norm(out);
  return r > region.radius ? region.a + (region.radius / r) * out : p;
}

// From `size` to max_size over the transition, but never steeper than the growth rate.
double ExactField::slope(const SizeRegion& region) const {
  if (!(region.transition > 0)) return growth;
  return std::min(growth, std::max(0.0, max_size - region.size) / region.transition);
}

double ExactField::at(const Vec3& p, Index& hint) const {
  double h = max_size;
  for (const SizeRegion& r : regions) {
    if (r.size < h) h = std::min(h, r.size + slope(r) * distance(p, nearest_in_region(r, p)));
  }
  h = sources.at(p, h, hint);
  if (!solid_size.empty()) {
    const Index solid = boundary->solid_at(p);
    if (solid > 0 && solid <= static_cast<Index>(solid_size.size())) h = std::min(h, solid_size[solid - 1]);
  }
  return std::max(h, floor);
}

double ExactField::continued(const Vec3& p, Index& hint) const {
  const double h = at(p, hint);
  if (hint < 0 || !sources.source(hint).on_boundary) return h;
  const BoundaryTree::Foot nearest = boundary->nearest(p, distance(p, sources.source(hint).nearest(p)));
  if (nearest.solid > 0) return h;
  Index foot_hint = hint;
  const double foot = at(nearest.place, foot_hint);
  return std::max({2 * foot - h, 0.25 * foot, floor});
}

double ExactField::smallest() const {
  double h = std::min(max_size, sources.smallest());
  for (const SizeRegion& r : regions) h = std::min(h, r.size);
  for (const double s : solid_size) h = std::min(h, s);
  return std::max(h, floor);
}

}  // namespace dm
