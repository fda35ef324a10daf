#include "boundary/recover_triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"

namespace dm {

namespace {

constexpr int kMaxRounds = 60;
constexpr int kAttempts = 5;  // of splitting, where it fails at some place; the last one does without
// Rounds with more missing triangles than ever before, and splits per triangle (and in any case), after which
// splitting is given up: it does not help where faces cross.
constexpr int kWorseRounds = 2;
constexpr Index kMostSplitsShare = 4, kMostSplits = 1000;
// Splitting floors, relative to the edge length there: below them a constraint counts as unrecoverable.
constexpr double kSegmentFloor = 0.1, kTriangleFloor = 0.1;
// Least distance of a new point from all others, relative to the same: what makes the splitting end.
constexpr double kSpacing = 0.04;

class Recovery {
 public:
  // hopeless: boundary points whose triangles are not split.
  Recovery(LabelledTriangulation& mesh, const Geometry& geometry, const SizeField& size,
           const std::vector<char>& hopeless, Context& context, RecoveryReport& report)
      : tets_(mesh.tets),
        complex_(mesh.boundary),
        geometry_(geometry),
        size_(size),
        hopeless_(hopeless),
        context_(context),
        report_(report),
        origin_(mesh.tets.points().size()) {
    std::iota(origin_.begin(), origin_.end(), 0);
  }

  // missing: the labelled triangles that are no faces yet.  Returns those that could not be recovered.
  std::vector<Index> run(std::vector<Index> missing) {
    measure_edges();
    present_.assign(complex_.slot_count(), 1);
    missing_ = std::move(missing);
    for (const Index t : missing_) present_[t] = 0;
    report_.missing_at_start = static_cast<Index>(missing_.size());
    const Index most_splits = std::max(kMostSplits, complex_.slot_count() / kMostSplitsShare);
    std::size_t fewest = missing_.size();
    for (int round = 0, worse = 0; round < kMaxRounds && !missing_.empty(); ++round) {
      worse = missing_.size() > fewest ? worse + 1 : 0;
      fewest = std::min(fewest, missing_.size());
      if (worse > kWorseRounds || splits() > most_splits) break;
      const double fraction = 1 - 1.0 / (round + 2);
      std::vector<Index> work;
      work.swap(missing_);
      std::sort(work.begin(), work.end());
      work.erase(std::unique(work.begin(), work.end()), work.end());
      stuck_.clear();
      for (const Index t : work) {
        context_.poll(fraction);
        if (is_missing(t) && !flip(t)) later_.push_back(t);
      }
      for (const Index t : later_) {
        context_.poll(fraction);
        if (!is_missing(t)) continue;
        if (splits() > most_splits || !split(t))
          stuck_.push_back(t);
        else if (is_missing(t))
          missing_.push_back(t);  // a segment near it was split
      }
      later_.clear();
      if (missing_.empty() && !stuck_.empty()) break;
      missing_.insert(missing_.end(), stuck_.begin(), stuck_.end());
    }
    missing_.insert(missing_.end(), stuck_.begin(), stuck_.end());
    std::vector<Index> left;
    for (const Index t : missing_)
      if (is_missing(t)) left.push_back(t);
    return left;
  }

  // Corners of the triangles, or where a corner is new the point that it comes from.
  std::vector<Index> origins(const std::vector<Index>& triangles) const {
    std::vector<Index> found;
    for (const Index t : triangles)
      for (const Index v : complex_.corners(t)) found.push_back(origin_[v]);
    return found;
  }

