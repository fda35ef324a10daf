#include "surfaces/small_features.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "base/box_tree.h"
#include "surfaces/plc_editor.h"
#include "surfaces/strip_flips.h"
#include "surfaces/tips.h"

namespace dm {
namespace {

constexpr double kFacing = 1.2;  // distance of a point that faces another, over the distance of its curve
constexpr double kCorner = 2;    // ... from where two curves meet: 30 degrees
constexpr double kTip = 6;       // ... in a tip: 10 degrees
constexpr double kReach = 3;     // ... of a segment from the point that faces it, over the tolerance
constexpr double kPart = 0.8;    // largest width of a narrow part of a face, over the tolerance
constexpr double kWorth = 0.2;   // width of a neck that is worth the steps at its ends, over the tolerance
constexpr double kNeckLength = 100;  // ... largest length: two elements
constexpr double kTipEnd = 0.9;      // width where a tip is cut off, over that of the widest narrow part
constexpr double kBeside = 2;  // tolerances from a vertex of the other curve, which faces this one as well
constexpr double kBent = 0.2;  // width of a strip over the radius of its curves: more would change a hole
constexpr double kOpposite = -0.2;      // cosine between the ways to two curves that a point lies between
constexpr std::size_t kMostSteps = 20;  // per triangle of a face
constexpr int kBisections = 20;
constexpr int kMostRounds = 3;  // in which a face is searched

class Finder {
 public:
  Finder(Plc& plc, const Geometry& geometry, const Tolerance& tolerance)
      : plc_(plc),
        geometry_(geometry),
        tolerance_(tolerance),
        editor_(plc),
        flips_(plc, geometry, tolerance, sharp_, editor_),
        kept_face_(plc.face_solids.size(), 0),
        kept_edge_(plc.edge_count, 0),
        bounds_(plc.edge_count, 1) {
    for (const Index f : plc.kept_faces) kept_face_[f] = 1;
    for (const Index e : plc.kept_edges) kept_edge_[e] = 1;
    if (!plc.kept_faces.empty()) keep_outlines();
  }

  std::vector<SmallFeature> run() {
    collect_edges();
    collect_outlines();
    tips_ = find_tips(plc_, geometry_, tolerance_);
    std::erase_if(tips_, [&](const Tip& tip) { return kept_edge_[tip.edge] || kept_edge_[tip.other_edge]; });
    const std::vector<Index> faces = faces_with_narrow_places();
    if (!faces.empty()) editor_.collect(faces);
    search(faces);
    for (const Index f : faces)
      if (load(f)) collect_features(f);
    editor_.finish();
    std::stable_sort(found_.begin(), found_.end(), [&](const SmallFeature& a, const SmallFeature& b) {
      return width_of(a, plc_.points) < width_of(b, plc_.points);
    });
    return std::move(found_);
  }

 private:
  const Vec3& at(Index p) const { return plc_.points[p]; }

  // A face stays only if its edges do.
  void keep_outlines() {
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t)
      for (int i = 0; kept_face_[plc_.triangle_face[t]] && i < 3; ++i) {
        const auto [a, b] = editor_.side(static_cast<Index>(t), i);
        const Index s = editor_.segment(a, b);
        if (s >= 0) kept_edge_[plc_.segment_edge[s]] = 1;
      }
  }

  void collect_outlines() {
    outlines_.resize(plc_.face_solids.size());
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const auto [a, b] = editor_.side(static_cast<Index>(t), i);
        const Index s = on_curve(a) && on_curve(b) ? editor_.segment(a, b) : -1;
        if (s >= 0) outlines_[plc_.triangle_face[t]].push_back(plc_.segment_edge[s]);
      }
    for (std::vector<Index>& edges : outlines_) {
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    }
  }

  void collect_edges() {
    length_.assign(plc_.edge_count, 0);
    ends_.resize(plc_.edge_count);
    for (std::size_t s = 0; s < plc_.segments.size(); ++s) {
      const Index e = plc_.segment_edge[s];
      length_[e] += distance(at(plc_.segments[s][0]), at(plc_.segments[s][1]));
      for (const Index p : plc_.segments[s]) toggle(ends_[e], p);
    }
  }

  // Ends of a curve are the points met once.
  static void toggle(std::vector<Index>& ends, Index p) {
    const auto found = std::find(ends.begin(), ends.end(), p);
    if (found == ends.end())
      ends.push_back(p);
    else
      ends.erase(found);
  }

