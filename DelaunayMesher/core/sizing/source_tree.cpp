#include "sizing/source_tree.h"

namespace dm {

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double l2 = norm2(d);
  if (!(l2 > 0)) return a;
  return a + std::clamp(dot(p - a, d) / l2, 0.0, 1.0) * d;
}

// Ericson, Real-Time Collision Detection (2005), 5.1.5: by the Voronoi regions of corners, edges, inside.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 > d3 ? a + (d1 / (d1 - d3)) * ab : a;
  const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 > d6 ? a + (d2 / (d2 - d6)) * ac : a;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double l = (d4 - d3) + (d5 - d6);
    return l > 0 ? b + ((d4 - d3) / l) * (c - b) : b;
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

Vec3 SizeSource::nearest(const Vec3& p) const {
  if (corners == 1) return a;
  return corners == 2 ? nearest_on_segment(p, a, b) : nearest_on_triangle(p, a, b, c);
}

SourceTree::SourceTree(std::vector<SizeSource> sources, double growth) : growth_(growth) {
  std::vector<Box> boxes(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const SizeSource& s = sources[i];
    boxes[i].add(s.a);
    boxes[i].add(s.b);
    boxes[i].add(s.c);
    smallest_ = std::min(smallest_, s.size);
  }
  tree_ = BoxTree(boxes);
  sources_.reserve(sources.size());
  for (const Index i : tree_.order()) sources_.push_back(sources[i]);
  const auto& nodes = tree_.nodes();
  node_size_.resize(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    NodeSize& node = node_size_[i];
    if (nodes[i].count == 0) {
      const NodeSize &left = node_size_[nodes[i].first], &right = node_size_[nodes[i].first + 1];
      node = right.size < left.size ? right : left;
    }
    for (Index k = nodes[i].first; k < nodes[i].first + nodes[i].count; ++k)
      if (sources_[k].size < node.size) node.size = sources_[k].size, node.source = k;
    node.reach = growth * norm(nodes[i].box.extent());
  }
}

double SourceTree::at(const Vec3& p, double bound, Index& hint) const {
  if (tree_.empty()) return bound;
  // Where many sources tie (the middle of a ball) an exact answer would have to visit them all: a node is
  // left out unless it may be 3 % better, and a node this small is represented by one of its sources.
  constexpr double kSlack = 0.03;
  double best = bound;
  Index winner = -1;
  const auto ask = [&](Index k) {
    const SizeSource& s = sources_[k];
    if (s.size >= best) return;
    const double h = s.size + growth_ * distance(p, s.nearest(p));
    if (h < best) best = h, winner = k;
  };
  const auto lower_bound = [&](Index node) {
    return node_size_[node].size + growth_ * std::sqrt(tree_.nodes()[node].box.distance2(p));
  };
  if (hint >= 0) ask(hint);
  struct Entry {
    Index node;
    double bound;
  } stack[128];
  int top = 0;
  stack[top++] = {0, lower_bound(0)};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.bound >= (1 - kSlack) * best) continue;
    if (node_size_[entry.node].reach <= kSlack * entry.bound) {
      ask(node_size_[entry.node].source);
      continue;
    }
    const BoxTree::Node& node = tree_.nodes()[entry.node];
    for (Index k = 0; k < node.count; ++k) ask(node.first + k);
    if (node.count > 0) continue;
    Entry near{node.first, lower_bound(node.first)}, far{node.first + 1, lower_bound(node.first + 1)};
    if (far.bound < near.bound) std::swap(near, far);
    stack[top++] = far;
    stack[top++] = near;
  }
  hint = winner;
  return best;
}

}  // namespace dm