 private:
  Index splits() const { return report_.segment_splits + report_.triangle_splits; }
  const std::vector<Vec3>& points() const { return tets_.points(); }
  bool is_missing(Index t) const { return complex_.alive(t) && !present_[t]; }
  // The mean length of the labelled edges at each point, as the surfaces stage left them.
  void measure_edges() {
    edge_at_.assign(points().size(), 0);
    std::vector<int> count(points().size(), 0);
    for (Index t = 0; t < complex_.slot_count(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Index a = complex_.corners(t)[i], b = complex_.corners(t)[(i + 1) % 3];
        const double l = distance(points()[a], points()[b]);
        edge_at_[a] += l, edge_at_[b] += l;
        ++count[a], ++count[b];
      }
    for (std::size_t v = 0; v < count.size(); ++v)
      if (count[v]) edge_at_[v] /= count[v];
  }

  // The edge length that splitting goes by: what is wanted, or what narrow places already have.
  template <class Points>
  double edge_size(const Vec3& p, const Points& corners) const {
    double sum = 0;
    for (const Index v : corners) sum += edge_at_[v];
    return std::min(kBoundaryEdge * size_.at(p), sum / static_cast<double>(std::size(corners)));
  }

  void label(Index t) {
    present_.resize(complex_.slot_count(), 0);
    const Triangle& q = complex_.corners(t);
    const Face f = find_face(tets_, q[0], q[1], q[2]);
    present_[t] = f >= 0;
    if (f >= 0)
      set_marked_both(tets_, f, true);
    else
      missing_.push_back(t);
  }

  void unlabel(Index t) {
    if (!present_[t]) return;
    const Triangle& q = complex_.corners(t);
    const Face f = find_face(tets_, q[0], q[1], q[2]);
    if (f >= 0) set_marked_both(tets_, f, false);
    present_[t] = 0;
  }

  bool flip(Index t) {
    const Triangle q = complex_.corners(t);
    for (int i = 0; i < 3; ++i) {
      EdgeFlip f;
      if (!can_flip(complex_, points(), q[i], q[(i + 1) % 3], f)) continue;
      if (find_face(tets_, f.c, f.a, f.d) < 0 || find_face(tets_, f.d, f.b, f.c) < 0) continue;
      apply(f);
      ++report_.flips;
      return true;
    }
    return false;
  }

  void apply(const EdgeFlip& f) {
    unlabel(f.first);
    unlabel(f.second);
    for (const Index t : do_flip(complex_, f)) label(t);
  }

  bool split(Index t) {
    const Triangle q = complex_.corners(t);
    if (hopeless_[origin_[q[0]]] || hopeless_[origin_[q[1]]] || hopeless_[origin_[q[2]]]) return false;
    Index sa = -1, sb = -1;
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
      const Index a = q[i], b = q[(i + 1) % 3];
      const double l = distance(points()[a], points()[b]);
      if (l <= longest || !complex_.is_segment(a, b) || has_edge(a, b)) continue;
      sa = a, sb = b, longest = l;
    }
    return sa >= 0 ? split_segment(sa, sb) : split_triangle(t);
  }

  bool has_edge(Index a, Index b) const {
    BoundaryComplex::Fan fan;
    const int n = complex_.triangles_at(a, b, fan);
    for (int i = 0; i < n; ++i)
      if (present_[fan[i]]) return true;
    return dm::has_edge(tets_, a, b);
  }

  // At (1 - ratio) a + ratio b; without a ratio where split_ratio says.
  bool split_segment(Index a, Index b, double ratio = 0) {
    const Vec3 pa = points()[a], pb = points()[b];
    const double l = distance(pa, pb);
    const double edge = edge_size(0.5 * (pa + pb), Segment{a, b});
    if (l < kSegmentFloor * edge) return false;
    Random random(context_.seed, a, b, 1);
    const double w = ratio > 0 ? ratio : split_ratio(a, b, l, random);
    const Vec3 p = geometry_.project_to_edge(complex_.segment(a, b), (1 - w) * pa + w * pb);
    const Index v = insert(p, a, edge);
    if (v < 0) return false;
    BoundaryComplex::Fan fan;
    const int n = complex_.triangles_at(a, b, fan);
    complex_.split_segment(a, b, v);
    split_fan(a, b, v, fan, n);
    ++report_.segment_splits;
    return true;
  }

  // Segments at a corner split at a power of two from it, so that the pieces round an acute corner match
  // (concentric shells, Shewchuk 1998); elsewhere near the middle, at random: exact middles make
  // cosphericals.
  double split_ratio(Index a, Index b, double l, Random& random) const {
    const bool corner_a = complex_.entity(a).dimension == 0, corner_b = complex_.entity(b).dimension == 0;
    if (corner_a == corner_b) return 0.5 + 0.1 * random.symmetric();
    const double unit = std::exp2(std::round(std::log2(0.5 * l)));
    const double w = std::clamp(unit / l, 0.25, 0.75);
    return corner_a ? w : 1 - w;
  }

