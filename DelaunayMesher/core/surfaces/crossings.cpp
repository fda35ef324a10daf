#include "surfaces/crossings.h"

#include <algorithm>

#include "base/box_tree.h"

namespace dm {
namespace {

constexpr double kRounding = 1e-14;  // of an orientation, over the product of the lengths in it

class CrossingSearch {
 public:
  CrossingSearch(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles, Context& context,
                 std::size_t most)
      : points_(points),
        triangles_(triangles),
        context_(context),
        most_(most),
        boxes_(triangles.size()),
        normals_(triangles.size()) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Triangle& v = triangles[t];
      for (const Index p : v) boxes_[t].add(points[p]);
      normals_[t] = area_vector(points[v[0]], points[v[1]], points[v[2]]);
    }
  }

  std::vector<std::array<Index, 2>> run() {
    const BoxTree tree(boxes_);
    if (tree.empty()) return {};
    std::vector<std::array<Index, 2>> stack{{0, 0}};
    while (!stack.empty() && pairs_.size() < most_) {
      context_.tick(0);
      const auto [i, j] = stack.back();
      stack.pop_back();
      const BoxTree::Node &a = tree.nodes()[i], &b = tree.nodes()[j];
      if (i != j && !a.box.overlaps(b.box)) continue;
      if (a.count > 0 && b.count > 0) {
        test_leaves(tree, a, b, i == j);
      } else if (i == j) {
        stack.insert(stack.end(), {{a.first, a.first}, {a.first, a.first + 1}, {a.first + 1, a.first + 1}});
      } else if (b.count > 0 || (a.count == 0 && norm2(a.box.extent()) > norm2(b.box.extent()))) {
        stack.insert(stack.end(), {{a.first, j}, {a.first + 1, j}});
      } else {
        stack.insert(stack.end(), {{i, b.first}, {i, b.first + 1}});
      }
    }
    std::sort(pairs_.begin(), pairs_.end());
    return std::move(pairs_);
  }

 private:
  void test_leaves(const BoxTree& tree, const BoxTree::Node& a, const BoxTree::Node& b, bool same) {
    for (Index k = a.first; k < a.first + a.count; ++k)
      for (Index l = same ? k + 1 : b.first; l < b.first + b.count; ++l) {
        const Index s = tree.order()[k], t = tree.order()[l];
        if (boxes_[s].overlaps(boxes_[t]) && cross_each_other(s, t))
          pairs_.push_back({std::min(s, t), std::max(s, t)});
      }
  }

  enum class Position { one_side, in_plane, both_sides };

  // Sides of s's corners of t's plane; corners that they share lie in it.
  Position sides_of_plane(Index s, Index t, int* sides) const {
    const Vec3 &origin = points_[triangles_[t][0]], &n = normals_[t];
    const double bound = kRounding * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    bool above = false, below = false;
    for (int i = 0; i < 3; ++i) {
      const Index v = triangles_[s][i];
      sides[i] = 0;
      if (is_corner(v, t)) continue;
      const Vec3 d = points_[v] - origin;
      const double height = dot(n, d), limit = bound * (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
      sides[i] = height > limit ? 1 : height < -limit ? -1 : 0;
      above |= sides[i] > 0;
      below |= sides[i] < 0;
    }
    if (above && below) return Position::both_sides;
    return above || below ? Position::one_side : Position::in_plane;
  }

  bool is_corner(Index v, Index t) const {
    return triangles_[t][0] == v || triangles_[t][1] == v || triangles_[t][2] == v;
  }

  // Each must have corners on both sides of the other's plane, or overlap it in their common plane.
  bool cross_each_other(Index s, Index t) const {
    int shared = 0;
    for (const Index v : triangles_[s]) shared += is_corner(v, t);
    if (shared >= 2) return false;
    int of_s[3], of_t[3];
    const Position position = sides_of_plane(s, t, of_s);
    if (position == Position::in_plane) return norm2(normals_[t]) > 0 && overlap_in_plane(s, t);
    if (position == Position::one_side || sides_of_plane(t, s, of_t) != Position::both_sides) return false;
    return edge_passes(s, of_s, t) || edge_passes(t, of_t, s);
  }

  // In a common plane: they overlap unless the line of an edge has them on different sides.
  bool overlap_in_plane(Index s, Index t) const {
    return norm2(normals_[s]) > 0 && !edge_separates(s, t) && !edge_separates(t, s);
  }

  // Are all corners of t on or beyond the line of an edge of s, seen from s?
  bool edge_separates(Index s, Index t) const {
    for (int i = 0; i < 3; ++i) {
      const Vec3 &a = points_[triangles_[s][i]], e = points_[triangles_[s][(i + 1) % 3]] - a;
      const Vec3 inwards = cross(normals_[s], e);
      int inside = 0;
      for (const Index v : triangles_[t]) {
        const Vec3 d = points_[v] - a;
        inside += dot(inwards, d) > kRounding * std::sqrt(norm2(inwards) * norm2(d));
      }
      if (inside == 0) return true;
    }
    return false;
  }

  // Does an edge of s, with its corners on the given sides of t's plane, pass through t?
  bool edge_passes(Index s, const int* sides, Index t) const {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (sides[i] * sides[j] >= 0) continue;
      const Vec3 &p = points_[triangles_[s][i]], d = points_[triangles_[s][j]] - p;
      int inside = 0;
      for (int k = 0; k < 3; ++k)
        inside += side_of_line(p, d, points_[triangles_[t][k]], points_[triangles_[t][(k + 1) % 3]]);
      if (inside == 3 || inside == -3) return true;
    }
    return false;
  }

  static int side_of_line(const Vec3& p, const Vec3& d, const Vec3& a, const Vec3& b) {
    const Vec3 u = a - p, v = b - p;
    const double volume = dot(d, cross(u, v));
    const double bound = kRounding * std::sqrt(norm2(d) * norm2(u) * norm2(v));
    return volume > bound ? 1 : volume < -bound ? -1 : 0;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
  Context& context_;
  const std::size_t most_;
  std::vector<Box> boxes_;
  std::vector<Vec3> normals_;
  std::vector<std::array<Index, 2>> pairs_;
};

}  // namespace

std::vector<std::array<Index, 2>> find_crossings(const std::vector<Vec3>& points,
                                                 const std::vector<Triangle>& triangles, Context& context,
                                                 std::size_t most) {
  return CrossingSearch(points, triangles, context, most).run();
}

}  // namespace dm
