// Sources of the size field with extent, and the exact field that they ask for:
// h(x) = min over sources of (size + growth * distance to the source).
//
// Branch and bound in a box tree whose nodes know their smallest size.  Cost of one query: about a
// microsecond with 100,000 sources, less with a good starting bound.
#pragma once

#include <vector>

#include "sizing/box_tree.h"

namespace dm {

// A point, segment or triangle, all of which has the same size.
struct SizeSource {
  Vec3 a, b, c;
  double size = 0;
  int corners = 3;          // 1: a | 2: a, b | 3: a, b, c
  bool on_boundary = true;  // lies on the PLC

  static SizeSource point(const Vec3& p, double size) { return {p, p, p, size, 1, true}; }
  static SizeSource segment(const Vec3& p, const Vec3& q, double size) { return {p, q, q, size, 2, true}; }
  Vec3 nearest(const Vec3& p) const;
};

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

class SourceTree {
 public:
  SourceTree() = default;
  SourceTree(std::vector<SizeSource> sources, double growth);

  const SizeSource& source(Index i) const { return sources_[i]; }
  double smallest() const { return smallest_; }
  // The smaller of `bound` and the field at p (at most 3 % above it).  `hint` is a source likely to be the
  // winner (-1: none) and becomes the winner's index, or -1 if no source is below the bound.
  double at(const Vec3& p, double bound, Index& hint) const;

  // Does a source dip below an interpolant in `box`?  test(q, h) is asked for places q in the box where a
  // source of lower bound < limit comes near, h being an upper bound of the field there; true ends the
  // search.
  template <class Test>
  bool any_near(const Box& box, double limit, Test&& test) const;

 private:
  std::vector<SizeSource> sources_;  // in the order of the tree's leaves
  BoxTree tree_;
  struct NodeSize {
    double size = HUGE_VAL;  // smallest in the node
    double reach = 0;        // growth over the diagonal of its box
    Index source = -1;       // one with that size
  };
  std::vector<NodeSize> node_size_;
  double growth_ = 0, smallest_ = HUGE_VAL;
};

template <class Test>
bool SourceTree::any_near(const Box& box, double limit, Test&& test) const {
  if (tree_.empty()) return false;
  const Vec3 centre = box.centre();
  Index stack[128], top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Index index = stack[--top];
    const BoxTree::Node& node = tree_.nodes()[index];
    if (node_size_[index].size >= limit || !node.box.overlaps(box)) continue;
    if (node.count == 0) {
      stack[top++] = node.first + 1;
      stack[top++] = node.first;
      continue;
    }
    for (Index k = node.first; k < node.first + node.count; ++k) {
      const SizeSource& source = sources_[k];
      if (source.size >= limit) continue;
      if (test(source.nearest(centre), source.size)) return true;
    }
  }
  return false;
}

}  // namespace dm
