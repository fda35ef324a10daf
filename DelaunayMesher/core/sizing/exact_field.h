// The size field as its sources define it, without the octree:
// h(x) = max(floor, min(max_size, min over sources of (size + slope * distance))).
//
// Exact (to the 1 % of SourceTree) and slow: microseconds.  The octree samples it.
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
  double smallest() const;  // a lower bound of at()
  bool constant() const { return smallest() >= max_size; }

  // Is the field at some place in the box lower than what `interpolant` says there, by more than the fraction
  // `tolerance`?  A search by the nearest points of the sources in the box; `largest` bounds the interpolant.
  template <class Interpolant>
  bool dips(const Box& box, double largest, double tolerance, Interpolant&& interpolant) const {
    const auto below = [&](const Vec3& q, double h) {
      return std::max(h, floor) < (1 - tolerance) * interpolant(q);
    };
    for (const SizeRegion& r : regions) {
      if (r.size >= largest) continue;
      const Vec3 on = nearest_in_region(r, box.centre()), q = box.nearest(on);
      if (below(q, r.size + slope(r) * distance(on, q))) return true;
    }
    return sources.any_dip(box, largest, below);
  }

 private:
  double slope(const SizeRegion& region) const;
};

}  // namespace dm