  Index segment(Index a, Index b) const { return editor_.segment(a, b); }
  bool on_curve(Index p) const { return editor_.on_curve(p); }
  bool tiny_edge(Index e) const { return ends_[e].size() == 2 && length_[e] < tolerance_(at(ends_[e][0])); }
  bool on_kept_curve(Index p) const {
    const std::vector<Index>& edges = editor_.edges_of(p);
    return std::any_of(edges.begin(), edges.end(), [&](Index e) { return kept_edge_[e]; });
  }
  bool is_vertex(Index p) const { return editor_.edges_of(p).size() > 1; }

  // A side that would vanish: a tiny edge, or across the face from one curve to another.
  bool is_short(Index a, Index b) const {
    if (!on_curve(a) || !on_curve(b) || !(distance(at(a), at(b)) < tolerance_(at(a)))) return false;
    if (on_kept_curve(a) || on_kept_curve(b)) return false;
    const Index s = segment(a, b);
    if (s >= 0) return tiny_edge(plc_.segment_edge[s]);
    return !editor_.share_edge(a, b) && distance(at(a), at(b)) < std::max(bent_at(a), bent_at(b));
  }

  // Width of a strip that may be absorbed at a point, by the curve through it that is bent least; those at
  // its ends do not count.
  double bent_at(Index p) const {
    double most = 0;
    for (const Index e : editor_.edges_of(p))
      if (bounds_[e] && !tiny_edge(e)) most = std::max(most, bent_width(e, at(p)));
    return most;
  }
  double bent_width(Index edge, const Vec3& place) const {
    const double curvature = geometry_.edge_curvature(edge, place);
    return curvature > 0 ? kBent / curvature : HUGE_VAL;
  }

  // Where the segment (a, b), a side of a triangle, passes its third corner p; nothing unless p is near, on
  // another curve, and no end of the segment faces it.
  bool passes(Index a, Index b, Index p, Vec3& place) const {
    if (!on_curve(a) || !on_curve(b) || !on_curve(p)) return false;
    const Vec3 along = at(b) - at(a);
    const double t = dot(at(p) - at(a), along) / norm2(along), limit = tolerance_(at(p));
    if (!(t > 0 && t < 1) || norm2(at(a) + t * along - at(p)) > kReach * kReach * limit * limit) return false;
    const Index s = segment(a, b);
    if (s < 0) return false;
    const Index edge = plc_.segment_edge[s];
    if (kept_edge_[edge] || on_kept_curve(p)) return false;
    if (editor_.is_on(p, edge)) return false;
    place = geometry_.project_to_edge(edge, at(a) + t * along);
    const double w = distance(place, at(p));
    if (!(w < limit) || std::min(distance(at(a), place), distance(at(b), place)) < 0.1 * w) return false;
    if (!(w < std::max(bent_at(p), bent_width(edge, place)))) return false;
    // A vertex within reach is faced rather than a place beside it, but for that at the tip of the strip: it
    // is on the same curve as p.  The corner of a face is no strip.
    for (const Index end : {a, b}) {
      const double d = distance(at(end), at(p));
      const bool joined = editor_.share_edge(end, p);
      const bool in_reach = is_vertex(end) && !(joined && d > kTip * w);
      if (d < (in_reach ? limit : kFacing * w)) return false;
      if (d < kCorner * w && joined) return false;
    }
    return true;
  }

  // ---- tips

  // Divides the edge where the tip becomes as wide as a narrow part may be; its points before that face the
  // other curve anyway.  False if it is nowhere as wide because the edge ends on the other one, as that of a
  // lens does: then the other one may be divided.
  bool cut_tip(const Tip& tip) {
    const double widest = kTipEnd * kPart * tolerance_(at(tip.point));
    Index a = tip.point, b = next_on(tip.edge, -1, a);
    while (b >= 0 && gap_at(tip, at(b)) < widest) {
      const Index next = is_vertex(b) ? -1 : next_on(tip.edge, a, b);
      a = b;
      b = next;
    }
    if (b < 0) return !editor_.is_on(a, tip.other_edge);
    const Vec3 place = place_of_width(tip, a, b, widest);
    if (is_clear(place, a, b) && !is_faced(place, tip)) divide(segment(a, b), place, tip.face);
    return true;
  }

