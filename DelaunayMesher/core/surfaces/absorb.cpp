#include "surfaces/absorb.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_set>

#include "base/box_tree.h"
#include "surfaces/crossings.h"

namespace dm {
namespace {

constexpr double kAbsorbed = 1.0 / 50;  // width over the size given there
constexpr double kWidest = 2.5;         // extent of the points that become one, over the tolerance
constexpr double kTurned = 0.3;         // cosine between a triangle's normals before and after
constexpr double kFlat = 0.001;         // height of a triangle that has become flat, over the tolerance
constexpr int kMostFlips = 8;           // per triangle that would turn over
constexpr double kFollow = 0.05;        // distance of a point that is taken along, over the tolerance
constexpr double kAcute = 0.5;          // angle between faces that may come to meet, radians
constexpr double kNarrowed = 0.7;       // that of faces that met before, over what it was
constexpr double kInnocent = 0.2;       // width of what has no part in a fault, over the widest that has

// Points that become one, with the box round them.
class Clusters {
 public:
  explicit Clusters(const std::vector<Vec3>& points) : parent_(points.size()), box_(points.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t p = 0; p < points.size(); ++p) box_[p].add(points[p]);
  }
  Index find(Index p) {
    while (parent_[p] != p) p = parent_[p] = parent_[parent_[p]];
    return p;
  }
  bool is_joined(Index p) { return norm2(box_[find(p)].extent()) > 0; }
  // False, and nothing done, if the joined points would extend over more than `widest`.
  bool join(Index p, Index q, double widest) {
    p = find(p);
    q = find(q);
    if (p == q) return true;
    Box both = box_[p];
    both.add(box_[q]);
    if (norm(both.extent()) > widest) return false;
    parent_[std::max(p, q)] = std::min(p, q);
    box_[std::min(p, q)] = both;
    return true;
  }

 private:
  std::vector<Index> parent_;
  std::vector<Box> box_;
};

class Absorber {
 public:
  Absorber(const Plc& plc, const Geometry& geometry, const Tolerance& tolerance, Context& context)
      : given_(plc),
        plc_(plc),
        tolerance_(tolerance),
        context_(context),
        features_(find_small_features(plc_, geometry, tolerance)) {}

  Plc run(Absorbed& absorbed) {
    if (features_.empty()) return given_;
    active_.assign(features_.size(), 1);
    for (const SmallFeature& feature : features_) width_.push_back(width_of(feature, plc_.points));
    rank_points();
    find_beside();
    std::size_t followed = 0;
    do {
      followed = followers_.size();
      if (std::find(active_.begin(), active_.end(), 1) == active_.end()) return given_;
      join_points();
      make_triangles();
      turn_back();
      faults_.clear();
      check_normals();
      check_edges();
      if (faults_.empty() && refused_.empty()) check_crossings();
    } while (followers_.size() > followed || reject());  // nothing is rejected before more have followed
    Plc result = make_plc();
    try {
      check_plc(result, context_);
    } catch (const Failure&) {
      return given_;  // a body smaller than the tolerance, say
    }
    report(result, absorbed);
    return result;
  }

 private:
  // The point that stays of those that become one: a CAD vertex, else that on the first edge.
  void rank_points() {
    rank_.assign(plc_.points.size(), plc_.edge_count + plc_.vertex_count);
    for (std::size_t s = 0; s < plc_.segments.size(); ++s)
      for (const Index p : plc_.segments[s])
        rank_[p] = std::min(rank_[p], plc_.vertex_count + plc_.segment_edge[s]);
    for (std::size_t c = 0; c < plc_.corners.size(); ++c)
      rank_[plc_.corners[c]] = std::min(rank_[plc_.corners[c]], plc_.corner_vertex[c]);
  }

