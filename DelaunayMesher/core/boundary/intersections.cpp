#include "boundary/intersections.h"

#include <algorithm>

#include "kernel/predicates.h"
#include "sizing/box_tree.h"

namespace dm {

namespace {

class Crossing {
 public:
  Crossing(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles)
      : points_(points), triangles_(triangles) {}

  bool operator()(Index i, Index j) const {
    const Triangle &s = triangles_[i], &t = triangles_[j];
    int shared = 0;
    for (const Index v : s) shared += std::find(t.begin(), t.end(), v) != t.end();
    return shared < 2 && (edges_cross(s, t) || edges_cross(t, s));
  }

 private:
  // Does an edge of s pass through t?  Edges that share a corner with t cannot cross it properly.
  bool edges_cross(const Triangle& s, const Triangle& t) const {
    const auto in_t = [&](Index v) { return std::find(t.begin(), t.end(), v) != t.end(); };
    for (int k = 0; k < 3; ++k) {
      const Index p = s[k], q = s[(k + 1) % 3];
      if (!in_t(p) && !in_t(q) && passes(points_[p], points_[q], t)) return true;
    }
    return false;
  }

  bool passes(const Vec3& p, const Vec3& q, const Triangle& t) const {
    const Vec3 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    if (orient3d(a, b, c, p) * orient3d(a, b, c, q) >= 0) return false;
    const int u = orient3d(p, q, a, b), v = orient3d(p, q, b, c), w = orient3d(p, q, c, a);
    return u != 0 && u == v && v == w;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
};

}  // namespace

std::vector<std::array<Index, 2>> find_intersections(const std::vector<Vec3>& points,
                                                     const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index v : triangles[t]) boxes[t].add(points[v]);
  const BoxTree tree(boxes);
  const Crossing crosses(points, triangles);
  std::vector<std::array<Index, 2>> pairs;
  std::vector<Index> stack;
  for (Index t = 0; t < static_cast<Index>(triangles.size()); ++t) {
    stack.assign(1, 0);
    while (!stack.empty()) {
      const BoxTree::Node& node = tree.nodes()[stack.back()];
      stack.pop_back();
      if (!node.box.overlaps(boxes[t])) continue;
      if (node.count == 0) {
        stack.push_back(node.first);
        stack.push_back(node.first + 1);
      }
      for (Index k = node.first; k < node.first + node.count; ++k) {
        const Index other = tree.order()[k];
        if (other > t && boxes[other].overlaps(boxes[t]) && crosses(t, other)) pairs.push_back({t, other});
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace dm
