// Numbers of the edges of a tetrahedral mesh, in the order of their first appearance.
//
// One chain of edges per smaller end point; the chains are about seven long, so that a look-up costs some
// ten nanoseconds and the table needs no hashing.
#pragma once

#include <vector>

#include "base/vec3.h"

namespace dm {

class EdgeTable {
 public:
  explicit EdgeTable(std::size_t point_count) : first_(point_count, -1) {}

  Index count() const { return static_cast<Index>(ends_.size()); }
  const Segment& ends(Index edge) const { return ends_[edge]; }
  // -1: no such edge.
  Index find(Index a, Index b) const {
    const auto [low, high] = a < b ? Segment{a, b} : Segment{b, a};
    Index e = first_[low];
    while (e >= 0 && ends_[e][1] != high) e = next_[e];
    return e;
  }
  Index find_or_add(Index a, Index b) {
    const Index known = find(a, b);
    if (known >= 0) return known;
    const auto [low, high] = a < b ? Segment{a, b} : Segment{b, a};
    ends_.push_back({low, high});
    next_.push_back(first_[low]);
    first_[low] = count() - 1;
    return count() - 1;
  }

 private:
  std::vector<Index> first_, next_;
  std::vector<Segment> ends_;
};

}  // namespace dm
