#include "optimisation/rescue.h"

namespace dm {
namespace {

constexpr double kGain = 1e-2;     // of the worst badness
constexpr int kEdges = 2;          // that are contracted
constexpr int kSteps = 3;          // of a follow-up
constexpr double kDeepAngle = 27;  // degrees: below it follow-ups are tried
constexpr int kPasses = 3;         // of smoothing and flips
constexpr double kBad = 0.5;       // elements worse than this are worked on
constexpr Index kTries = 1000;     // elements that are tried, and one for each hundred tetrahedra

}  // namespace

Rescuer::Rescuer(EditMesh& mesh, Smoother& smoother, Flipper& flipper, Contractor& contractor,
                 const Geometry& geometry)
    : mesh_(mesh),
      smoother_(smoother),
      flipper_(flipper),
      contractor_(contractor),
      inserter_(mesh, smoother, geometry),
      geometry_(geometry),
      tries_left_(kTries + mesh.slot_count() / 100) {}

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

// Smooths v and the points of its bad tetrahedra and flips those.
void Rescuer::settle(Index v) {
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
  }
}

bool Rescuer::is_better() const {
  const AngleCosines before = mesh_.trial_before(), now = mesh_.trial_now();
  return badness(now) < badness(before) - kGain && keeps_angles(before, now);
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

bool Rescuer::finish() {
  const bool better = is_better();
  mesh_.end_trial(better);
  return better;
}

bool Rescuer::insert(Index tet, bool deep) {
  for (int place = 0; place < Inserter::kPlaces; ++place) {
    mesh_.begin_trial();
    const bool done = inserter_.insert(tet, place);
    if (done) settle(mesh_.vertex_count() - 1);
    if (done && deep) follow_up();
    if (finish()) return true;
  }
  return false;
}

// The shortest edges, each to either end.
bool Rescuer::contract(Index tet) {
  const Tet c = mesh_.tet(tet);
  std::vector<std::pair<double, Segment>> edges;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      edges.push_back({distance(mesh_.point(c[i]), mesh_.point(c[j])), {c[i], c[j]}});
  std::sort(edges.begin(), edges.end());
  for (int k = 0; k < kEdges; ++k)
    for (int end = 0; end < 2; ++end) {
      const Index from = edges[k].second[end], to = edges[k].second[1 - end];
      mesh_.begin_trial();
      if (contractor_.contract(from, to)) settle(to);
      if (finish()) return true;
    }
  return false;
}

bool Rescuer::rescue(Index tet) {
  failed_.resize(mesh_.slot_count(), 0);
  if (tries_left_ == 0 || failed_[tet] == mesh_.bad(tet) || is_fixed(tet)) return false;
  --tries_left_;
  if (insert(tet, false) || contract(tet)) return true;
  if (mesh_.bad(tet) > badness_at(kDeepAngle) && insert(tet, true)) return true;
  failed_[tet] = mesh_.bad(tet);
  return false;
}

}  // namespace dm
