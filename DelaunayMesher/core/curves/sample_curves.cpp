#include "curves/sample_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <unordered_map>

#include "base/random.h"
#include "curves/chains.h"
#include "curves/near_samples.h"

namespace dm {
namespace {

constexpr double kMaxTurn = std::numbers::pi / 2;  // per part of a curve
constexpr double kPiecesPerPart = 4;               // accuracy of the arc length
constexpr double kSnap =
    0.1;  // a sample this near to an old point, relative to the old segments, replaces it
constexpr double kSame = 1e-3;  // of the wanted length: samples beyond the end of a curve that stops short of
                                // its vertex all lie at that end
constexpr double kBeside = 0.4;     // distance over length within which samples of two curves are matched
constexpr double kApart = 0.55;     // least distance of matched samples along the curve, over length
constexpr double kTouching = 1e-5;  // ... and below which, over that, they are the same place
constexpr double kAskew = 0.1;      // displacement of a matched sample along the curve, over the distance
constexpr double kSnapStep = 0.3;   // ... but not farther than this part of a step, to keep the order

// A point of the refined polyline: between old points `parent` and `parent + 1` of the chain.
struct Piece {
  Vec3 point;
  double metric = 0;  // integral of ds / L from the chain's start
  Index parent = 0;
};

double turning(const std::vector<Vec3>& points, const Chain& chain) {
  double sum = 0;
  Vec3 last{};
  Vec3 first{};
  for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
    const Vec3 d = normalized(points[chain.points[i + 1]] - points[chain.points[i]]);
    if (norm2(d) == 0) continue;
    if (norm2(last) > 0)
      sum += std::acos(std::clamp(dot(last, d), -1.0, 1.0));
    else
      first = d;
    last = d;
  }
  if (chain.closed()) sum += std::acos(std::clamp(dot(last, first), -1.0, 1.0));
  return sum;
}

class Sampler {
 public:
  Sampler(const Plc& plc, const Geometry& geometry, const LengthField& lengths, const CurveOptions& options,
          Context& context)
      : plc_(plc), geometry_(geometry), lengths_(lengths), options_(options), context_(context) {}

  CurveSampling run() {
    chains_ = find_chains(plc_, options_.keep);
    start_result();
    const std::size_t n = chains_.size();
    parts_.resize(n);
    for (std::size_t c = 0; c < n; ++c) {
      pieces_of(chains_[c]);
      parts_[c] = part_count(chains_[c]);
    }
    separate_twins();
    for (const Chain& chain : chains_)
      for (const Index p : {chain.points.front(), chain.points.back()}) add_near(plc_.points[p]);
    for (std::size_t c = 0; c < n; ++c) {
      sample(static_cast<Index>(c));
      context_.poll(static_cast<double>(c) / static_cast<double>(n));
    }
    collect_inserted();
    return std::move(result_);
  }

 private:
  void start_result() {
    result_.points = plc_.points;
    result_.role.assign(plc_.points.size(), CurvePointRole::none);
    result_.entity.assign(plc_.points.size(), Entity{});
    for (const Chain& chain : chains_) {
      for (Index p : chain.points) result_.role[p] = CurvePointRole::dropped;
    }
    for (const Chain& chain : chains_)
      for (Index p : {chain.points.front(), chain.points.back()}) {
        result_.role[p] = CurvePointRole::fixed;
        if (off_edge(p, chain.edge) < off_edge(p, result_.entity[p].index))
          result_.entity[p] = {1, chain.edge};
      }
    for (std::size_t c = 0; c < plc_.corners.size(); ++c) {
      result_.role[plc_.corners[c]] = CurvePointRole::fixed;
      result_.entity[plc_.corners[c]] = {0, plc_.corner_vertex[c]};
    }
  }

  // Where an absorbed face ends, edges meet at a point that is on one of them only.
  double off_edge(Index p, Index edge) const {
    return edge < 0 ? HUGE_VAL : distance(plc_.points[p], geometry_.project_to_edge(edge, plc_.points[p]));
  }

