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
  Builder(Octree& tree, const FieldSources& field, const Plc& plc, const BoundaryTree& boundary,
          Context& context);
  void build(double domain_volume);

 private:
  enum class Place : std::uint8_t { outside, inside, mixed };
  using Corner = std::array<std::uint32_t, 3>;  // in units of the finest level
  struct Range {
    std::size_t begin = 0, end = 0;
  };
  struct Cell {
    Corner low;
    std::uint32_t size;
    Index node;
    Place place;
    Range triangles, sources;     // in lists_: those that touch the cell
    std::array<Index, 8> corner;  // in corners_, from the second step on
    std::uint32_t seen = 0;       // latest change of its corners when it was last relaxed
  };
  struct CornerValue {
    Corner at;
    Index source = -1;
    float value, cap;           // value: the field by its source; cap: by the rest
    std::uint32_t changed = 1;  // number of the change that made its value
  };

  struct Ball {
    Vec3 centre;
    double radius;
  };

  Vec3 point(const Corner& c) const;
  Box box(const Cell& cell) const;
  double edge(const Cell& cell) const { return cell.size / tree_.scale_; }
  // Of the items in a range of lists_, those whose item touches the box; appended to lists_.
  template <class Touches>
  Range filter(Range range, Touches&& touches);
  bool split(Index cell);
  Place place(const Cell& child, Place parent, const std::array<Cell, 8>& siblings,
              std::uint32_t number) const;
  bool too_coarse_for_sources(const Cell& cell) const;
  void balance();
  Index leaf_at(const Corner& c) const;
  Index corner_at(const Corner& c);
  void make_corners(Cell& cell);
  bool relax(Index corner, Index source);
  void sweep();
  void refine_domain();
  double lowest(const Cell& cell) const;
  std::vector<float> corner_values() const;
  void finish(double domain_volume);
  void make_table();

  Octree& tree_;
  const FieldSources& field_;
  const Plc& plc_;
  const BoundaryTree& boundary_;
  Context& context_;
  std::vector<Cell> cells_;   // the leaves
  std::vector<Index> lists_;  // triangles of the PLC and sources, by cell
  std::vector<Ball> balls_;   // around the sources
  std::vector<CornerValue> corners_;
  std::vector<Index> slots_;   // hash table of corners_ by position, open addressing, -1 = free
  std::uint32_t changes_ = 1;  // of corner values so far
};

}  // namespace dm