  bool split_triangle(Index t) {
    const Triangle q = complex_.corners(t);
    const Vec3 a = points()[q[0]], b = points()[q[1]], c = points()[q[2]];
    const Sphere circle = circumcircle(a, b, c);
    const double r = std::sqrt(circle.radius2);
    const Vec3 middle = (1.0 / 3) * (a + b + c);
    const double edge = edge_size(middle, q);
    if (r < kTriangleFloor * edge) return false;
    int apex = 0;
    double longest2 = 0;
    for (int i = 0; i < 3; ++i) {
      const double l2 = norm2(points()[q[(i + 1) % 3]] - points()[q[(i + 2) % 3]]);
      if (l2 > longest2) longest2 = l2, apex = i;
    }
    const Index u = q[(apex + 1) % 3], v = q[(apex + 2) % 3];
    const Vec3 pu = points()[u], pv = points()[v], top = points()[q[apex]];
    const bool obtuse = dot(pu - top, pv - top) < 0;
    Random random(context_.seed, q[0], q[1], q[2], 2);
    const double foot = dot(top - pu, pv - pu) / longest2 + 0.05 * random.symmetric();
    const double w = std::clamp(foot, 0.2, 0.8);
    if (obtuse && complex_.is_segment(u, v)) return split_segment(u, v, w);
    const Index face = complex_.face(t);
    Vec3 p = circle.centre + (0.2 * r) * random.in_ball();
    if (obtuse)
      p = (1 - w) * pu + w * pv;
    else if (!well_inside(p, q, 0.15 * r))
      p = 0.7 * middle + 0.3 * circle.centre;
    p = geometry_.project_to_face(face, p, area_vector(a, b, c));
    const Segment near = encroached_segment(q, p);
    if (near[0] >= 0) return split_segment(near[0], near[1]);
    return obtuse ? split_edge(u, v, face, p, edge) : split_inside(t, p, edge);
  }

  // A segment round the triangle whose diametral ball holds p: it is split instead (Ruppert 1995), or points
  // would pile up beside it.
  Segment encroached_segment(const Triangle& q, const Vec3& p) const {
    for (const Index corner : q)
      for (const Index t : complex_.triangles_at(corner)) {
        const Triangle& near = complex_.corners(t);
        for (int i = 0; i < 3; ++i) {
          const Index a = near[i], b = near[(i + 1) % 3];
          if (dot(points()[a] - p, points()[b] - p) < 0 && complex_.is_segment(a, b)) return {a, b};
        }
      }
    return {-1, -1};
  }

  bool split_inside(Index t, const Vec3& p, double edge) {
    const Triangle q = complex_.corners(t);
    const Index face = complex_.face(t);
    const Index w = insert(p, q[0], edge);
    if (w < 0) return false;
    complex_.set_entity(w, {2, face});
    unlabel(t);
    complex_.remove(t);
    for (int i = 0; i < 3; ++i) complex_.add(q[i], q[(i + 1) % 3], w, face);
    finish_split(w);
    ++report_.triangle_splits;
    return true;
  }

  bool split_edge(Index a, Index b, Index face, const Vec3& p, double edge) {
    BoundaryComplex::Fan fan;
    const int n = complex_.triangles_at(a, b, fan);
    const Index v = insert(p, a, edge);
    if (v < 0) return false;
    complex_.set_entity(v, {2, face});
    split_fan(a, b, v, fan, n);
    ++report_.triangle_splits;
    return true;
  }

  bool well_inside(const Vec3& p, const Triangle& q, double margin) const {
    const Vec3 normal = normalized(area_vector(points()[q[0]], points()[q[1]], points()[q[2]]));
    for (int i = 0; i < 3; ++i) {
      const Vec3 e = points()[q[(i + 1) % 3]] - points()[q[i]];
      if (dot(cross(normal, normalized(e)), p - points()[q[i]]) < margin) return false;
    }
    return true;
  }

  // Every triangle at edge (a, b) becomes two.
  void split_fan(Index a, Index b, Index v, const BoundaryComplex::Fan& fan, int n) {
    for (int i = 0; i < n; ++i) {
      const Index t = fan[i];
      const Triangle q = complex_.corners(t);
      const Index face = complex_.face(t);
      unlabel(t);
      complex_.remove(t);
      for (const Index replaced : {a, b}) {
        Triangle piece = q;
        std::replace(piece.begin(), piece.end(), replaced, v);
        complex_.add(piece[0], piece[1], piece[2], face);
      }
    }
    finish_split(v);
  }

