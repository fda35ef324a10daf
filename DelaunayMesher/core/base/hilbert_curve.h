// Position of points on a Hilbert curve through a cube: what is close in this order is close in space.
//
// Idea: tables after Hamilton (2006); 2^kBits cells per side.  Cost: some 10 ns per point.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/vec3.h"

namespace dm {

class HilbertCurve {
 public:
  static constexpr int kBits = 10;

  // Through the smallest cube at the low corner of count > 0 points, the k-th of them at(k).
  template <class At>
  static HilbertCurve through(std::size_t count, const At& at) {
    Vec3 low = at(0), high = low;
    for (std::size_t k = 1; k < count; ++k) {
      const Vec3& p = at(k);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return {low, std::max({high.x - low.x, high.y - low.y, high.z - low.z})};
  }

  double side() const { return side_; }
  // Of a point in the cube: ascending along the curve, below 8^kBits.
  std::uint32_t code(const Vec3& p) const {
    const Vec3 q = scale_ * (p - low_);
    return code(static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y),
                static_cast<std::uint32_t>(q.z));
  }

 private:
  static std::uint32_t code(std::uint32_t x, std::uint32_t y, std::uint32_t z);  // of a cell
  HilbertCurve(const Vec3& low, double side)
      : low_(low), side_(side), scale_(side > 1e-280 ? (1 << kBits) * (1 - 0x1.0p-40) / side : 0) {}

  Vec3 low_;
  double side_, scale_;
};

}  // namespace dm
