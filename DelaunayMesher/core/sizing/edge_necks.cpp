#include "sizing/edge_necks.h"

#include <numbers>
#include <set>

#include "plc/nearest_tree.h"
#include "plc/segment_table.h"

namespace dm {

namespace {

constexpr double kDegrees = std::numbers::pi / 180;
constexpr double kAway = 15 * kDegrees;    // least angle between a way through the material and the faces
constexpr double kAcross = 0.5;            // cosine of the least angle between that way and the edge
constexpr double kReflex = 15 * kDegrees;  // least angle of the material over a straight one
constexpr int kDeepestSplit = 20;

double angle(const Vec3& a, const Vec3& b) { return std::acos(std::clamp(dot(a, b), -1.0, 1.0)); }

// A triangle at a segment.
struct Wing {
  Index triangle;
  Vec3 into;  // unit, square to the segment
};

// A segment of a CAD edge round which the material takes more than half of the turn.
class ReflexSegment : public SegmentItem {
 public:
  ReflexSegment(const Vec3& a, const Vec3& b, Index edge, const std::array<Wing, 2>& wings)
      : SegmentItem(a, b), edge_(edge), wings_(wings), along_(normalized(b - a)) {}

  Index edge() const { return edge_; }
  const std::array<Wing, 2>& wings() const { return wings_; }

  // Does the way w from the segment go through the material, and across the segment?
  bool leads_inside(const Vec3& w) const {
    const double along = dot(w, along_);
    if (std::abs(along) > kAcross * norm(w)) return false;
    const Vec3 u = normalized(w - along * along_);
    const double from = angle(u, wings_[0].into), to = angle(u, wings_[1].into);
    const bool between = from + to < angle(wings_[0].into, wings_[1].into) + kAway;
    return std::min(from, to) > kAway && !between;
  }

 private:
  Index edge_;
  std::array<Wing, 2> wings_;
  Vec3 along_;
};

using ReflexTree = NearestTree<ReflexSegment>;

// The triangles at each segment.
std::vector<std::vector<Wing>> find_wings(const Plc& plc) {
  std::vector<std::vector<Wing>> wings(plc.segments.size());
  const SegmentTable table(plc);
  for (std::size_t t = 0; t < plc.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const Triangle& v = plc.triangles[t];
      const Index s = table.find(v[i], v[(i + 1) % 3]);
      if (s < 0) continue;
      const Vec3 p = plc.points[v[i]], w = plc.points[v[(i + 2) % 3]] - p;
      const Vec3 axis = normalized(plc.points[v[(i + 1) % 3]] - p);
      wings[s].push_back({static_cast<Index>(t), normalized(w - dot(w, axis) * axis)});
    }
  return wings;
}

// Is there a solid on one side alone, and more than half a turn of it?
bool is_reflex(const Plc& plc, const Wing& v, const Wing& w) {
  const auto [behind, front] = plc.face_solids[plc.triangle_face[v.triangle]];
  if ((behind > 0) == (front > 0)) return false;
  const auto [a, b, c] = plc.triangles[v.triangle];
  const Vec3 normal = area_vector(plc.points[a], plc.points[b], plc.points[c]);
  const Vec3 outward = behind > 0 ? normal : -normal;
  return dot(outward, w.into) > 0 && angle(v.into, w.into) < std::numbers::pi - kReflex;
}

std::vector<ReflexSegment> find_reflex_segments(const Plc& plc) {
  std::vector<ReflexSegment> found;
  const auto wings = find_wings(plc);
  for (std::size_t s = 0; s < wings.size(); ++s) {
    if (wings[s].size() != 2 || !is_reflex(plc, wings[s][0], wings[s][1])) continue;
    const auto [a, b] = plc.segments[s];
    found.emplace_back(plc.points[a], plc.points[b], plc.segment_edge[s],
                       std::array<Wing, 2>{wings[s][0], wings[s][1]});
  }
  return found;
}

// The CAD vertices of each CAD edge.
std::vector<std::set<Index>> find_ends(const Plc& plc) {
  const std::set<Index> corners(plc.corners.begin(), plc.corners.end());
  std::vector<std::set<Index>> ends(plc.edge_count);
  for (std::size_t s = 0; s < plc.segments.size(); ++s)
    for (const Index p : plc.segments[s])
      if (corners.contains(p)) ends[plc.segment_edge[s]].insert(p);
  return ends;
}

class NeckFinder {
 public:
  NeckFinder(const Plc& plc, const std::vector<double>& triangle_size, double shortest)
      : plc_(plc),
        triangle_size_(triangle_size),
        shortest_(shortest),
        ends_(find_ends(plc)),
        tree_(find_reflex_segments(plc)) {}

  std::vector<EdgeNeck> find(Context& context) {
    for (Index i = 0; i < tree_.size(); ++i) {
      context.tick(1);
      visit(tree_.item(i), tree_.item(i).corner(0), tree_.item(i).corner(1), 0);
    }
    return std::move(necks_);
  }

 private:
  bool meet(Index e, Index f) const {
    return e == f ||
           std::any_of(ends_[e].begin(), ends_[e].end(), [&](Index p) { return ends_[f].contains(p); });
  }

  // Infinite: wider than the range.
  double width(const ReflexSegment& own, const Vec3& p, double range) const {
    const auto is_opposite = [&](const ReflexSegment& other) {
      if (meet(own.edge(), other.edge())) return false;
      const Vec3 way = other.nearest(p).point - p;
      return own.leads_inside(way) && other.leads_inside(-way);
    };
    const NearestPoint found = tree_.nearest(p, is_opposite, range * range);
    return found.item < 0 ? HUGE_VAL : std::sqrt(found.distance2);
  }

  void visit(const ReflexSegment& own, const Vec3& a, const Vec3& b, int depth) {
    const auto& [v, w] = own.wings();
    const double local = std::min(triangle_size_[v.triangle], triangle_size_[w.triangle]);
    const double length = norm(b - a);
    const Vec3 middle = 0.5 * (a + b);
    const double t = width(own, middle, local + 0.5 * length);
    const double enough = t == HUGE_VAL ? local : std::max(2 * t, shortest_);
    if (length > enough && depth < kDeepestSplit) {
      visit(own, a, middle, depth + 1);
      visit(own, middle, b, depth + 1);
    } else if (t < local) {
      necks_.push_back({a, b, plc_.triangle_face[v.triangle], t, local});
    }
  }

  const Plc& plc_;
  const std::vector<double>& triangle_size_;
  double shortest_;
  std::vector<std::set<Index>> ends_;
  ReflexTree tree_;
  std::vector<EdgeNeck> necks_;
};

}  // namespace

std::vector<EdgeNeck> find_edge_necks(const Plc& plc, const std::vector<double>& triangle_size,
                                      double shortest, Context& context) {
  return NeckFinder(plc, triangle_size, shortest).find(context);
}

}  // namespace dm
