#include "refinement/refine.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <limits>

#include "base/hilbert_curve.h"
#include "base/random.h"
#include "refinement/angle_test.h"
#include "refinement/boundary_flip.h"
#include "refinement/boundary_lengths.h"
#include "refinement/boundary_site.h"
#include "refinement/constrained_cavity.h"
#include "refinement/thin_gap.h"

namespace dm {

namespace {

// Measured on prototypes and again here; docs/refinement.md has the figures behind those that matter most.
constexpr int kTries = 40;
constexpr double kSlack = 1.15;      // circumradius over the bound up to which good tetrahedra stay
constexpr std::size_t kAhead = 6;    // tetrahedra in work whose data is asked for
constexpr int kEncroachedTries = 3;  // consecutive refusals by the boundary before it is split
constexpr int kHopeless = 10;        // sites on a triangle without one that may be, after which there is none
constexpr double kFirstPick = 0.1, kPickStep = 0.03, kLargestPick = 0.6;  // f_k of a site inside
constexpr double kSliverFirstPick = 0.3, kSliverLargestPick = 0.95;
constexpr double kLargestSurfacePick = 0.5;
constexpr double kTriangleFloor = 0.5;  // circumradius over wanted edge: smaller triangles are not split
constexpr double kWorthARound = 0.8;    // share of slivers left by a round above which there is no other
constexpr double kFewSlivers = 50;      // so few cost next to nothing: all rounds are tried
constexpr double kSpacing = 0.3;        // least distance of a site from all vertices, over rho
constexpr double kFarFacet = 4;         // circumradii from which on a site no longer encroaches
constexpr double kPassable = 0.5;  // angle that a boundary split in place of a sliver may make, over target
constexpr double kSegmentFloor = 0.6;  // length over wanted edge
constexpr double kRoom = 1.1;          // for vertices, over the sites expected

class Refinement {
 public:
  Refinement(LabelledTriangulation& mesh, const Geometry& geometry, const SizeField& size,
             const RefineOptions& options, Context& context, RefineReport& report)
      : mesh_(mesh),
        tets_(mesh.tets),
        geometry_(geometry),
        lengths_(lengths_inside(mesh, size)),
        bound_{lengths_},
        options_(options),
        context_(context),
        report_(report),
        target_(sharpness_of_angle(options.target_angle)),
        passable_(sharpness_of_angle(kPassable * options.target_angle)),
        thin_gaps_(mesh, geometry),
        constrained_search_(mesh.tets),
        boundary_site_(mesh, bound_, target_),
        count_(mesh.tets, options.limit),
        expected_sites_(std::max(1.0, size.predicted_tetrahedra() / 5.5)) {}

  void run() {
    count_.check();
    tets_.reserve_vertices(tets_.points().size() + static_cast<std::size_t>(kRoom * expected_sites_));
    settle_ears();
    collect();
    sort_along_curve(next_);
    drain();
    sliver_mode_ = true;
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (round_ = 1; round_ <= options_.sliver_rounds; ++round_) {
      collect_slivers();
      report_.slivers += static_cast<std::int64_t>(next_.size());
      const auto left = static_cast<double>(next_.size());
      if (left == 0 || (left > kFewSlivers && left > kWorthARound * static_cast<double>(before))) break;
      before = next_.size();
      drain();
    }
  }

 private:
  bool is_inside(Index tet) const { return !tets_.is_free(tet) && tets_.tag(tet) != 0; }
  double edge_size(const Vec3& p) const { return kBoundaryEdge * lengths_.at(p); }

  Sphere sphere_of(Index tet) const {
    const auto [a, b, c, d] = tets_.corners(tet);
    return circumsphere(tets_.point(a), tets_.point(b), tets_.point(c), tets_.point(d));
  }

  bool is_sharp(Index tet) const { return tet_sharpness(mesh_, tet) > target_; }

  // Beyond the bound; by up to kSlack only when its angles are not good, too: most tries would go into
  // splitting good tetrahedra that are hardly too big, next to others that are finished.
  bool is_big(Index tet, const Sphere& sphere) const {
    const double excess = bound_.excess(sphere, kSlack);
    return excess > 1 && (excess > kSlack || is_sharp(tet));
  }

