#include "sizing/field_sources.h"

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
double FieldSources::slope(const SizeRegion& region) const {
  if (!(region.transition > 0)) return growth;
  return std::min(growth, std::max(0.0, max_size - region.size) / region.transition);
}

double FieldSources::cap(const Vec3& p, const BoundaryTree& boundary) const {
  double h = max_size;
  for (const SizeRegion& r : regions)
    if (r.size < h) h = std::min(h, r.size + slope(r) * distance(p, nearest_in_region(r, p)));
  if (!solid_size.empty()) {
    const Index solid = boundary.solid_at(p);
    if (solid > 0 && solid <= static_cast<Index>(solid_size.size())) h = std::min(h, solid_size[solid - 1]);
  }
  return h;
}

double FieldSources::smallest() const {
  double h = max_size;
  for (const SizeSource& s : sources) h = std::min(h, s.size);
  for (const SizeRegion& r : regions) h = std::min(h, r.size);
  for (const double s : solid_size) h = std::min(h, s);
  return std::max(h, floor);
}

}  // namespace dm
