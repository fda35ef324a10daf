// What the size field is made of:
// h(x) = max(floor, min(max_size, min over sources and regions of (size + slope * distance))), and no more
// than the size of the solid that x lies in.
#pragma once

#include <vector>

#include "sizing/boundary_tree.h"
#include "sizing/size_field.h"
#include "sizing/size_source.h"

namespace dm {

// Nearest point of the region (a ball, box or cylinder, inside included) to p.
Vec3 nearest_in_region(const SizeRegion& region, const Vec3& p);

struct FieldSources {
  double max_size = 0, floor = 0, growth = 0;
  std::vector<SizeSource> sources;
  std::vector<SizeRegion> regions;
  std::vector<double> solid_size;  // empty = none

  // The field by max_size, regions and solids alone.
  double cap(const Vec3& p, const BoundaryTree& boundary) const;
  double smallest() const;  // a lower bound of the field
  bool constant() const { return smallest() >= max_size; }

 private:
  double slope(const SizeRegion& region) const;
};

}  // namespace dm