  bool is_forced(Index tet) const {
    return thin_gaps_.holds(tet, edge_size(tets_.point(tets_.corners(tet)[0])));
  }
  bool is_bad(Index tet) const { return is_big(tet, sphere_of(tet)) || (sliver_mode_ && is_sharp(tet)); }

  // Rules R2 and R3 once for all tetrahedra: points of a sphere or a cylinder leave whole layers of flat
  // tetrahedra on the wrong side, and each would refuse sites one by one.
  void settle_ears() {
    constexpr int kPasses = 8;
    for (int pass = 0, changed = 1; changed && pass < kPasses; ++pass) {
      changed = 0;
      for (Index t = 0; t < tets_.slot_count(); ++t) {
        context_.tick(0);
        if (tets_.is_free(t) || std::popcount(tets_.marks(t)) != 2) continue;
        if (is_inside(t) && peel(mesh_, t, sphere_of(t).centre, false)) {
          ++changed;
          continue;
        }
        for (int i = 0; i < 4 && !is_inside(t); ++i)
          if (tets_.marked(t, i) && flip_in(mesh_, t, tets_.tag(tets_.neighbour(t, i) / 4))) ++changed;
      }
      report_.flips += changed;
    }
  }

  void push_if_bad(Index tet) {
    if (is_inside(tet) && is_bad(tet) && !is_forced(tet)) push(tet);
  }

  // Once, however often its slot is filled again meanwhile.
  void push(Index tet) {
    if (static_cast<Index>(waiting_.size()) <= tet)
      waiting_.resize(tets_.slot_count() + tets_.slot_count() / 8);
    if (waiting_[tet]) return;
    waiting_[tet] = true;
    next_.push_back(tet);
  }

  void collect() {
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      context_.tick(0);
      push_if_bad(t);
    }
  }

  // All of them; later only those tried in the last round, which are all there are unless tetrahedra have
  // changed sides meanwhile.
  void collect_slivers() {
    if (round_ == 1 || report_.flips != flips_before_) {
      collect();
    } else {
      std::sort(tried_.begin(), tried_.end());
      tried_.erase(std::unique(tried_.begin(), tried_.end()), tried_.end());
      for (const Index t : tried_) push_if_bad(t);
    }
    tried_.clear();
    flips_before_ = report_.flips;
  }

  // By the centroids: neighbours in the list are neighbours in memory.
  void sort_along_curve(std::deque<Index>& list) const {
    const auto curve = HilbertCurve::through(tets_.vertex_count(),
                                             [&](std::size_t v) -> const Vec3& { return tets_.point(v); });
    std::vector<std::pair<std::uint32_t, Index>> keyed;
    keyed.reserve(list.size());
    for (const Index t : list) {
      const auto [a, b, c, d] = tets_.corners(t);
      const Vec3 centre = 0.25 * (tets_.point(a) + tets_.point(b) + tets_.point(c) + tets_.point(d));
      keyed.emplace_back(curve.code(centre), t);
    }
    std::sort(keyed.begin(), keyed.end());
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = keyed[i].second;
  }

  // Rounds: what one round makes bad waits for the next.
  void drain() {
    while (!next_.empty()) {
      work_.swap(next_);
      for (; !work_.empty(); work_.pop_front()) {
        if (2 * kAhead < work_.size()) tets_.prefetch(work_[2 * kAhead]);
        if (kAhead < work_.size()) tets_.prefetch_points(work_[kAhead]);
        const Index tet = work_.front();
        waiting_[tet] = false;
        if (sliver_mode_) tried_.push_back(tet);
        process(tet);
        count_.check();
      }
    }
  }

  void process(Index tet) {
    if (!is_inside(tet)) return;
    const Sphere sphere = sphere_of(tet);
    const bool big = is_big(tet, sphere);
    const bool sharp = sliver_mode_ && is_sharp(tet);
    if (!big && !sharp) return;
    context_.poll(0.95 * static_cast<double>(report_.sites) / expected_sites_);
    if (peel(mesh_, tet, sphere.centre, sharp)) {
      ++report_.flips;
      return;
    }
    acceptable_ = !sliver_mode_ ? kRejected
                  : sharp       ? std::min(tet_sharpness(mesh_, tet), passable_)
                                : target_;
    if (insert_inside(tet, sphere, big, false) || insert_on_boundary(tet)) return;
    if (sharp && split_own_boundary(tet)) return;
    if (big) insert_inside(tet, sphere, big, true);
  }

