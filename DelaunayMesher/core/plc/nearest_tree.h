// Nearest of many triangles or line segments to a point.
//
// A bounding volume hierarchy split at the median of the longest axis (Kay, Kajiya 1986), searched nearer
// child first.  Built in O(n log n); a query near the surface costs O(log n), some 0.2-0.5 microseconds.
// Precondition: at least one item, finite coordinates.  Ties go to the item found first: deterministic.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "base/vec3.h"

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
  explicit NearestTree(std::vector<Item> items) : items_(std::move(items)), order_(items_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    centres_.reserve(items_.size());
    for (const Item& item : items_) {
      Vec3 sum;
      for (int i = 0; i < item.size(); ++i) sum += item.corner(i);
      centres_.push_back(sum);
    }
    nodes_.reserve(2 * items_.size() / leaf_size + 2);
    build(0, static_cast<Index>(items_.size()));
    centres_ = {};
  }

  const Item& item(Index i) const { return items_[i]; }

  NearestPoint nearest(const Vec3& p) const {
    NearestPoint best;
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
      const Node* node = &nodes_[waiting.node];
      while (node->count == 0) {
        Index near = node->left, far = node->right;
        double near_d = nodes_[near].box.distance2(p), far_d = nodes_[far].box.distance2(p);
        if (far_d < near_d) std::swap(near, far), std::swap(near_d, far_d);
        if (far_d < best.distance2) stack[top++] = {far, far_d};
        if (near_d >= best.distance2) break;
        node = &nodes_[near];
      }
      for (Index i = 0; i < node->count; ++i) {
        const Index item = order_[node->left + i];
        const NearestPoint found = items_[item].nearest(p);
        if (found.distance2 < best.distance2) best = found, best.item = item;
      }
    }
    return best;
  }

 private:
  static constexpr Index leaf_size = 4;

  struct Box {
    Vec3 low{inf, inf, inf}, high{-inf, -inf, -inf};
    static constexpr double inf = std::numeric_limits<double>::infinity();
    void add(const Vec3& p) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    double distance2(const Vec3& p) const {
      const double x = std::max(std::max(low.x - p.x, p.x - high.x), 0.0);
      const double y = std::max(std::max(low.y - p.y, p.y - high.y), 0.0);
      const double z = std::max(std::max(low.z - p.z, p.z - high.z), 0.0);
      return x * x + y * y + z * z;
    }
  };
  // A leaf (count > 0) holds order_[left, left + count); an inner node its two children.
  struct Node {
    Box box;
    Index left = 0, right = 0, count = 0;
  };

  Index build(Index first, Index last) {
    const Index index = static_cast<Index>(nodes_.size());
    nodes_.emplace_back();
    Box box, centres;
    for (Index i = first; i < last; ++i) {
      const Item& item = items_[order_[i]];
      for (int k = 0; k < item.size(); ++k) box.add(item.corner(k));
      centres.add(centres_[order_[i]]);
    }
    nodes_[index].box = box;
    if (last - first <= leaf_size) {
      nodes_[index].left = first, nodes_[index].count = last - first;
      return index;
    }
    const Vec3 extent = centres.high - centres.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const Index middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](Index i, Index j) {
                       const double a = centres_[i][axis], b = centres_[j][axis];
                       return a != b ? a < b : i < j;
                     });
    const Index left = build(first, middle), right = build(middle, last);
    nodes_[index].left = left, nodes_[index].right = right;
    return index;
  }

  std::vector<Item> items_;
  std::vector<Index> order_;
  std::vector<Vec3> centres_;  // of the items, while building
  std::vector<Node> nodes_;
};

}  // namespace dm
