#include "optimisation/rescue.h"

namespace dm {
namespace {

constexpr double kGain = 1e-2;  // of the worst badness
constexpr double kLeft = 0.9;   // of the shortfall, where the worst stays
constexpr int kEdges = 2;       // that are contracted
constexpr int kSteps = 3;       // of a follow-up
constexpr int kPasses = 3;      // of smoothing and flips
constexpr double kBad = 0.5;    // elements worse than this are worked on
constexpr double kHope = 1;     // progress of a pass relative to the one before, if all goes well
constexpr int kPatient = 2;     // the effort whose trials are not given up early
constexpr Index kEarned = 4;    // tries, by each that helped
struct Effort {
  double angle;        // degrees: elements below it are worth it
  Index tries, share;  // so many are tried, and one more for so many tetrahedra
};
constexpr Effort kEfforts[] = {{30, 3000, 16}, {30, 1500, 80}, {28, 1500, 80}, {30, 3000, 40}};

}  // namespace

Rescuer::Rescuer(EditMesh& mesh, Smoother& smoother, Flipper& flipper, Contractor& contractor,
                 const Geometry& geometry)
    : mesh_(mesh),
      smoother_(smoother),
      flipper_(flipper),
      contractor_(contractor),
      inserter_(mesh, smoother, geometry),
      geometry_(geometry) {
  for (int i = 0; i <= kMostEffort; ++i)
    tries_left_[i] = kEfforts[i].tries + mesh.slot_count() / kEfforts[i].share;
}

// Is the smallest angle one between two CAD faces, which no change of the mesh opens?
bool Rescuer::is_fixed(Index tet) {
  const Tet& c = mesh_.tet(tet);
  const auto cosines =
      dihedral_cosines(mesh_.point(c[0]), mesh_.point(c[1]), mesh_.point(c[2]), mesh_.point(c[3]));
  const auto sharpest = std::max_element(cosines.begin(), cosines.end());
  const auto [i, j] = kFacePairs[sharpest - cosines.begin()];
  if (!mesh_.marked(tet, i) || !mesh_.marked(tet, j)) return false;
  Segment ends{};
  int count = 0;
  for (int k = 0; k < 4; ++k)
    if (k != i && k != j) ends[count++] = c[k];
  return mesh_.is_segment(ends[0], ends[1]) && *sharpest - 1.0 / 3 >= mesh_.bad(tet) - 1e-6;
}

// Smooths v and the points of its bad tetrahedra and flips those.  Gives up when further passes as good as
// the last one would not be enough.
void Rescuer::settle(Index v) {
  double worst = badness(mesh_.trial_now());
  for (int pass = 0; pass < kPasses && mesh_.vertex_tet(v) >= 0; ++pass) {
    const auto star = mesh_.star(v);
    tets_.assign(star.begin(), star.end());
    std::erase_if(tets_, [&](Index t) { return mesh_.bad(t) < kBad; });
    points_.assign(1, v);
    for (const Index t : tets_)
      for (const Index w : mesh_.tet(t))
        if (std::find(points_.begin(), points_.end(), w) == points_.end()) points_.push_back(w);
    for (const Index w : points_) smoother_.smooth_worst(w, 2);
    for (const Index t : tets_)
      if (!mesh_.removed(t) && mesh_.bad(t) >= kBad && !flipper_.improve(t))
        flipper_.improve_boundary(t, geometry_);
    const double now = badness(mesh_.trial_now()), missing = now - badness(mesh_.trial_before());
    if (effort_ != kPatient && missing > kHope * (kPasses - 1 - pass) * (worst - now)) return;
    worst = now;
  }
}

bool Rescuer::is_better() const {
  const AngleCosines before = mesh_.trial_before(), now = mesh_.trial_now();
  const double fall = badness(before) - badness(now);
  if (fall < -kRounding || !keeps_angles(before, now)) return false;
  return fall > kGain || mesh_.trial_shortfall() < kLeft * mesh_.trial_shortfall_before();
}

// Points on the longest boundary edges of what is worst now: a strip or gap narrower than the elements beside
// it needs several.
void Rescuer::follow_up() {
  for (int step = 0; step < kSteps && !is_better(); ++step) {
    const Index worst = mesh_.trial_worst();
    if (worst < 0) return;
    int place = 1;
    while (place <= kEdges && !inserter_.insert(worst, place)) ++place;
    if (place > kEdges) return;
    settle(mesh_.vertex_count() - 1);
  }
}

// One trial.  `change` returns the point to settle, -1 when it is not possible.  What failed is not tried
// again before something beside its points has changed.
template <class Change>
bool Rescuer::attempt(const Site& site, Index last_change, bool deep, Change change) {
  const auto [it, is_new] = failed_.try_emplace(site, 0);
  if (it->second >= last_change || tries_left_[effort_] == 0) return false;
  ++tries_;
  --tries_left_[effort_];
  mesh_.begin_trial();
  const Index v = change();
  if (v >= 0) {
    settle(v);
    if (deep) follow_up();
  }
  const bool better = v >= 0 && is_better();
  mesh_.end_trial(better);
  if (better) tries_left_[effort_] += kEarned;
  it->second = mesh_.now();
  return better;
}

bool Rescuer::insert(Index tet, int place, bool deep) {
  const Triangle points = inserter_.site(tet, place);
  if (place > 0 && points[0] < 0) return false;
  const Index kind = deep ? kDeepInsertion : kInsertion;
  Index last = 0;
  for (const Index v : points)
    if (v >= 0) last = std::max(last, mesh_.last_change(v));
  const auto change = [&] { return inserter_.insert(tet, place) ? mesh_.vertex_count() - 1 : -1; };
  if (place == 0) return attempt({kind, tet, -1, -1}, mesh_.last_change(mesh_.tet(tet)), deep, change);
  return attempt({kind, points[0], points[1], points[2]}, last, deep, change);
}

// Edges by their length, the shortest first, each to either end.
bool Rescuer::contract(Index tet, int first, int last, bool deep) {
  const Tet c = mesh_.tet(tet);
  std::vector<std::pair<double, Segment>> edges;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      edges.push_back({distance(mesh_.point(c[i]), mesh_.point(c[j])), {c[i], c[j]}});
  std::sort(edges.begin(), edges.end());
  for (int k = first; k < last; ++k)
    for (int end = 0; end < 2; ++end) {
      const Index from = edges[k].second[end], to = edges[k].second[1 - end];
      const Index change_before = std::max(mesh_.last_change(from), mesh_.last_change(to));
      const auto change = [&] { return contractor_.contract(from, to) ? to : -1; };
      const Index kind = deep ? kDeepContraction : kContraction;
      if (attempt({kind, from, to, -1}, change_before, deep, change)) return true;
    }
  return false;
}

bool Rescuer::insert(Index tet, int first, int last, bool deep) {
  for (int place = first; place < last; ++place)
    if (insert(tet, place, deep)) return true;
  return false;
}

// One corner, then two together, each in all directions: out of a place that is the best only among those
// near it.
bool Rescuer::shift(Index tet) {
  const Tet c = mesh_.tet(tet);
  for (int apart = 0; apart < 4; ++apart)
    for (int i = 0; i < 4; ++i)
      for (Index k = 0; k < 8; ++k) {
        const Index v = c[i], w = c[(i + apart) % 4];
        const auto change = [&] {
          return smoother_.shift(v, k) && (w == v || smoother_.shift(w, (k + apart) % 8)) ? v : -1;
        };
        const Index last_change = std::max(mesh_.last_change(v), mesh_.last_change(w));
        if (attempt({kShift, v, w, k}, last_change, false, change)) return true;
      }
  return false;
}

// What helps most for its time, what helps less, what takes long, what helps where nothing else has.
bool Rescuer::rescue(Index tet, int effort) {
  if (is_fixed(tet)) return false;
  for (effort_ = 0; effort_ <= std::min(effort, kMostEffort); ++effort_) {
    if (tries_left_[effort_] == 0 || mesh_.bad(tet) < badness_at(kEfforts[effort_].angle)) continue;
    if (effort_ == 0 && (contract(tet, 0, kEdges, false) || insert(tet, 1, 3, false))) return true;
    if (effort_ == 1 && (insert(tet, 0, 1, false) || insert(tet, 3, 5, false) || insert(tet, 7, 11, false)))
      return true;
    if (effort_ == 2 && (insert(tet, 5, 7, false) || contract(tet, kEdges, 6, false) ||
                         contract(tet, 0, 6, true) || insert(tet, 0, Inserter::kPlaces, true)))
      return true;
    if (effort_ == 3 && shift(tet)) return true;
  }
  return false;
}

}  // namespace dm
