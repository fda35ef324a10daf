// A binary tree of boxes over items that have a bounding box.
//
// Built by median splits along the longest axis of the items' centres: O(n log n), leaves of at most four
// items, children of a node next to each other in memory.  The order of equal items is by index, so the tree
// is a function of the boxes alone.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "base/vec3.h"

namespace dm {

struct Box {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Box& b) {
    low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
    high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
  }
  Vec3 centre() const { return 0.5 * (low + high); }
  Vec3 extent() const { return high - low; }
  bool overlaps(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
  Vec3 nearest(const Vec3& p) const {
    return {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y), std::clamp(p.z, low.z, high.z)};
  }
  double distance2(const Vec3& p) const {
    const double x = std::max({low.x - p.x, p.x - high.x, 0.0});
    const double y = std::max({low.y - p.y, p.y - high.y, 0.0});
    const double z = std::max({low.z - p.z, p.z - high.z, 0.0});
    return x * x + y * y + z * z;
  }
};

class BoxTree {
 public:
  struct Node {
    Box box;
    Index first = 0;  // inner: the first of its two children; leaf: first place in order()
    Index count = 0;  // 0: inner node
  };
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box>& boxes);
  bool empty() const { return nodes_.empty(); }
  const std::vector<Node>& nodes() const { return nodes_; }  // children come after their parent
  const std::vector<Index>& order() const { return order_; }

 private:
  void split(Index node, Index begin, Index end, const std::vector<Vec3>& centres);
  std::vector<Node> nodes_;
  std::vector<Index> order_;
};

}  // namespace dm
