// Triangulating a point set at once.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/failure.h"
#include "kernel/part_insertion.h"
#include "kernel/predicates.h"
#include "kernel/spatial_sort.h"
#include "kernel/triangulation.h"

namespace dm {
namespace {

constexpr Index kRoundGrowth = 8;          // spatial_sort.cpp: a round is so many times those before it
constexpr std::size_t kSlotsPerPoint = 7;  // uniform points need 6.8

Failure degenerate(const char* why, std::span<const Vec3> points) {
  return Failure("kernel", "degenerate_points", std::string("No tetrahedra: ") + why + ".",
                 points.empty() ? Vec3{} : points[0]);
}

// Positions in `order` of four points that are not coplanar, positively oriented.
std::array<Index, 4> first_tetrahedron(std::span<const Vec3> points, const std::vector<Index>& order) {
  const auto at = [&](Index i) -> const Vec3& { return points[order[i]]; };
  const Index n = static_cast<Index>(order.size());
  Index b = 1;
  while (b < n && at(b) == at(0)) ++b;
  if (b >= n) throw degenerate("there are fewer than two different points", points);
  Index c = b + 1;
  while (c < n && collinear(at(0), at(b), at(c))) ++c;
  if (c >= n) throw degenerate("all points lie on one line", points);
  for (Index d = c + 1; d < n; ++d) {
    const int sign = orient3d(at(0), at(b), at(c), at(d));
    if (sign > 0) return {0, b, c, d};
    if (sign < 0) return {b, 0, c, d};
  }
  throw degenerate("all points lie in one plane", points);
}

}  // namespace

// Vertices are numbered in insertion order while building, which keeps neighbours in space near each other in
// memory, and get the caller's numbers at the end.
class TriangulationBuilder {
 public:
  TriangulationBuilder(Triangulation& t, std::span<const Vec3> points) : t_(t), points_(points) {}

  void run(Context& context, Index parallel_from) {
    InsertionOrder order = insertion_order(points_);
    const auto first = first_tetrahedron(points_, order.order);
    t_.numbers_ = std::move(order.order);
    t_.points_.reserve(points_.size());
    for (const Index i : t_.numbers_) t_.points_.push_back(points_[i]);
    t_.vertex_tet_.assign(points_.size(), -1);
    start(first);
    const Index last_round = order.rounds.back() - order.rounds[order.rounds.size() - 2];
    const Index parts_from = last_round >= parallel_from ? parallel_from / kRoundGrowth : last_round + 1;
    PartInsertion parts(t_, order.codes, context, parts_from);
    for (std::size_t r = 0; r + 1 < order.rounds.size(); ++r)
      parts.insert_round(order.rounds[r], order.rounds[r + 1]);
    restore_numbers();
    t_.compact();
    t_.resize_slots(t_.slots_.next);
  }

 private:
  // Tetrahedron 0 = the first four vertices, and its four ghosts.
  void start(const Tet& first) {
    // Room for uniform points at once: pages not touched cost nothing, but moving a grown array does.
    t_.resize_slots(std::min(kSlotsPerPoint * points_.size() + 64, Triangulation::kMostSlots));
    t_.slots_.next = 5;
    t_.corners_[0] = first;
    for (int i = 0; i < 5; ++i) t_.tags_[i] = 0, t_.flags_[i] = 0;
    for (int i = 0; i < 4; ++i) {
      const auto& f = kFaceCorners[i];
      t_.corners_[i + 1] = {first[f[0]], first[f[2]], first[f[1]], Triangulation::ghost};
      t_.neighbours_[0][i] = 4 * (i + 1) + 3;
      t_.neighbours_[i + 1][3] = i;
      t_.vertex_tet_[first[i]] = 0;
    }
    for (int i = 0; i < 4; ++i) {  // the ghosts of faces i and j share the edge without corners i and j
      const std::array<int, 3> mine = {kFaceCorners[i][0], kFaceCorners[i][2], kFaceCorners[i][1]};
      for (int k = 0; k < 3; ++k) {
        const auto& f = kFaceCorners[mine[k]];
        const int back = f[0] == i ? 0 : f[2] == i ? 1 : 2;
        t_.neighbours_[i + 1][k] = 4 * (mine[k] + 1) + back;
      }
    }
  }

  void restore_numbers() {
    std::vector<Index> vertex_tet(t_.vertex_tet_.size(), -1);
    for (Index v = 0; v < t_.vertex_count(); ++v) vertex_tet[t_.numbers_[v]] = t_.vertex_tet_[v];
    t_.vertex_tet_.swap(vertex_tet);
    t_.points_.assign(points_.begin(), points_.end());
    for (Index tet = 0; tet < t_.slot_count(); ++tet)
      for (Index& v : t_.corners_[tet])
        if (v >= 0) v = t_.numbers_[v];
    t_.numbers_ = {};
  }

  Triangulation& t_;
  std::span<const Vec3> points_;
};

Triangulation::Triangulation(std::span<const Vec3> points, Context& context, Index parallel_from) {
  for (const Vec3& p : points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Failure("kernel", "not_finite", "A point has a coordinate that is not a number or infinite.", p);
  TriangulationBuilder(*this, points).run(context, parallel_from);
}

Triangulation::Triangulation(std::span<const Vec3> points) {
  Context context;
  *this = Triangulation(points, context);
}

void Triangulation::move_slot(Index from, Index to) {
  corners_[to] = corners_[from];
  neighbours_[to] = neighbours_[from];
  tags_[to] = tags_[from];
  flags_[to] = flags_[from];
  for (int i = 0; i < 4; ++i) {
    const Face face = neighbours_[to][i];
    neighbours_[face >> 2][face & 3] = 4 * to + i;
    const Index v = corners_[to][i];
    if (v >= 0 && vertex_tet_[v] == from) vertex_tet_[v] = to;
  }
  corners_[from].fill(free_slot);
}

// Fills the free slots with the last tetrahedra.
void Triangulation::compact() {
  std::sort(slots_.free.begin(), slots_.free.end());
  for (const Index hole : slots_.free) {
    while (slots_.next > 0 && is_free(slots_.next - 1)) --slots_.next;
    if (hole >= slots_.next) break;
    move_slot(--slots_.next, hole);
  }
  while (slots_.next > 0 && is_free(slots_.next - 1)) --slots_.next;
  slots_.free = {};
}

}  // namespace dm
