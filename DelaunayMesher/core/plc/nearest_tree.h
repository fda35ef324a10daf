// Nearest of many triangles or line segments to a point.
//
// A bounding volume hierarchy (Kay, Kajiya 1986; base/box_tree.h), searched nearer child first.  Built in O(n
// log n); a query near the surface costs O(log n), some 0.2-0.5 microseconds. Precondition: at least one
// item, finite coordinates.  Ties go to the item found first: deterministic.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "base/box_tree.h"

namespace dm {

// A point of a triangle (a, b, c) is a + s (b - a) + t (c - a); of a segment (a, b) it is a + s (b - a).
struct NearestPoint {
  double distance2 = std::numeric_limits<double>::infinity();
  Vec3 point;
  double s = 0, t = 0;
  Index item = -1;
};

class SegmentItem {
 public:
  SegmentItem(const Vec3& a, const Vec3& b) : a_(a), b_(b) {}
  int size() const { return 2; }
  const Vec3& corner(int i) const { return i == 0 ? a_ : b_; }
  NearestPoint nearest(const Vec3& p) const;

 private:
  Vec3 a_, b_;
};

// Zero-area triangles are legal: they count as their longest edge.
class TriangleItem {
 public:
  TriangleItem(const Vec3& a, const Vec3& b, const Vec3& c);
  int size() const { return 3; }
  const Vec3& corner(int i) const { return corner_[i]; }
  NearestPoint nearest(const Vec3& p) const;
  Vec3 area_normal() const { return area_vector(corner_[0], corner_[1], corner_[2]); }
  bool flat() const { return flat_; }

 private:
  NearestPoint nearest_on_edges(const Vec3& p) const;
  std::array<Vec3, 3> corner_;
  bool flat_;  // no area to speak of
};

template <class Item>
class NearestTree {
 public:
  explicit NearestTree(std::vector<Item> items) : items_(std::move(items)), tree_(boxes_of(items_)) {}

  Index size() const { return static_cast<Index>(items_.size()); }
  const Item& item(Index i) const { return items_[i]; }

  NearestPoint nearest(const Vec3& p) const {
    return nearest(p, [](const Item&) { return true; });
  }

  // Of the items that are accepted and nearer than that; item -1 if there are none.
  template <class Accept>
  NearestPoint nearest(const Vec3& p, Accept&& accept,
                       double distance2 = std::numeric_limits<double>::infinity()) const {
    const auto& nodes = tree_.nodes();
    NearestPoint best;
    best.distance2 = distance2;
    struct Waiting {
      Index node;
      double distance2;
    };
    Waiting stack[64];
    int top = 0;
    stack[top++] = {0, 0};
    while (top > 0) {
      const Waiting waiting = stack[--top];
      if (waiting.distance2 >= best.distance2) continue;
      const BoxTree::Node* node = &nodes[waiting.node];
      while (node->count == 0) {
        Index near = node->first, far = near + 1;
        double near_d = nodes[near].box.distance2(p), far_d = nodes[far].box.distance2(p);
        if (far_d < near_d) std::swap(near, far), std::swap(near_d, far_d);
        if (far_d < best.distance2) stack[top++] = {far, far_d};
        if (near_d >= best.distance2) break;
        node = &nodes[near];
      }
      for (Index i = 0; i < node->count; ++i) {
        const Index item = tree_.order()[node->first + i];
        const NearestPoint found = items_[item].nearest(p);
        if (found.distance2 < best.distance2 && accept(items_[item])) best = found, best.item = item;
      }
    }
    return best;
  }

 private:
  static std::vector<Box> boxes_of(const std::vector<Item>& items) {
    std::vector<Box> boxes(items.size());
    for (std::size_t k = 0; k < items.size(); ++k)
      for (int i = 0; i < items[k].size(); ++i) boxes[k].add(items[k].corner(i));
    return boxes;
  }

  std::vector<Item> items_;
  BoxTree tree_;
};

// The nearest triangle that is not turned away from `side`; if all are, the nearest.
inline NearestPoint nearest_facing(const NearestTree<TriangleItem>& tree, const Vec3& p, const Vec3& side) {
  const NearestPoint found =
      tree.nearest(p, [&](const TriangleItem& t) { return t.flat() || dot(t.area_normal(), side) >= 0; });
  return found.item >= 0 ? found : tree.nearest(p);
}

}  // namespace dm