  // Tries random sites round the circumcentre.  False when the boundary is in the way, or a sliver has no
  // room for a site; `constrained` sites keep to this side of it.
  bool insert_inside(Index tet, const Sphere& sphere, bool big, bool constrained) {
    const std::uint16_t tag = tets_.tag(tet);
    const double radius = std::sqrt(sphere.radius2);
    Tet key = tets_.corners(tet);
    std::sort(key.begin(), key.end());
    double best = kRejected;
    Vec3 best_site;
    bool best_constrained = false;
    int refused = 0;
    const int patience = round_ <= 1 ? kEncroachedTries : kTries;
    hits_.clear();
    for (int k = 0; k < kTries; ++k) {
      const double f = big ? std::min(kLargestPick, kFirstPick + kPickStep * k)
                           : std::min(kSliverLargestPick, kSliverFirstPick + kPickStep * k);
      Random random(context_.seed, key[0], key[1], key[2], key[3], k, round_);
      const Vec3 site = sphere.centre + (f * radius) * random.in_ball();
      ++report_.tries;
      constrained_ = constrained;
      const bool found = constrained ? constrained_search_.find_cavity(site, tet, cavity_)
                                     : find_cavity_inside(site, tet, tag);
      if (!found) {
        ++report_.encroached;
        if (++refused >= patience && best == kRejected) break;
        continue;
      }
      if (cavity_.border.empty() || ((constrained_ || !big) && is_crowded(cavity_, site))) continue;
      const double s = evaluate_site(mesh_, cavity_, site, bound_, target_, best);
      if (s == kRejected) ++refused;
      if (s <= target_ && commit_inside(site, constrained_)) return true;
      if (s < best) best = s, best_site = site, best_constrained = constrained_;
    }
    if (!constrained && (refused || !big)) return false;
    if (big && best < kRejected) relax(tet, best_site, best_constrained);
    return true;
  }

  // What makes the refinement end: no site comes nearer to a vertex than this (a site for a big tetrahedron
  // keeps that distance by itself).
  bool is_crowded(const Cavity& cavity, const Vec3& site) const {
    return nearest_corner2(tets_, cavity, site) < kSpacing * kSpacing * bound_.squared(site);
  }

  // The best site seen although it misses the target; the slivers it leaves are cured in later rounds.
  void relax(Index tet, const Vec3& site, bool constrained) {
    const bool found = constrained ? constrained_search_.find_cavity(site, tet, cavity_)
                                   : tets_.find_cavity(site, tet, true, cavity_) < 0;
    if (!found || cavity_.tets.empty()) return;
    report_.relaxed += commit_inside(site, constrained);
  }

  // False when the site encroaches on the boundary: its cavity would swallow a labelled triangle.
  bool find_cavity_inside(const Vec3& site, Index tet, std::uint16_t tag) {
    for (int flips = 0; flips < 8; ++flips) {
      const Face f = tets_.find_cavity(site, tet, true, cavity_);
      if (f < 0) return true;
      Index beyond = tets_.neighbour(f / 4, f % 4) / 4;
      if (tets_.tag(beyond) == tag) beyond = f / 4;
      if (!flip_in(mesh_, beyond, tag)) {
        const Index label = label_of(f);
        if (is_far(label, site)) return constrained_ = constrained_search_.find_cavity(site, tet, cavity_);
        remember_hit(label);
        return false;
      }
      ++report_.flips;
    }
    return false;
  }

  Index label_of(Face f) const {
    Index tet = f / 4;
    int i = f % 4;
    if (tets_.is_ghost(tet)) {
      const Face g = tets_.neighbour(tet, i);
      tet = g / 4, i = g % 4;
    }
    return dm::label_of(mesh_, tet, i);
  }

  // Splitting a labelled triangle cannot help a site that is many of its radii away.
  bool is_far(Index label, const Vec3& site) const {
    const Triangle& q = mesh_.boundary.corners(label);
    const Sphere circle = circumcircle(tets_.point(q[0]), tets_.point(q[1]), tets_.point(q[2]));
    return norm2(site - circle.centre) > kFarFacet * kFarFacet * circle.radius2;
  }

  void remember_hit(Index label) {
    for (auto& [triangle, count] : hits_)
      if (triangle == label) return void(++count);
    hits_.push_back({label, 1});
  }

