// Triangulating a point set at once.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/failure.h"
#include "kernel/predicates.h"
#include "kernel/spatial_sort.h"
#include "kernel/triangulation.h"

namespace dm {

// Vertices are numbered in insertion order while building, which keeps neighbours in space near each other in
// memory, and get the caller's numbers at the end.
class TriangulationBuilder {
 public:
  TriangulationBuilder(Triangulation& t, std::span<const Vec3> points) : t_(t), points_(points) {}

  void run() {
    InsertionOrder order = insertion_order(points_);
    const auto first = first_tetrahedron(order.order);
    bring_to_front(order.order, first);
    t_.numbers_ = std::move(order.order);
    t_.points_.reserve(points_.size());
    for (const Index i : t_.numbers_) t_.points_.push_back(points_[i]);
    t_.vertex_tet_.assign(points_.size() + 1, -1);
    start();
    Index hint = 0;
    Cavity cavity;
    for (Index v = 4; v < t_.vertex_count(); ++v) hint = add(v, hint, cavity);
    restore_numbers();
  }

 private:
  // Positions in `order` of four points that are not coplanar, positively oriented.
  std::array<Index, 4> first_tetrahedron(const std::vector<Index>& order) const {
    const auto at = [&](Index i) -> const Vec3& { return points_[order[i]]; };
    const Index n = static_cast<Index>(order.size());
    Index b = 1;
    while (b < n && at(b) == at(0)) ++b;
    if (b >= n) throw degenerate("all points are the same or there is none");
    Index c = b + 1;
    while (c < n && collinear(at(0), at(b), at(c))) ++c;
    if (c >= n) throw degenerate("all points lie on one line");
    for (Index d = c + 1; d < n; ++d) {
      const int sign = orient3d(at(0), at(b), at(c), at(d));
      if (sign > 0) return {0, b, c, d};
      if (sign < 0) return {b, 0, c, d};
    }
    throw degenerate("all points lie in one plane");
  }
  Failure degenerate(const char* why) const {
    return Failure("kernel", "degenerate_points", std::string("No tetrahedra: ") + why + ".",
                   points_.empty() ? Vec3{} : points_[0]);
  }
  static void bring_to_front(std::vector<Index>& order, std::array<Index, 4> first) {
    const std::array<Index, 4> value = {order[first[0]], order[first[1]], order[first[2]], order[first[3]]};
    std::sort(first.begin(), first.end());
    for (int i = 3; i >= 0; --i) order.erase(order.begin() + first[i]);
    order.insert(order.begin(), value.begin(), value.end());
  }

  // Tetrahedron 0 = vertices 0..3 and its four ghosts.
  void start() {
    t_.reserve_slots(7 * points_.size() + 64);
    t_.slots_.next = 5;
    t_.corners_[0] = {0, 1, 2, 3};
    for (int i = 0; i < 4; ++i) {
      const auto& f = kFaceCorners[i];
      t_.corners_[i + 1] = {f[0], f[2], f[1], Triangulation::ghost};
    }
    for (int i = 0; i < 5; ++i) t_.tags_[i] = 0, t_.flags_[i] = 0;
    for (int i = 0; i < 4; ++i) {
      t_.neighbours_[0][i] = 4 * (i + 1) + 3;
      t_.neighbours_[i + 1][3] = i;
      for (int j = 0; j < 3; ++j) {  // across from corner j of ghost i lies the ghost of the face opposite j
        const Index other = t_.corners_[i + 1][j];
        for (int k = 0; k < 3; ++k)
          if (t_.corners_[other + 1][k] == i) t_.neighbours_[i + 1][j] = 4 * (other + 1) + k;
      }
      t_.vertex_tet_[i + 1] = 0;
    }
    t_.vertex_tet_[0] = 1;
  }

  Index add(Index vertex, Index hint, Cavity& cavity) {
    const Vec3& p = t_.points_[vertex];
    const Index number = t_.numbers_[vertex];
    const Index start = t_.walk(p, hint);
    if (start < 0) return hint;
    t_.search<false>(p, number, start, cavity);
    t_.reserve_slots(cavity.border.size());
    t_.fill(vertex, cavity, t_.slots_);
    return cavity.created[0];
  }

  void restore_numbers() {
    std::vector<Index> vertex_tet(t_.vertex_tet_.size(), -1);
    vertex_tet[0] = t_.vertex_tet_[0];
    for (Index v = 0; v < t_.vertex_count(); ++v) vertex_tet[t_.numbers_[v] + 1] = t_.vertex_tet_[v + 1];
    t_.vertex_tet_.swap(vertex_tet);
    t_.points_.assign(points_.begin(), points_.end());
    for (Index tet = 0; tet < t_.slot_count(); ++tet)
      for (Index& v : t_.corners_[tet])
        if (v >= 0) v = t_.numbers_[v];
    t_.numbers_ = {};
    t_.resize_slots(t_.slots_.next);
  }

  Triangulation& t_;
  std::span<const Vec3> points_;
};

Triangulation::Triangulation(std::span<const Vec3> points, [[maybe_unused]] int threads) {
  for (const Vec3& p : points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Failure("kernel", "not_finite", "A point has a coordinate that is not a number or infinite.", p);
  TriangulationBuilder(*this, points).run();
}

}  // namespace dm