  void find_beside() {
    beside_.assign(plc_.points.size(), -1);
    const auto inside = [&](Index p) { return rank_[p] == plc_.edge_count + plc_.vertex_count; };
    for (const auto& [a, b, c] : plc_.triangles)
      for (const auto& [p, q] : {Segment{a, b}, {b, c}, {c, a}, {b, a}, {c, b}, {a, c}})
        if (inside(p) && !inside(q) && (beside_[p] < 0 || is_nearer(p, q, beside_[p]))) beside_[p] = q;
  }
  bool is_nearer(Index p, Index q, Index other) const {
    return distance(plc_.points[p], plc_.points[q]) < distance(plc_.points[p], plc_.points[other]);
  }

  // In rows of points closer to each other than the tolerance those come together that are next to each
  // other; where a point would be left alone by that, all of it stays.
  void join_points() {
    refused_.clear();
    Clusters clusters(plc_.points);
    std::vector<std::pair<Index, Index>> skipped;  // feature, point
    for (std::size_t k = 0; k < features_.size(); ++k)
      for (const auto& [p, q] : features_[k]) {
        if (!active_[k]) break;
        if (clusters.join(p, q, kWidest * tolerance_(plc_.points[p]))) continue;
        for (const Index alone : {p, q}) skipped.emplace_back(static_cast<Index>(k), alone);
      }
    for (const auto& [p, q] : followers_)
      if (clusters.is_joined(q)) clusters.join(p, q, kWidest * tolerance_(plc_.points[p]));
    for (const auto& [k, p] : skipped)
      if (!clusters.is_joined(p) && (refused_.empty() || refused_.back() != k)) refused_.push_back(k);
    const Index n = static_cast<Index>(plc_.points.size());
    std::vector<Index> best(n, -1);
    for (Index p = 0; p < n; ++p) {
      Index& b = best[clusters.find(p)];
      if (b < 0 || rank_[p] < rank_[b]) b = p;
    }
    to_.resize(n);
    joined_.assign(n, 0);
    for (Index p = 0; p < n; ++p) {
      to_[p] = best[clusters.find(p)];
      if (to_[p] != p) joined_[p] = joined_[to_[p]] = 1;
    }
  }

  void make_triangles() {
    triangles_.clear();
    source_.clear();
    before_.clear();
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t) {
      const auto [a, b, c] = plc_.triangles[t];
      const Triangle v{to_[a], to_[b], to_[c]};
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
      triangles_.push_back(v);
      source_.push_back(static_cast<Index>(t));
      before_.push_back(normal(plc_.triangles[t]));
    }
    segments_.clear();
    for (const auto& [a, b] : plc_.segments)
      if (to_[a] != to_[b]) segments_.push_back(std::minmax(to_[a], to_[b]));
    std::sort(segments_.begin(), segments_.end());
  }
  bool is_segment(Index a, Index b) const {
    return std::binary_search(segments_.begin(), segments_.end(), std::pair<Index, Index>(std::minmax(a, b)));
  }