  // False when the cavity found is not a ball, as those of constrained sites may leave it.
  bool commit_inside(const Vec3& site, bool constrained) {
    if (report_.constrained && !is_ball(tets_, cavity_)) return false;
    tets_.insert(site, cavity_);
    ++report_.sites;
    report_.constrained += constrained;
    for (const Index t : cavity_.created) push_if_bad(t);
    return true;
  }

  // Splits the labelled triangle that refused most sites; false when it may not be split.
  bool insert_on_boundary(Index tet) {
    Index worst = -1;
    int most = 0;
    for (const auto& [triangle, count] : hits_)
      if (count > most && mesh_.boundary.alive(triangle)) worst = triangle, most = count;
    if (worst < 0 || !split_triangle(worst, tet)) return false;
    push_if_bad(tet);
    return true;
  }

  // A flat tetrahedron below a smooth join of CAD faces: its sphere holds next to nothing of the solid, and
  // its labelled faces cannot be flipped because the CAD edge must stay.
  bool split_own_boundary(Index tet) {
    for (int i = 0; i < 4; ++i)
      if (tets_.marked(tet, i) && split_triangle(dm::label_of(mesh_, tet, i), tet)) return true;
    const Tet v = tets_.corners(tet);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        if (mesh_.boundary.is_segment(v[i], v[j]) && split_segment(v[i], v[j], tet)) return true;
    return false;
  }

  bool split_triangle(Index t, Index hint) {
    const Triangle q = mesh_.boundary.corners(t);
    const Sphere circle = circumcircle(tets_.point(q[0]), tets_.point(q[1]), tets_.point(q[2]));
    const Vec3 normal = area_vector(tets_.point(q[0]), tets_.point(q[1]), tets_.point(q[2]));
    const double radius = std::sqrt(circle.radius2);
    if (!(radius >= kTriangleFloor * edge_size(circle.centre)) || !std::isfinite(radius)) return false;
    if (static_cast<Index>(failures_.size()) <= t) failures_.resize(mesh_.boundary.slot_count());
    if (failures_[t].stands(acceptable_, round_)) return false;
    const Face own = find_face(tets_, q[0], q[1], q[2]);
    if (own < 0) return false;
    const Index near = own / 4;
    const Index face = mesh_.boundary.face(t);
    double best = kRejected;
    Vec3 best_site;
    segments_.clear();
    for (int k = 0; k < kTries && (k < kHopeless || best < kRejected); ++k) {
      Random random(context_.seed, q[0], q[1], q[2], k, 3);
      const double f = std::min(kLargestSurfacePick, kFirstPick + kPickStep * k);
      const Vec3 site =
          geometry_.project_to_face(face, circle.centre + (f * radius) * random.in_ball(), normal);
      const SiteVerdict verdict = boundary_site_.propose(site, near, t, -1, -1);
      if (verdict == SiteVerdict::segment) {
        remember_segment(boundary_site_.swallowed_segment());
        if (k >= kEncroachedTries && best == kRejected) break;
      }
      if (verdict != SiteVerdict::ok || is_crowded(boundary_site_.cavity(), site)) continue;
      if (boundary_site_.quality() <= target_) return commit_boundary(report_.triangle_splits);
      if (boundary_site_.quality() < best) best = boundary_site_.quality(), best_site = site;
    }
    if (best < acceptable_ && boundary_site_.propose(best_site, near, t, -1, -1) == SiteVerdict::ok)
      return commit_boundary(report_.triangle_splits);
    if (split_any_segment(hint)) return true;
    failures_[t] = {best, round_};
    return false;
  }

  void remember_segment(const Segment& s) {
    if (std::find(segments_.begin(), segments_.end(), s) == segments_.end()) segments_.push_back(s);
  }

  bool split_any_segment(Index hint) {
    const std::vector<Segment> candidates(segments_);
    return std::any_of(candidates.begin(), candidates.end(),
                       [&](const Segment& s) { return split_segment(s[0], s[1], hint); });
  }

