// The octree that makes the size field quick to ask: leaves with the field at their eight corners,
// interpolated trilinearly.
//
// Built breadth first from the exact field.  A cell is split while it touches or lies in the domain and the
// interpolant may be wrong by more than a few per cent: it is larger than twice the size wanted in it, or its
// centre deviates, or a source dips below the interpolant.  In a linear field large cells suffice.
// Precondition: the exact field is Lipschitz with its growth rate.  Postcondition (checked by tests): within
// about 5 % of the exact field in the domain (13 % at worst, beside edge and vertex sources).  The jump
// between neighbouring leaves is of the same order as that error.
// Cost: about 0.1 leaf (32 bytes) per tetrahedron asked for; lookup 20 to 40 ns in coherent order.
// Limit: kMaxLeaves leaves; beyond it the finest leaves hold their smallest value all over.
#pragma once

#include <vector>

#include "base/context.h"
#include "sizing/exact_field.h"

namespace dm {

class Octree {
 public:
  Octree(const ExactField& field, const BoundaryTree& boundary, Context& context);

  double at(const Vec3& p) const;
  double smallest() const { return smallest_; }
  double largest() const { return largest_; }
  // Integral of 1 / h^3 over the inside of the domain.
  double inverse_volume() const { return inverse_volume_; }
  std::size_t leaves() const { return values_.size(); }

 private:
  using Values = std::array<float, 8>;  // corner i at (i & 1, i >> 1 & 1, i >> 2 & 1)
  enum class Place : std::uint8_t { outside, inside, mixed };
  struct Cell {
    std::array<std::uint32_t, 3> corner;  // lowest corner, in units of the finest level
    Index node;
    Index hint;  // a source near the cell
    Place place;
    Values values;
  };
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
