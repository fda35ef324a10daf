#include "sizing/octree.h"

#include "sizing/octree_builder.h"

namespace dm {

Octree::Octree(const FieldSources& field, const Plc& plc, const BoundaryTree& boundary, double domain_volume,
               Context& context) {
  Builder(*this, field, plc, boundary, context).build(domain_volume);
}

double Octree::at(const Vec3& p) const {
  constexpr double kLast = kFinest - 1e-6;
  const double x = std::clamp((p.x - origin_.x) * scale_, 0.0, kLast);
  const double y = std::clamp((p.y - origin_.y) * scale_, 0.0, kLast);
  const double z = std::clamp((p.z - origin_.z) * scale_, 0.0, kLast);
  const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y),
             k = static_cast<std::uint32_t>(z);
  const int shift = kMaxLevel - table_level_;
  const Entry entry =
      table_[((((k >> shift) << table_level_) | (j >> shift)) << table_level_) | (i >> shift)];
  Index node = entry.node;
  int bits = kMaxLevel - entry.level;
  while (node >= 0) {
    --bits;
    node = nodes_[node + ((i >> bits & 1) | (j >> bits & 1) << 1 | (k >> bits & 1) << 2)];
  }
  const std::uint32_t size = 1u << bits, mask = ~(size - 1);
  const double inverse = 1.0 / size;
  return interpolate(values_[~node], (x - (i & mask)) * inverse, (y - (j & mask)) * inverse,
                     (z - (k & mask)) * inverse);
}

}  // namespace dm
