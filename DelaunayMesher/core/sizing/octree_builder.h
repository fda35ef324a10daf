// How the octree of the size field is built; private to octree.cpp and octree_builder.cpp.
#pragma once

#include "sizing/octree.h"

namespace dm {

inline constexpr int kMaxLevel = 20;
inline constexpr double kFinest = 1 << kMaxLevel;  // finest units along the root cell

inline double interpolate(const std::array<float, 8>& v, double x, double y, double z) {
  const double a = v[0] + x * (v[1] - v[0]), b = v[2] + x * (v[3] - v[2]);
  const double c = v[4] + x * (v[5] - v[4]), d = v[6] + x * (v[7] - v[6]);
  const double e = a + y * (b - a), f = c + y * (d - c);
  return e + z * (f - e);
}

class Octree::Builder {
 public:
  Builder(Octree& tree, const ExactField& field, const BoundaryTree& boundary, Context& context);
  void build();

 private:
  Vec3 point(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
  Box box(const Cell& cell, std::uint32_t size) const;
  float corner_value(std::uint32_t x, std::uint32_t y, std::uint32_t z, Place place, Index& hint);
  bool must_split(Cell& cell, std::uint32_t size);
  Place place(const Cell& cell, std::uint32_t size, Place parent, const Cell* siblings,
              std::uint32_t number) const;
  void split(const Cell& cell, std::uint32_t size, std::vector<Cell>& children);
  void finish(const Cell& cell, std::uint32_t size);
  void make_table();
  void integrate_mixed();

  Octree& tree_;
  const ExactField& field_;
  const BoundaryTree& boundary_;
  Context& context_;
  // Corner values by position, so that neighbours ask the exact field once: open addressing, key 0 = free.
  std::vector<std::uint64_t> keys_;
  std::vector<float> known_;
  std::size_t known_count_ = 0;
  void grow();
  // Leaves across the boundary: their weight if they were inside.
  struct MixedLeaf {
    std::array<std::uint32_t, 3> corner;
    std::uint32_t size;
    double weight;
  };
  std::vector<MixedLeaf> mixed_;
};

}  // namespace dm
