#include "surfaces/small_features.h"

#include <algorithm>
#include <map>

namespace dm {
namespace {

constexpr double kFacing = 1.2;  // distance of a point that faces another, over the distance of its curve
constexpr std::size_t kMostSegments = 2000;  // round a narrow face

// A place on a segment, at the part t of the way from its first end.
struct Division {
  Index segment;
  double t;
  Index feature, from;  // the point that it shall face
  Vec3 place;
  bool operator<(const Division& o) const {
    return segment != o.segment ? segment < o.segment : t != o.t ? t < o.t : from < o.from;
  }
};

class Finder {
 public:
  Finder(Plc& plc, const Geometry& geometry, const Tolerance& tolerance)
      : plc_(plc), geometry_(geometry), tolerance_(tolerance), table_(plc) {}

  std::vector<SmallFeature> run() {
    measure_edges();
    find_faces();
    find_edges();
    divide_segments();
    return std::move(found_);
  }

 private:
  void measure_edges() {
    length_.assign(plc_.edge_count, 0);
    ends_.resize(plc_.edge_count);
    for (std::size_t s = 0; s < plc_.segments.size(); ++s) {
      const auto [a, b] = plc_.segments[s];
      const Index e = plc_.segment_edge[s];
      length_[e] += distance(plc_.points[a], plc_.points[b]);
      for (const Index p : {a, b}) toggle(ends_[e], p);
    }
  }

  // Ends of a chain are the points met once.
  static void toggle(std::vector<Index>& ends, Index p) {
    const auto at = std::find(ends.begin(), ends.end(), p);
    if (at == ends.end())
      ends.push_back(p);
    else
      ends.erase(at);
  }

  bool tiny(Index edge) const {
    return ends_[edge].size() == 2 && length_[edge] < tolerance_(plc_.points[ends_[edge][0]]);
  }

  void find_faces() {
    const std::size_t n = plc_.face_solids.size();
    std::vector<double> area(n, 0), perimeter(n, 0);
    std::vector<Index> point(n, -1);
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t) {
      const Triangle& v = plc_.triangles[t];
      const Index f = plc_.triangle_face[t];
      point[f] = v[0];
      area[f] += 0.5 * norm(area_vector(plc_.points[v[0]], plc_.points[v[1]], plc_.points[v[2]]));
      for (int i = 0; i < 3; ++i)
        if (table_.find(v[i], v[(i + 1) % 3]) >= 0)
          perimeter[f] += distance(plc_.points[v[i]], plc_.points[v[(i + 1) % 3]]);
    }
    std::vector<char> narrow(n, 0);  // or not: chords of curves make the triangles wider than the face
    for (std::size_t f = 0; f < n; ++f)
      narrow[f] = point[f] >= 0 && area[f] < perimeter[f] * tolerance_(plc_.points[point[f]]);
    if (std::find(narrow.begin(), narrow.end(), 1) == narrow.end()) return;
    const auto boundaries = table_.boundaries(plc_, narrow);
    for (std::size_t f = 0; f < n; ++f)
      if (narrow[f] && boundaries[f].size() <= kMostSegments) add_face(static_cast<Index>(f), boundaries[f]);
  }

  void add_face(Index face, const std::vector<Segment>& boundary) {
    std::map<Index, std::vector<Index>> edges_at;  // by point of the boundary
    for (const auto& [a, b] : boundary)
      for (const Index p : {a, b}) edges_at[p].push_back(plc_.segment_edge[table_.find(a, b)]);
    found_.push_back({face, -1, {}});
    for (const auto& [a, b] : boundary)
      if (tiny(plc_.segment_edge[table_.find(a, b)])) found_.back().pairs.emplace_back(a, b);
    for (const auto& [p, edges] : edges_at) face_point(p, edges, boundary);
    const bool divides =
        !divisions_.empty() && divisions_.back().feature + 1 == static_cast<Index>(found_.size());
    if (found_.back().pairs.empty() && !divides) found_.pop_back();
  }

  // What p faces on the curves of the boundary that do not pass through it.
  void face_point(Index p, const std::vector<Index>& edges, const std::vector<Segment>& boundary) {
    const Vec3& x = plc_.points[p];
    Division nearest{-1, 0, static_cast<Index>(found_.size()) - 1, p, {}};
    double least = HUGE_VAL;
    for (const auto& [a, b] : boundary) {
      const Index s = table_.find(a, b);
      if (std::find(edges.begin(), edges.end(), plc_.segment_edge[s]) != edges.end()) continue;
      const auto [c, d] = plc_.segments[s];
      const Vec3 along = plc_.points[d] - plc_.points[c];
      const double t = std::clamp(dot(x - plc_.points[c], along) / norm2(along), 0.0, 1.0);
      const Vec3 q = plc_.points[c] + t * along;
      if (!(distance(q, x) < least)) continue;
      least = distance(q, x);
      nearest.segment = s;
      nearest.t = t;
      nearest.place = q;
    }
    if (nearest.segment < 0) return;
    nearest.place = geometry_.project_to_edge(plc_.segment_edge[nearest.segment], nearest.place);
    const double width = distance(nearest.place, x);
    const auto [c, d] = plc_.segments[nearest.segment];
    const Index end = distance(plc_.points[c], x) < distance(plc_.points[d], x) ? c : d;
    const double limit = tolerance_(x), to_end = distance(plc_.points[end], x);
    if (to_end < limit && to_end <= kFacing * width)
      found_.back().pairs.emplace_back(p, end);
    else if (width < limit && nearest.t > 0 && nearest.t < 1)
      divisions_.push_back(nearest);
  }