  // Between a, where the tip is narrower, and b.
  Vec3 place_of_width(const Tip& tip, Index a, Index b, double width) const {
    double low = 0, high = 1;
    for (int step = 0; step < kBisections; ++step) {
      const double t = 0.5 * (low + high);
      (gap_at(tip, on_edge(tip, a, b, t)) < width ? low : high) = t;
    }
    return on_edge(tip, a, b, low);
  }
  bool is_clear(const Vec3& place, Index a, Index b) const {
    return std::min(distance(place, at(a)), distance(place, at(b))) >= tolerance_(place);
  }

  // A neck, where a curve comes near another one between two of its points: divides it on both sides of p
  // where the neck becomes as wide as a narrow part may be.  The new points.
  std::vector<Index> cut_neck(Index face, Index p, Index other) {
    std::vector<Index> made;
    const double limit = tolerance_(at(p));
    if (is_vertex(p) || distance(at(p), geometry_.project_to_edge(other, at(p))) > kWorth * limit)
      return made;
    const Tip tip{face, p, editor_.edges_of(p)[0], other};
    const Index before = next_on(tip.edge, -1, p), after = next_on(tip.edge, before, p);
    if (before < 0 || after < 0 || std::min(gap_at(tip, at(before)), gap_at(tip, at(after))) < limit)
      return made;
    for (const Index q : {before, after}) {
      const Vec3 place = place_of_width(tip, p, q, kTipEnd * kPart * limit);
      if (is_clear(place, p, q)) made.push_back(divide(segment(p, q), place, face));
    }
    return made;
  }

  // Beside a vertex of the other curve, or a point of it where the tip is narrow enough: that faces this
  // curve.
  bool is_faced(const Vec3& place, const Tip& tip) const {
    const double reach = tolerance_(place);
    for (const Index t : editor_.triangles_of(tip.face))
      for (const Index p : plc_.triangles[t]) {
        const double d = distance(at(p), place);
        if (d >= kBeside * reach || p == tip.point || !editor_.is_on(p, tip.other_edge)) continue;
        if (is_vertex(p)) return true;
        if (d < reach && distance(at(p), geometry_.project_to_edge(tip.edge, at(p))) < kPart * reach)
          return true;
      }
    return false;
  }

  Vec3 on_edge(const Tip& tip, Index a, Index b, double t) const {
    return geometry_.project_to_edge(tip.edge, at(a) + t * (at(b) - at(a)));
  }
  double gap_at(const Tip& tip, const Vec3& p) const {
    return distance(p, geometry_.project_to_edge(tip.other_edge, p));
  }

  // The point after b on the curve, coming from a; -1 = none.
  Index next_on(Index edge, Index a, Index b) const {
    for (const Index t : editor_.triangles_round(b))
      for (int i = 0; i < 3; ++i) {
        const auto [p, q] = editor_.side(t, i);
        if (p != b && q != b) continue;
        const Index other = p == b ? q : p, s = segment(p, q);
        if (other != a && s >= 0 && plc_.segment_edge[s] == edge) return other;
      }
    return -1;
  }