  // Triangles beside what is absorbed that would turn over are flipped away, where that is possible.
  void turn_back() {
    std::vector<std::size_t> stack;
    std::vector<char> concerned(plc_.face_solids.size(), 0);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (moved(t) && is_turned(triangles_[t], before_[t])) {
        stack.push_back(t);
        concerned[face(t)] = 1;
      }
    if (stack.empty()) return;
    collect_sides();
    half_.clear();
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int i = 0; concerned[face(t)] && i < 3; ++i) half_[{face(t), side(t, i)}] = t;
    std::vector<std::size_t> stuck;  // until something beside them is flipped
    for (std::size_t steps = kMostFlips * stack.size(); !stack.empty() && steps > 0; --steps) {
      const std::size_t t = stack.back();
      stack.pop_back();
      if (!is_turned(triangles_[t], before_[t])) continue;
      if (flip_away(t)) {
        stack.insert(stack.end(), stuck.begin(), stuck.end());
        stuck.clear();
      } else {
        stuck.push_back(t);
      }
    }
  }

  // Flips a side of the triangle so that neither new one is turned over; false if there is none.
  bool flip_away(std::size_t t) {
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = side(t, i);
      const auto beside = half_.find({face(t), {b, a}});
      if (beside == half_.end() || is_segment(a, b)) continue;
      const std::size_t s = beside->second;
      const Index c = apex(a, b, triangles_[t]), d = apex(a, b, triangles_[s]);
      const Triangle one{c, a, d}, other{d, b, c};
      const Vec3 n = before_[s] + before_[t];
      if (c == d || sides_.contains(undirected(c, d))) continue;  // of another face, maybe
      if (is_turned(one, n) || is_turned(other, n)) continue;
      half_.erase({face(t), {a, b}});
      half_.erase(beside);
      sides_.erase(undirected(a, b));
      sides_.insert(undirected(c, d));
      triangles_[t] = one;
      triangles_[s] = other;
      before_[t] = before_[s] = n;
      for (const std::size_t u : {t, s})
        for (int j = 0; j < 3; ++j) half_[{face(t), side(u, j)}] = u;
      return true;
    }
    return false;
  }

  void collect_sides() {
    sides_.clear();
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int i = 0; i < 3; ++i) sides_.insert(undirected(side(t, i)[0], side(t, i)[1]));
  }
  static std::uint64_t undirected(Index a, Index b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
  }

  Segment side(std::size_t t, int i) const { return {triangles_[t][i], triangles_[t][(i + 1) % 3]}; }
  static Index apex(Index a, Index b, const Triangle& v) {
    for (const Index p : v)
      if (p != a && p != b) return p;
    return a;
  }
  // Or as good as flat, as the last triangle of a face that is all but absorbed.
  bool is_turned(const Triangle& v, const Vec3& before) const {
    const Vec3 after = normal(v);
    const double size = norm(after), size_before = norm(before);
    if (dot(before, after) < kTurned * size_before * size) return true;
    double longest2 = 0;
    for (int i = 0; i < 3; ++i)
      longest2 = std::max(longest2, norm2(plc_.points[v[i]] - plc_.points[v[(i + 1) % 3]]));
    const double flat = kFlat * tolerance_(plc_.points[v[0]]) * std::sqrt(longest2);
    return size <= std::min(flat, 0.1 * size_before);
  }

  bool moved(std::size_t t) const { return triangles_[t] != plc_.triangles[source_[t]]; }
  Index face(std::size_t t) const { return plc_.triangle_face[source_[t]]; }
  void blame(std::initializer_list<std::size_t> triangles) {
    faults_.emplace_back();
    for (const std::size_t t : triangles)
      for (const Index p : triangles_[t])
        if (joined_[p]) faults_.back().push_back(p);
  }

  Vec3 normal(const Triangle& v) const {
    return area_vector(plc_.points[v[0]], plc_.points[v[1]], plc_.points[v[2]]);
  }

  void check_normals() {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (moved(t) && is_turned(triangles_[t], before_[t]) && !takes_along(t)) blame({t});
  }

  // A point of the tessellation inside a face beside one of a curve that was joined, so near that a triangle
  // has turned over, joins, too.  False if it has been tried before, or there is none.
  bool takes_along(std::size_t t) {
    for (const Index p : triangles_[t]) {
      const Index q = beside_[p];
      if (q < 0 || joined_[p] || !joined_[q] || followers_.contains(p)) continue;
      if (distance(plc_.points[p], plc_.points[q]) > kFollow * tolerance_(plc_.points[p])) continue;
      followers_[p] = q;
      return true;
    }
    return false;
  }

  struct Side {
    Index a, b;  // a < b
    std::size_t triangle;
    bool forward;
  };

  // Edges with an end that is new: on a segment no two faces may meet at an acute angle that did not before;
  // elsewhere two triangles of one face meet, run through both ways.
  void check_edges() {
    std::vector<Side> sides;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Index a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
        if (joined_[a] || joined_[b]) sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
      }
    std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
      return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
    });
    for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
      while (j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b) ++j;
      const bool segment = is_segment(sides[i].a, sides[i].b);
      const bool smooth = j - i == 2 && face(sides[i].triangle) == face(sides[i + 1].triangle) &&
                          sides[i].forward != sides[i + 1].forward;
      if (!segment && !smooth) blame({sides[i].triangle});
      for (std::size_t k = i; k < j; ++k)
        for (std::size_t l = k + 1; l < j; ++l)
          check_pair(sides[i].a, sides[i].b, sides[k].triangle, sides[l].triangle);
    }
  }

  void check_pair(Index a, Index b, std::size_t s, std::size_t t) {
    const double angle = angle_between(a, b, triangles_[s], triangles_[t]);
    if (angle >= kAcute) return;
    std::vector<Index> shared;  // of the triangles as they were
    for (const Index p : plc_.triangles[source_[s]])
      for (const Index q : plc_.triangles[source_[t]])
        if (p == q) shared.push_back(p);
    const bool was_acute = shared.size() == 2 &&
                           angle > kNarrowed * angle_between(shared[0], shared[1], plc_.triangles[source_[s]],
                                                             plc_.triangles[source_[t]]);
    if (!was_acute) blame({s, t});
  }

  // In radians, on both sides of the edge (a, b).
  double angle_between(Index a, Index b, const Triangle& one, const Triangle& other) const {
    const Vec3 u = across(a, b, one), v = across(a, b, other);
    return std::atan2(norm(cross(u, v)), dot(u, v));
  }

  // From the edge (a, b) of a triangle to its third corner, at a right angle to the edge.
  Vec3 across(Index a, Index b, const Triangle& v) const {
    const Vec3 along = plc_.points[b] - plc_.points[a], d = plc_.points[apex(a, b, v)] - plc_.points[a];
    return d - (dot(d, along) / norm2(along)) * along;
  }

  void check_crossings() {
    std::vector<std::array<Index, 2>> before;
    bool looked = false;
    for (const auto& [s, t] : find_crossings(plc_.points, triangles_, context_)) {
      if (!moved(s) && !moved(t)) continue;
      if (!looked) before = find_crossings(plc_.points, plc_.triangles, context_);
      looked = true;
      const std::array<Index, 2> pair{std::min(source_[s], source_[t]), std::max(source_[s], source_[t])};
      if (std::binary_search(before.begin(), before.end(), pair)) continue;
      blame({static_cast<std::size_t>(s), static_cast<std::size_t>(t)});
    }
  }

  // Features with a part in a fault stay, but for those far narrower than others of it: they hardly move
  // anything.  True if there are any.
  bool reject() {
    bool changed = !refused_.empty();
    for (const Index k : refused_) active_[k] = 0;
    std::vector<double> widest(plc_.points.size(), 0);  // by point that stays: of the features that joined it
    for_active(
        [&](std::size_t, Index point, double width) { widest[point] = std::max(widest[point], width); });
    std::vector<double> limit(plc_.points.size(), HUGE_VAL);  // features of this width stay
    for (const std::vector<Index>& fault : faults_) {
      double most = 0;
      for (const Index p : fault) most = std::max(most, widest[p]);
      for (const Index p : fault) limit[p] = std::min(limit[p], kInnocent * most);
    }
    for_active([&](std::size_t k, Index point, double width) {
      if (width < limit[point]) return;
      active_[k] = 0;
      changed = true;
    });
    return changed;
  }

  // Calls `visit` with each active feature and each point that it has joined.
  template <class Visit>
  void for_active(Visit visit) {
    for (std::size_t k = 0; k < features_.size(); ++k)
      for (const auto& [p, q] : features_[k])
        if (active_[k]) visit(k, to_[p], width_[k]);
  }

  Plc make_plc() const {
    Plc result = plc_;
    result.triangles = triangles_;
    std::vector<char> used(plc_.points.size(), 0);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      result.triangle_face[t] = face(t);
      for (const Index p : triangles_[t]) used[p] = 1;
    }
    result.triangle_face.resize(triangles_.size());
    keep_segments(result);
    result.corners.clear();
    result.corner_vertex.clear();
    for (std::size_t c = 0; c < plc_.corners.size(); ++c) {
      const Index p = plc_.corners[c];
      if (to_[p] != p || !used[p]) continue;
      result.corners.push_back(p);
      result.corner_vertex.push_back(plc_.corner_vertex[c]);
    }
    return result;
  }

  // Of segments that have become one the first edge's stays; those without a triangle are gone.
  void keep_segments(Plc& result) const {
    std::vector<Segment> sides;
    for (const auto& [a, b, c] : triangles_)
      for (const auto& [p, q] : {Segment{a, b}, Segment{b, c}, Segment{c, a}})
        if (joined_[p] || joined_[q]) sides.push_back({std::min(p, q), std::max(p, q)});
    std::sort(sides.begin(), sides.end());
    std::vector<std::array<Index, 4>> all;  // ends in order, edge, segment
    for (std::size_t s = 0; s < plc_.segments.size(); ++s) {
      const auto [a, b] = std::minmax(to_[plc_.segments[s][0]], to_[plc_.segments[s][1]]);
      if (a == b) continue;
      const bool near = joined_[a] || joined_[b];
      if (near && !std::binary_search(sides.begin(), sides.end(), Segment{a, b})) continue;
      all.push_back({a, b, plc_.segment_edge[s], static_cast<Index>(s)});
    }
    std::sort(all.begin(), all.end());
    std::vector<Index> kept;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i == 0 || all[i][0] != all[i - 1][0] || all[i][1] != all[i - 1][1]) kept.push_back(all[i][3]);
    std::sort(kept.begin(), kept.end());
    result.segments.clear();
    result.segment_edge.clear();
    for (const Index s : kept) {
      result.segments.push_back({to_[plc_.segments[s][0]], to_[plc_.segments[s][1]]});
      result.segment_edge.push_back(plc_.segment_edge[s]);
    }
  }

  void report(const Plc& result, Absorbed& absorbed) const {
    const auto gone = [](const std::vector<Index>& before, const std::vector<Index>& after) {
      std::vector<Index> a = before, b = after, rest;
      for (auto* v : {&a, &b}) {
        std::sort(v->begin(), v->end());
        v->erase(std::unique(v->begin(), v->end()), v->end());
      }
      std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
      return rest;
    };
    absorbed.faces = gone(given_.triangle_face, result.triangle_face);
    absorbed.edges = gone(given_.segment_edge, result.segment_edge);
    absorbed.vertices = gone(given_.corner_vertex, result.corner_vertex);
  }

  const Plc& given_;
  Plc plc_;  // with divided segments
  const Tolerance& tolerance_;
  Context& context_;
  std::vector<SmallFeature> features_;
  std::vector<double> width_;               // by feature
  std::vector<char> active_;                // by feature
  std::vector<Index> rank_;                 // by point
  std::vector<Index> beside_;               // by point inside a face: the nearest beside it on a curve, or -1
  std::vector<Index> to_;                   // by point: the one that it becomes
  std::vector<char> joined_;                // by point: it has become, or others have become it
  std::map<Index, Index> followers_;        // points inside faces, and the point that each joins
  std::vector<std::vector<Index>> faults_;  // of each the points that stay, and may not all be joined so
  std::vector<Index> refused_;              // features
  std::vector<Triangle> triangles_;
  std::vector<Index> source_;                      // of triangles_, in plc_
  std::vector<Vec3> before_;                       // of triangles_: twice the area vector that they had
  std::vector<std::pair<Index, Index>> segments_;  // ends that stay, in order
  std::map<std::pair<Index, Segment>, std::size_t> half_;  // face, directed side -> triangle
  std::unordered_set<std::uint64_t> sides_;  // of triangles_, while some are turned back, as half_
};

}  // namespace

Plc absorb_small_features(const Plc& plc, const Geometry& geometry, SizeOptions sizes, Context& context,
                          Absorbed& absorbed) {
  // What the mesher finds by itself, a fillet's curvature say, is no reason to keep the fillet.
  sizes.elements_per_circle = sizes.elements_across = 0;
  const SizeField given(plc, geometry, sizes, context);
  const double most = sizes.min_size > 0 ? sizes.min_size : HUGE_VAL;
  const Tolerance tolerance = [&](const Vec3& p) { return std::min(most, kAbsorbed * given.at(p)); };
  return Absorber(plc, geometry, tolerance, context).run(absorbed);
}

}  // namespace dm