  // Refines the chain's polyline on the exact curve into pieces much shorter than the wanted length.
  void pieces_of(const Chain& chain) {
    pieces_.clear();
    const bool straight = geometry_.is_line(chain.edge);
    double length = lengths_.at(plc_.points[chain.points[0]]);
    pieces_.push_back({plc_.points[chain.points[0]], 0, 0});
    for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
      const Vec3 a = plc_.points[chain.points[i]], b = plc_.points[chain.points[i + 1]];
      const double chord = distance(a, b);
      // Each step is a fraction of the length wanted where it starts, so that no local refinement is stepped
      // over.
      for (double t = 0; t < 1;) {
        t += length / (kPiecesPerPart * chord);
        Vec3 p = b;
        if (t < 1) {
          p = a + t * (b - a);
          if (!straight) p = geometry_.project_to_edge(chain.edge, p);
        }
        const double next_length = lengths_.at(p);
        const Piece& last = pieces_.back();
        const double step = 2 * distance(p, last.point) / (length + next_length);
        pieces_.push_back({p, last.metric + step, static_cast<Index>(i)});
        length = next_length;
      }
    }
  }

  bool frozen(const Chain& chain) const {
    return !options_.keep.empty() && chain.segments.size() == 1 && options_.keep[chain.points.front()] == 2 &&
           options_.keep[chain.points.back()] == 2;
  }

  Index part_count(const Chain& chain) const {
    if (frozen(chain)) return 1;
    const double s = pieces_.back().metric;
    double n = std::max(1.0, std::floor(s));
    if (s > std::sqrt(n * (n + 1))) ++n;  // parts longer and shorter than wanted by equal factors
    return std::max(static_cast<Index>(n), least_parts(chain));
  }

  Index least_parts(const Chain& chain) const {
    const double n = std::ceil(turning(plc_.points, chain) / kMaxTurn - 0.1);
    return static_cast<Index>(std::max(n, chain.closed() ? 3.0 : 1.0));
  }