  // Labels the new triangles and restores the surface Delaunay property round v.
  void finish_split(Index v) {
    std::vector<Segment> stack;
    const std::vector<Index> star(complex_.triangles_at(v).begin(), complex_.triangles_at(v).end());
    for (const Index t : star) {
      label(t);
      const Triangle& q = complex_.corners(t);
      for (int i = 0; i < 3; ++i)
        if (q[i] != v && q[(i + 1) % 3] != v) stack.push_back({q[i], q[(i + 1) % 3]});
    }
    for (int guard = 0; !stack.empty() && guard < 500; ++guard) {
      const auto [a, b] = stack.back();
      stack.pop_back();
      EdgeFlip f;
      if (!can_flip(complex_, points(), a, b, f) || !flip_improves(points(), f)) continue;
      apply(f);
      for (const Index x : {f.c, f.d})
        for (const Index y : {f.a, f.b}) stack.push_back({x, y});
    }
  }

  // New Delaunay vertex; labelled triangles whose face vanished become missing.
  Index insert(const Vec3& p, Index near, double edge) {
    const Index start = tets_.locate(p, tets_.vertex_tet(near));
    if (start < 0) return -1;
    tets_.find_cavity(p, start, false, cavity_);
    if (cavity_.border.empty() || nearest_distance(p) < kSpacing * edge) return -1;
    for (const Index tet : cavity_.tets) {
      if (!tets_.marks(tet) || tets_.is_ghost(tet)) continue;
      const Tet& v = tets_.corners(tet);
      for (int i = 0; i < 4; ++i) {
        if (!tets_.marked(tet, i)) continue;
        const Index t = complex_.find(v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3]);
        if (t >= 0) touched_.push_back(t);
      }
    }
    const Index v = tets_.insert(p, cavity_);
    edge_at_.push_back(edge);
    origin_.push_back(origin_[near]);
    for (const Index t : touched_) {
      const Triangle& q = complex_.corners(t);
      if (find_face(tets_, q[0], q[1], q[2]) >= 0) continue;
      present_[t] = 0;
      missing_.push_back(t);
    }
    touched_.clear();
    return v;
  }

  // Distance from p to the nearest vertex of its cavity, which is its nearest vertex at all.
  double nearest_distance(const Vec3& p) const {
    double nearest2 = HUGE_VAL;
    for (const Index tet : cavity_.tets)
      for (const Index v : tets_.corners(tet))
        if (v != Triangulation::ghost) nearest2 = std::min(nearest2, norm2(points()[v] - p));
    return std::sqrt(nearest2);
  }

  Triangulation& tets_;
  BoundaryComplex& complex_;
  const Geometry& geometry_;
  const SizeField& size_;
  const std::vector<char>& hopeless_;
  Context& context_;
  RecoveryReport& report_;
  std::vector<double> edge_at_;  // per point
  std::vector<Index> origin_;    // per point: itself, or for a new one a point of the triangle it was put in
  std::vector<char> present_;    // per labelled triangle: is it a face of the triangulation?
  std::vector<Index> missing_, later_, stuck_, touched_;
  Cavity cavity_;
};

// Marks the points, and those joined to them by so many edges; false when all were marked before.
bool mark_round(const BoundaryComplex& boundary, std::vector<Index> points, int edges,
                std::vector<char>& marked) {
  bool more = false;
  for (; edges > 0; --edges) {
    std::vector<Index> round;
    for (const Index v : points)
      for (const Index t : boundary.triangles_at(v))
        for (const Index w : boundary.corners(t)) {
          if (marked[w]) continue;
          marked[w] = more = true;
          round.push_back(w);
        }
    points = std::move(round);
  }
  return more;
}

}  // namespace

std::vector<Index> recover_triangles(LabelledTriangulation& mesh, const Geometry& geometry,
                                     const SizeField& size, const std::vector<Index>& missing, bool may_split,
                                     Context& context, RecoveryReport& report) {
  if (missing.empty()) return {};
  const LabelledTriangulation start = mesh;
  const RecoveryReport start_report = report;
  std::vector<char> hopeless(mesh.tets.points().size(), !may_split);
  for (int attempt = 1;; ++attempt) {
    Recovery recovery(mesh, geometry, size, hopeless, context, report);
    const std::vector<Index> left = recovery.run(missing);
    if (!mark_round(start.boundary, recovery.origins(left), attempt, hopeless)) return left;
    if (attempt + 1 == kAttempts) hopeless.assign(hopeless.size(), 1);
    mesh = start;
    report = start_report;
  }
}

}  // namespace dm