  std::vector<Index> faces_with_narrow_places() const {
    std::vector<char> found(plc_.face_solids.size(), 0);
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t) {
      const Triangle& v = plc_.triangles[t];
      char& narrow = found[plc_.triangle_face[t]];
      for (int i = 0; i < 3 && !narrow; ++i) {
        const Index a = v[i], b = v[(i + 1) % 3], p = v[(i + 2) % 3];
        Vec3 place;
        narrow = is_short(a, b) || passes(a, b, p, place) ||
                 (on_curve(a) && distance(at(a), at(p)) < tolerance_(at(p)) &&
                  lies_between(outlines_[plc_.triangle_face[t]], p));
      }
      // Its corners may face no segment of each other, though.
      narrow = narrow || flips_.is_in_strip(v);
    }
    for (const Tip& tip : tips_) found[tip.face] = 1;
    std::vector<Index> faces;
    for (std::size_t f = 0; f < found.size(); ++f)
      if (found[f] && !kept_face_[f]) faces.push_back(static_cast<Index>(f));
    return faces;
  }

  // ---- one face

  // A face is searched again where another one has divided its outline: a point there faces others, too.
  // Facets are not, as absorbing more of them bends them more.
  void search(const std::vector<Index>& faces) {
    std::vector<Index> again = faces;
    for (int round = 0; round < kMostRounds && !again.empty(); ++round) {
      for (const Index f : again)
        if (load(f)) search_face(f);
      again.assign(editor_.divided_by_others().begin(), editor_.divided_by_others().end());
      std::erase_if(again, [&](Index f) { return geometry_.is_facets(f); });
    }
  }

  // Makes a face the one at hand; false if it is folded onto itself.
  bool load(Index face) {
    sharp_.clear();
    for (const Tip& tip : tips_)
      if (tip.face == face) sharp_.insert(tip.point);
    if (!editor_.load(face)) return false;
    bounds_.assign(plc_.edge_count, 0);
    for (const auto& [ends, t] : editor_.sides())
      if (const Index s = segment(ends[0], ends[1]); s >= 0) bounds_[plc_.segment_edge[s]] = 1;
    return true;
  }

  void search_face(Index face) {
    steps_ = kMostSteps * editor_.triangles_of(face).size() + 1000;
    for (const Tip& tip : tips_)
      if (tip.face == face) {
        if (!cut_tip(tip)) cut_tip({tip.face, tip.point, tip.other_edge, tip.edge});
        drop_points(face, [&](Index p) { return lies_in(tip, p); });
      }
    drop_points(face, [&](Index p) { return lies_between(outlines_[face], p); });
    std::vector<Segment> open;
    for (const auto& [ends, t] : editor_.sides()) open.push_back(ends);
    flips_.run(open, steps_);
    while (!open.empty() && steps_ > 0) {
      const Segment ends = open.back();
      open.pop_back();
      const Index left = editor_.left_of(ends);
      Vec3 place;
      if (left < 0 || !passes(ends[0], ends[1], editor_.apex(left, ends), place)) continue;
      const Index s = segment(ends[0], ends[1]), other = plc_.segment_edge[s];
      const Index p = editor_.apex(left, ends), v = divide(s, place, face);
      std::vector<Segment> around;
      const auto add_sides_at = [&](Index point) {
        for (const Index t : editor_.triangles_round(point))
          if (plc_.triangle_face[t] == face)
            for (int i = 0; i < 3; ++i) around.push_back(editor_.side(t, i));
      };
      add_sides_at(v);
      for (const Index end : cut_neck(face, p, other)) add_sides_at(end);
      flips_.run(around, steps_);
      open.push_back({ends[0], v});
      open.push_back({v, ends[1]});
    }
  }

  Index divide(Index segment, const Vec3& place, Index face) {
    --steps_;
    return editor_.divide(segment, place, face);
  }

  // Points of the tessellation inside a tip or a strip would lie between points that face each other.
  template <class Lies>
  void drop_points(Index face, Lies lies_inside) {
    std::vector<Index> stack = editor_.triangles_of(face);
    while (!stack.empty() && steps_ > 0) {
      const Index t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const auto [a, b] = editor_.side(t, i);
        const Index p = editor_.apex(t, {a, b});
        if (p < 0 || !on_curve(a) || !on_curve(b) || on_curve(p) || !lies_inside(p)) continue;
        const std::vector<Index> fan = editor_.triangles_round(p);
        if (!drop(p, fan)) continue;
        --steps_;
        stack.insert(stack.end(), fan.begin(), fan.end());
        break;
      }
    }
  }
  // Onto a neighbour, one on a curve if that is possible, the nearest first.
  bool drop(Index p, const std::vector<Index>& fan) {
    std::vector<std::tuple<bool, double, Index>> around;
    for (const Index t : fan)
      for (const Index q : plc_.triangles[t])
        if (q != p) around.emplace_back(!on_curve(q), distance(at(q), at(p)), q);
    std::sort(around.begin(), around.end());
    return std::any_of(around.begin(), around.end(),
                       [&](const auto& to) { return editor_.collapse(p, std::get<Index>(to)); });
  }

  // Is a point inside a face nearer than the tolerance to two of its curves, on opposite sides?
  bool lies_between(const std::vector<Index>& outline, Index p) const {
    if (on_curve(p)) return false;
    const double limit = tolerance_(at(p));
    std::vector<std::pair<Index, Vec3>> near;  // curve, from p to it
    for (const Index e : outline) {
      const Vec3 to = geometry_.project_to_edge(e, at(p)) - at(p);
      if (!kept_edge_[e] && norm(to) < limit) near.emplace_back(e, to);
    }
    for (std::size_t i = 0; i < near.size(); ++i)
      for (std::size_t j = i + 1; j < near.size(); ++j) {
        const auto& [e, u] = near[i];
        const auto& [f, v] = near[j];
        if (!(dot(u, v) < kOpposite * norm(u) * norm(v)) || !(norm(u - v) < limit)) continue;
        if (tiny_edge(e) && tiny_edge(f)) return true;
        if (norm(u - v) < std::max(bent_width(e, at(p) + u), bent_width(f, at(p) + v))) return true;
      }
    return false;
  }
  bool lies_in(const Tip& tip, Index p) const {
    const double limit = tolerance_(at(p));
    return gap_at(tip, at(p)) < limit && distance(at(p), geometry_.project_to_edge(tip.edge, at(p))) < limit;
  }

  // The short sides, by sets of triangles that hang together.
  void collect_features(Index face) {
    const auto short_sides = [&](Index t) {
      int n = 0;
      for (int i = 0; i < 3; ++i) n += is_short(editor_.side(t, i)[0], editor_.side(t, i)[1]);
      return n;
    };
    std::set<Index> left;
    for (const Index t : editor_.triangles_of(face))
      if (short_sides(t) > 0) left.insert(t);
    while (!left.empty()) {
      std::set<std::pair<Index, Index>> pairs;
      std::vector<Index> stack{*left.begin()};
      left.erase(left.begin());
      std::size_t triangles = 0;
      bool tip = false;
      for (; !stack.empty(); ++triangles) {
        const Index t = stack.back();
        stack.pop_back();
        for (const Index p : plc_.triangles[t]) tip |= sharp_.contains(p);
        for (int i = 0; i < 3; ++i) {
          const auto [a, b] = editor_.side(t, i);
          if (is_short(a, b)) pairs.insert(std::minmax(a, b));
          const Index beside = editor_.left_of({b, a});
          if (beside < 0 || segment(a, b) >= 0 || left.erase(beside) == 0) continue;
          stack.push_back(beside);
        }
      }
      SmallFeature feature(pairs.begin(), pairs.end());
      const bool all = triangles == editor_.triangles_of(face).size();
      if (!all) feature = worth_absorbing(std::move(feature), tip);
      if (!feature.empty()) found_.push_back(std::move(feature));
    }
  }

  // What is absorbed of a part of a face.  It ends where the face is as wide as the tolerance; the step that
  // this leaves must be worth it.  One side across closes no strip but at a tip: it would only move the tip
  // of a wedge.
  SmallFeature worth_absorbing(SmallFeature feature, bool tip) const {
    if (feature.size() == 1 && segment(feature[0].first, feature[0].second) >= 0) return feature;
    SmallFeature narrow;
    for (const auto& pair : feature)
      if (width_of({pair}, plc_.points) < kPart * tolerance_(at(pair.first))) narrow.push_back(pair);
    if (tip) return narrow;
    const bool strip = narrow.size() == feature.size();
    if (feature.size() < 2 || !(strip || is_neck(narrow))) return {};
    return narrow.size() > 1 ? narrow : feature;
  }

  // Far narrower at some place, and not much longer than an element: a long strip that widens is kept.
  bool is_neck(const SmallFeature& feature) const {
    Box box;
    double narrowest = HUGE_VAL, limit = HUGE_VAL;
    for (const auto& [p, q] : feature) {
      box.add(at(p));
      narrowest = std::min(narrowest, distance(at(p), at(q)));
      limit = std::min(limit, tolerance_(at(p)));
    }
    return narrowest < kWorth * limit && norm(box.extent()) < kNeckLength * limit;
  }

  Plc& plc_;
  const Geometry& geometry_;
  const Tolerance& tolerance_;
  PlcEditor editor_;
  StripFlips flips_;
  std::vector<char> kept_face_, kept_edge_;
  std::vector<char> bounds_;    // by edge: it bounds the face at hand
  std::vector<double> length_;  // by edge, as its ends
  std::vector<std::vector<Index>> ends_;
  std::vector<std::vector<Index>> outlines_;  // by face: its edges
  std::vector<Tip> tips_;
  std::set<Index> sharp_;  // of the face at hand: points of its tips
  std::size_t steps_ = 0;  // left for the face at hand
  std::vector<SmallFeature> found_;
};

}  // namespace

double width_of(const SmallFeature& feature, const std::vector<Vec3>& points) {
  double most = 0;
  for (const auto& [p, q] : feature) most = std::max(most, distance(points[p], points[q]));
  return most;
}

std::vector<SmallFeature> find_small_features(Plc& plc, const Geometry& geometry,
                                              const Tolerance& tolerance) {
  return Finder(plc, geometry, tolerance).run();
}

}  // namespace dm
