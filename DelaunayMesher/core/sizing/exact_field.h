// The size field as its sources define it, without the octree:
// h(x) = max(floor, min(max_size, min over sources of (size + slope * distance))).
//
// Exact (to the 3 % of SourceTree) and slow: microseconds.  The octree samples it.
#pragma once

#include <vector>

#include "sizing/boundary_tree.h"
#include "sizing/size_field.h"
#include "sizing/source_tree.h"

namespace dm {

// Nearest point of the region (a ball, box or cylinder, inside included) to p.
Vec3 nearest_in_region(const SizeRegion& region, const Vec3& p);

struct ExactField {
  double max_size = 0, floor = 0, growth = 0;
  SourceTree sources;
  std::vector<SizeRegion> regions;
  std::vector<double> solid_size;  // empty = none
  const BoundaryTree* boundary = nullptr;

  double at(const Vec3& p, Index& hint) const;
  // at() inside; outside, where a source on the boundary decides, the field continued linearly through the
  // boundary, so that it has no kink there that interpolation would have to resolve.
  double continued(const Vec3& p, Index& hint) const;
  double smallest() const;  // a lower bound of at()
  bool constant() const { return smallest() >= max_size; }

  // Does `interpolant` differ from the field by more than the fraction `tolerance` at some place where a
  // source comes nearest to the middle of the box?  `largest` bounds the interpolant.
  template <class Interpolant>
  bool differs(const Box& box, double largest, double tolerance, Interpolant&& interpolant) const {
    const auto wrong = [&](const Vec3& on, double size, double rate) {
      const Vec3 q = box.nearest(on);
      const double h = std::max(size + rate * distance(on, q), floor), guess = interpolant(q);
      if (h < (1 - tolerance) * guess) return true;
      Index hint = -1;
      return q == on && guess < (1 - tolerance) * h && guess < (1 - tolerance) * at(q, hint);
    };
    for (const SizeRegion& r : regions)
      if (r.size < largest && wrong(nearest_in_region(r, box.centre()), r.size, slope(r))) return true;
    return sources.any_near(box, largest,
                            [&](const Vec3& on, double size) { return wrong(on, size, growth); });
  }

 private:
  double slope(const SizeRegion& region) const;
};

}  // namespace dm
