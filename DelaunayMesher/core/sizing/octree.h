// The octree that makes the size field quick to ask: leaves with the field at their eight corners,
// interpolated trilinearly.
//
// Built in three steps.  1. Cells that a source or region touches are split down to its size, then neighbours
// until they differ by one level (Moore, 1995).  2. Each corner learns its deciding source: those in its
// leaves first, then by sweeps over the leaves that hand the sources of a leaf's corners to its other
// corners, as in vector distance transforms (Danielsson, 1980).  Distances are exact for the source taken,
// and the source taken is nearly always the best.  3. Cells in the domain that are still larger than their
// size allows are split, their new corners choosing among the sources of the old ones.
// Made for growth < 1.  Postcondition then (checked by tests): within about 10 % of the exact field in the
// domain, 14 % at worst, beside edge and vertex sources and where the influences of two sources meet.
// Outside, beside a face with a source, the field is continued linearly, so that it has no kink there.
// Cost: about four microseconds per leaf and 0.1 to 0.5 leaf (32 bytes) per tetrahedron asked for; lookup 20
// to 40 ns in coherent order.
// Limit: kMaxLeaves leaves; beyond it the finest leaves interpolate coarsely.
#pragma once

#include <array>
#include <vector>

#include "base/context.h"
#include "sizing/boundary_tree.h"
#include "sizing/field_sources.h"

namespace dm {

class Octree {
 public:
  Octree(const FieldSources& field, const Plc& plc, const BoundaryTree& boundary, double domain_volume,
         Context& context);

  double at(const Vec3& p) const;
  double smallest() const { return smallest_; }
  double largest() const { return largest_; }
  // Integral of 1 / h^3 over the inside of the domain.
  double inverse_volume() const { return inverse_volume_; }

 private:
  using Values = std::array<float, 8>;  // corner i at (i & 1, i >> 1 & 1, i >> 2 & 1)
  struct Entry {
    Index node;
    Index level;
  };
  class Builder;

  Vec3 origin_;
  double scale_ = 1;  // finest units per mm
  Index table_level_ = 0;
  std::vector<Entry> table_;    // dense grid over the top levels: where to start the descent
  std::vector<Index> nodes_;    // >= 0: first of eight children; < 0: ~leaf
  std::vector<Values> values_;  // per leaf
  double smallest_ = 0, largest_ = 0, inverse_volume_ = 0;
};

}  // namespace dm