  // Two chains with the same ends must not become the same segment.
  void separate_twins() {
    std::vector<std::tuple<Index, Index, Index>> single;
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      if (parts_[c] != 1) continue;
      const auto [a, b] = std::minmax(chains_[c].points.front(), chains_[c].points.back());
      single.emplace_back(a, b, static_cast<Index>(c));
    }
    std::sort(single.begin(), single.end());
    for (std::size_t k = 1; k < single.size(); ++k) {
      const auto [a, b, c] = single[k];
      if (a != std::get<0>(single[k - 1]) || b != std::get<1>(single[k - 1])) continue;
      parts_[c] = 2;
      parts_[std::get<2>(single[k - 1])] = 2;
    }
  }

  Vec3 point_at(double metric, Index edge, std::size_t& k) const {
    while (k + 1 < pieces_.size() && pieces_[k].metric < metric) ++k;
    const Piece &a = pieces_[k - 1], &b = pieces_[k];
    const double span = b.metric - a.metric;
    const Vec3 p = a.point + (span > 0 ? (metric - a.metric) / span : 0.0) * (b.point - a.point);
    return geometry_.project_to_edge(edge, p);
  }

  // The old point that a sample between old points i and i + 1 of the chain can take the place of, or -1.
  Index replaceable(const Chain& chain, Index i, Index last, const Vec3& p) const {
    const double old = distance(plc_.points[chain.points[i]], plc_.points[chain.points[i + 1]]);
    const double reach = std::min(kSnap * old, kSnapStep * distance(result_.points[last], p));
    for (Index k : {i, i + 1}) {
      const Index v = chain.points[k];
      if (result_.role[v] == CurvePointRole::dropped && distance(plc_.points[v], p) < reach) return v;
    }
    return -1;
  }

  void add_near(const Vec3& p) { near_.add(p, kBeside * lengths_.at(p)); }

  // A place on the chain opposite a sample of another one.
  struct Foot {
    double metric, distance;
  };

  // The feet of the samples beside the chain, those first that are nearest.
  std::vector<Foot> find_feet() {
    std::unordered_map<Index, Foot> nearest;
    for (std::size_t k = 1; k < pieces_.size(); ++k) {
      const Piece &a = pieces_[k - 1], &b = pieces_[k];
      const Vec3 along = b.point - a.point;
      const double length2 = norm2(along), span = b.metric - a.metric;
      if (!(length2 > 0) || !(span > 0)) continue;
      const Vec3 middle = 0.5 * (a.point + b.point);
      near_.for_each_near(middle, kBeside * std::sqrt(length2) / span, [&](Index i) {
        const auto& [q, reach] = near_.sample(i);
        const double t = std::clamp(dot(q - a.point, along) / length2, 0.0, 1.0);
        const double d = distance(q, a.point + t * along);
        if (d > reach || d < kTouching * reach) return;
        Random random(options_.jitter > 0 ? context_.seed : 0, 0x666f6f74, i);
        const double askew = kAskew * d * span / std::sqrt(length2) * random.symmetric();
        const auto [it, is_new] = nearest.try_emplace(i, Foot{a.metric + t * span + askew, d});
        if (!is_new && d < it->second.distance) it->second = {a.metric + t * span + askew, d};
      });
    }
    std::vector<Foot> feet;
    for (const auto& [i, foot] : nearest) feet.push_back(foot);
    std::sort(feet.begin(), feet.end(), [](const Foot& a, const Foot& b) {
      return std::tie(a.distance, a.metric) < std::tie(b.distance, b.metric);
    });
    return feet;
  }

  // Metric coordinates of the samples of a chain of about n parts.
  std::vector<double> places(const Chain& chain, Index n, const std::vector<Foot>& feet) const {
    const double whole = pieces_.back().metric;
    std::vector<double> fixed{0, whole};
    for (const Foot& foot : feet) {
      const auto next = std::lower_bound(fixed.begin(), fixed.end(), foot.metric);
      if (next == fixed.begin() || next == fixed.end()) continue;
      if (*next - foot.metric < kApart || foot.metric - *(next - 1) < kApart) continue;
      fixed.insert(next, foot.metric);
    }
    std::vector<double> result;
    const double parts_per_metric = n / whole;
    for (std::size_t k = 1; k < fixed.size(); ++k) {
      const double gap = fixed[k] - fixed[k - 1];
      const Index parts = std::max<Index>(1, static_cast<Index>(std::lround(gap * parts_per_metric)));
      for (Index i = 1; i < parts; ++i) {
        Random random(options_.jitter > 0 ? context_.seed : 0, 0x63757276, chain.points.front(),
                      chain.segments[0], static_cast<Index>(result.size()) + 1);
        result.push_back(fixed[k - 1] + gap / parts * (i + options_.jitter * random.symmetric()));
      }
      if (k + 1 < fixed.size()) result.push_back(fixed[k]);
    }
    return result;
  }

  void sample(Index c) {
    const Chain& chain = chains_[c];
    Index last = chain.points.front();
    std::vector<double> metrics;
    if (parts_[c] > 1) {
      pieces_of(chain);
      metrics = places(chain, parts_[c], find_feet());
      if (static_cast<Index>(metrics.size()) + 1 < least_parts(chain)) metrics = places(chain, parts_[c], {});
    }
    std::size_t k = 1;
    for (Index i = 1; i <= static_cast<Index>(metrics.size()); ++i) {
      const Vec3 p = point_at(metrics[i - 1], chain.edge, k);
      if (distance(p, result_.points[last]) < kSame * lengths_.at(p)) continue;
      add_near(p);
      const Index parent = pieces_[k].parent;
      Index v = replaceable(chain, parent, last, p);
      if (v < 0) {
        v = static_cast<Index>(result_.points.size());
        result_.points.push_back(p);
        result_.role.push_back(CurvePointRole::fixed);
        result_.entity.push_back({1, chain.edge});
        const Index s = chain.segments[parent];
        insert_.push_back({s, plc_.segments[s][0] == chain.points[parent] ? i : -i, v});
      } else {
        result_.points[v] = p;
        result_.role[v] = CurvePointRole::fixed;
        result_.entity[v] = {1, chain.edge};
      }
      add_segment(last, v, chain.edge);
      last = v;
    }
    add_segment(last, chain.points.back(), chain.edge);
  }

  void add_segment(Index a, Index b, Index edge) {
    result_.segments.push_back({a, b});
    result_.segment_edge.push_back(edge);
  }

  void collect_inserted() {
    std::sort(insert_.begin(), insert_.end());
    result_.first.assign(plc_.segments.size() + 1, 0);
    for (const auto& [segment, order, v] : insert_) {
      ++result_.first[segment + 1];
      result_.inserted.push_back(v);
    }
    for (std::size_t s = 0; s < plc_.segments.size(); ++s) result_.first[s + 1] += result_.first[s];
  }

  const Plc& plc_;
  const Geometry& geometry_;
  const LengthField& lengths_;
  const CurveOptions& options_;
  Context& context_;
  CurveSampling result_;
  std::vector<Chain> chains_;
  std::vector<Index> parts_;
  std::vector<Piece> pieces_;
  NearSamples near_;
  std::vector<std::array<Index, 3>> insert_;  // PLC segment, order along it, sample
};

}  // namespace

CurveSampling sample_curves(const Plc& plc, const Geometry& geometry, const LengthField& lengths,
                            const CurveOptions& options, Context& context) {
  return Sampler(plc, geometry, lengths, options, context).run();
}

}  // namespace dm