  void find_edges() {
    std::vector<Index> edges;
    for (Index e = 0; e < plc_.edge_count; ++e)
      if (tiny(e)) edges.push_back(e);
    std::sort(edges.begin(), edges.end(),
              [&](Index e, Index f) { return length_[e] != length_[f] ? length_[e] < length_[f] : e < f; });
    std::vector<Index> feature(plc_.edge_count, -1);
    for (const Index e : edges) {
      feature[e] = static_cast<Index>(found_.size());
      found_.push_back({-1, e, {}});
    }
    for (std::size_t s = 0; s < plc_.segments.size(); ++s)
      if (const Index k = feature[plc_.segment_edge[s]]; k >= 0)
        found_[k].pairs.emplace_back(plc_.segments[s][0], plc_.segments[s][1]);
  }

  void divide_segments() {
    if (divisions_.empty()) return;
    std::sort(divisions_.begin(), divisions_.end());
    std::vector<std::vector<Index>> triangles(plc_.points.size());  // round the points of divided segments
    for (const Division& d : divisions_)
      for (const Index p : plc_.segments[d.segment]) triangles[p].push_back(-1);
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t)
      for (const Index p : plc_.triangles[t])
        if (!triangles[p].empty()) triangles[p].push_back(static_cast<Index>(t));
    Index segment = -1, whole = -1;  // the one being divided: its rest, and its number at first
    double last = 0;
    for (const Division& d : divisions_) {
      if (d.segment != whole) {
        whole = segment = d.segment;
        last = -1;
      }
      if (d.t > last) segment = divide(segment, d.place, triangles);
      last = d.t;
      found_[d.feature].pairs.emplace_back(d.from, plc_.segments[segment][0]);
    }
  }

  // Divides a segment and its triangles at p; returns the part behind p.
  Index divide(Index s, const Vec3& p, std::vector<std::vector<Index>>& triangles) {
    const auto [a, b] = plc_.segments[s];
    const Index v = static_cast<Index>(plc_.points.size());
    plc_.points.push_back(p);
    triangles.emplace_back();
    const std::vector<Index> round = triangles[a];
    for (const Index t : round) {
      if (t < 0) continue;
      Triangle& first = plc_.triangles[t];
      const auto at = std::find(first.begin(), first.end(), b);
      if (at == first.end() || std::find(first.begin(), first.end(), a) == first.end()) continue;
      Triangle second = first;
      *at = v;
      *std::find(second.begin(), second.end(), a) = v;
      const Index n = static_cast<Index>(plc_.triangles.size());
      plc_.triangles.push_back(second);
      plc_.triangle_face.push_back(plc_.triangle_face[t]);
      std::erase(triangles[b], t);
      for (const Index q : second)
        if (q == v || !triangles[q].empty()) triangles[q].push_back(n);
      triangles[v].push_back(t);
    }
    plc_.segments[s] = {a, v};
    plc_.segments.push_back({v, b});
    plc_.segment_edge.push_back(plc_.segment_edge[s]);
    return static_cast<Index>(plc_.segments.size()) - 1;
  }

  Plc& plc_;
  const Geometry& geometry_;
  const Tolerance& tolerance_;
  const SegmentTable table_;
  std::vector<double> length_;
  std::vector<std::vector<Index>> ends_;
  std::vector<Division> divisions_;
  std::vector<SmallFeature> found_;
};

}  // namespace

SegmentTable::SegmentTable(const Plc& plc) {
  ends_.reserve(plc.segments.size());
  for (std::size_t s = 0; s < plc.segments.size(); ++s) {
    const auto [a, b] = std::minmax(plc.segments[s][0], plc.segments[s][1]);
    ends_.push_back({a, b, static_cast<Index>(s)});
  }
  std::sort(ends_.begin(), ends_.end());
}

Index SegmentTable::find(Index a, Index b) const {
  const std::array<Index, 3> key{std::min(a, b), std::max(a, b), -1};
  const auto at = std::lower_bound(ends_.begin(), ends_.end(), key);
  return at != ends_.end() && (*at)[0] == key[0] && (*at)[1] == key[1] ? (*at)[2] : -1;
}

std::vector<std::vector<Segment>> SegmentTable::boundaries(const Plc& plc,
                                                           const std::vector<char>& wanted) const {
  std::vector<std::vector<Segment>> result(wanted.size());
  for (std::size_t t = 0; t < plc.triangles.size(); ++t) {
    if (!wanted[plc.triangle_face[t]]) continue;
    const Triangle& v = plc.triangles[t];
    for (int i = 0; i < 3; ++i)
      if (find(v[i], v[(i + 1) % 3]) >= 0) result[plc.triangle_face[t]].push_back({v[i], v[(i + 1) % 3]});
  }
  return result;
}

std::vector<SmallFeature> find_small_features(Plc& plc, const Geometry& geometry,
                                              const Tolerance& tolerance) {
  return Finder(plc, geometry, tolerance).run();
}

}  // namespace dm