  bool split_segment(Index a, Index b, Index hint) {
    const Vec3 pa = tets_.point(a), pb = tets_.point(b);
    if (distance(pa, pb) < kSegmentFloor * edge_size(0.5 * (pa + pb))) return false;
    const Index edge = mesh_.boundary.segment(a, b);
    if (edge < 0) return false;
    double best = kRejected;
    Vec3 best_site;
    for (int k = 0; k < kTries; ++k) {
      Random random(context_.seed, std::min(a, b), std::max(a, b), k, 4);
      const double w = 0.5 + std::min(0.25, 0.02 + 0.01 * k) * random.symmetric();
      const Vec3 site = geometry_.project_to_edge(edge, w * pa + (1 - w) * pb);
      if (boundary_site_.propose(site, hint, -1, a, b) != SiteVerdict::ok) continue;
      if (is_crowded(boundary_site_.cavity(), site)) continue;
      if (boundary_site_.quality() <= target_) return commit_boundary(report_.segment_splits);
      if (boundary_site_.quality() < best) best = boundary_site_.quality(), best_site = site;
    }
    if (best >= acceptable_) return false;
    return boundary_site_.propose(best_site, hint, -1, a, b) == SiteVerdict::ok &&
           commit_boundary(report_.segment_splits);
  }

  bool commit_boundary(std::int64_t& counter) {
    if (report_.constrained && !boundary_site_.is_ball()) return false;
    ++counter;
    for (const Index t : boundary_site_.commit()) push_if_bad(t);
    return true;
  }

  // The best sharpness that splitting a labelled triangle could have reached, and when that was not enough.
  // It is tried again in a later round of slivers, but not by all the tetrahedra round it in the same one.
  struct SplitFailure {
    double best = 0;
    int round = -1;
    bool stands(double acceptable, int now) const {
      return (round == now || round == 0) && best >= acceptable;
    }
  };

  LabelledTriangulation& mesh_;
  Triangulation& tets_;
  const Geometry& geometry_;
  const LengthField lengths_;
  RadiusBound bound_;
  const RefineOptions& options_;
  Context& context_;
  RefineReport& report_;
  double target_;                  // sharpness of the target angle
  double passable_;                // sharpness that a boundary split may leave to the next round of slivers
  double acceptable_ = kRejected;  // sharpness that a boundary split must stay below
  ThinGaps thin_gaps_;
  ConstrainedSearch constrained_search_;
  BoundarySite boundary_site_;
  ElementCount count_;
  double expected_sites_;
  bool sliver_mode_ = false, constrained_ = false;
  int round_ = 0;
  std::vector<SplitFailure> failures_;  // of labelled triangles
  Cavity cavity_;
  std::deque<Index> work_, next_;            // deques give memory back as they are used up
  std::vector<Index> tried_;                 // in the last round of slivers
  std::vector<bool> waiting_;                // by tetrahedron: in work_ or next_
  std::int64_t flips_before_ = 0;            // that round
  std::vector<std::pair<Index, int>> hits_;  // labelled triangles that refused a site, and how often
  std::vector<Segment> segments_;            // segments that surface sites would swallow
};

}  // namespace

void refine(LabelledTriangulation& mesh, const Geometry& geometry, const SizeField& size,
            const RefineOptions& options, Context& context, RefineReport& report) {
  context.begin("refinement");
  Refinement(mesh, geometry, size, options, context, report).run();
}

void mark_acute_segments(LabelledTriangulation& mesh, double angle) {
  BoundaryComplex& complex = mesh.boundary;
  const auto& p = mesh.tets.points();
  BoundaryComplex::Fan fan;
  for (const auto& [key, edge] : complex.segments()) {
    const auto [a, b] = BoundaryComplex::segment_of_key(key);
    const int n = complex.triangles_at(a, b, fan);
    const Vec3 axis = normalized(p[b] - p[a]);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j) {
        const auto away = [&](Index t) {
          const Vec3 w = p[opposite_corner(complex, t, a, b)] - p[a];
          return normalized(w - dot(w, axis) * axis);
        };
        const Vec3 one = away(fan[i]), other = away(fan[j]);
        const double opening = std::acos(std::clamp(dot(one, other), -1.0, 1.0));
        const auto& [q, r, s] = complex.corners(fan[i]);
        const bool in_front = dot(area_vector(p[q], p[r], p[s]), other) > 0;
        const bool solid_between = complex.solids(fan[i])[in_front] != 0;
        if (solid_between && opening * 180 / std::numbers::pi < angle) complex.set_acute(a, b);
      }
  }
}

}  // namespace dm
