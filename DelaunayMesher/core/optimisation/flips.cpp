#include "optimisation/flips.h"

namespace dm {
namespace {

constexpr double kGain = 1e-3;       // of the worst badness: less is not worth a change
constexpr double kBluntEdge = -0.1;  // cosine: edges with a smaller angle are hardly ever worth removing
constexpr int kShortRing = 5;
constexpr double kMeanGain = 0.02;  // of the sum
constexpr double kMeanBad = 0.29;   // badness of an average element of an optimised mesh

// The corners c, d that make (a, b, c, d) positively oriented, for the edge (a, b) by local indices.
constexpr int kEdgeRest[4][4][2] = {{{-1, -1}, {2, 3}, {3, 1}, {1, 2}},
                                    {{3, 2}, {-1, -1}, {0, 3}, {2, 0}},
                                    {{1, 3}, {3, 0}, {-1, -1}, {0, 1}},
                                    {{2, 1}, {0, 2}, {1, 0}, {-1, -1}}};

}  // namespace

// False when the edge is on the boundary or its ring is too long.
bool Flipper::find_ring(Index start, int ia, int ib, int longest, Ring& ring) const {
  const Tet& first = mesh_.tet(start);
  ring.a = first[ia];
  ring.b = first[ib];
  ring.count = 0;
  int ic = kEdgeRest[ia][ib][0], id = kEdgeRest[ia][ib][1];
  for (Index t = start;;) {
    if (ring.count == longest) return false;
    ring.tet[ring.count] = t;
    ring.corner[ring.count++] = mesh_.tet(t)[ic];
    if (mesh_.marked(t, ic)) return false;
    const Index last = mesh_.tet(t)[id];
    const Index n = mesh_.neighbour(t, ic);
    t = n / 4;
    if (t == start) return true;
    id = n % 4;
    ic = mesh_.corner_index(t, last);
  }
}

// Best triangulation of the ring: returns its worst badness, or its sum relative to the average element.
double Flipper::triangulate(const Ring& ring) {
  const int n = ring.count;
  fan_.start(mesh_.point(ring.a));
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k)
        fan_.add(mesh_.point(ring.corner[i]), mesh_.point(ring.corner[j]), mesh_.point(ring.corner[k]));
  fan_.close();
  float upper[Fan::kCapacity], lower[Fan::kCapacity];
  fan_badness(fan_, mesh_.point(ring.b), 1, upper);
  fan_badness(fan_, mesh_.point(ring.a), -1, lower);
  const bool worst = goal_ == FlipGoal::worst;
  double cost[kMaxRing][kMaxRing][kMaxRing];
  for (int i = 0, m = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k, ++m)
        cost[i][j][k] = worst ? std::max(upper[m], lower[m]) : upper[m] + lower[m] - 2 * kMeanBad;
  double best[kMaxRing][kMaxRing];
  for (int i = 0; i + 1 < n; ++i) best[i][i + 1] = 0;
  for (int length = 2; length < n; ++length)
    for (int i = 0; i + length < n; ++i) {
      const int k = i + length;
      best[i][k] = HUGE_VAL;
      for (int j = i + 1; j < k; ++j) {
        const double c = worst ? std::max({cost[i][j][k], best[i][j], best[j][k]})
                               : cost[i][j][k] + best[i][j] + best[j][k];
        if (c >= best[i][k]) continue;
        best[i][k] = c;
        middle_[i][k] = static_cast<std::int8_t>(j);
      }
    }
  return best[0][n - 1];
}

void Flipper::add_triangles(const Ring& ring, int i, int k, Plan& plan) const {
  if (k - i < 2) return;
  const int j = middle_[i][k];
  const Index ri = ring.corner[i], rj = ring.corner[j], rk = ring.corner[k];
  plan.after[plan.after_count++] = {ri, rj, rk, ring.b};
  plan.after[plan.after_count++] = {ri, rk, rj, ring.a};
  add_triangles(ring, i, j, plan);
  add_triangles(ring, j, k, plan);
}

void Flipper::start(FlipGoal goal, Plan& plan) {
  goal_ = goal;
  plan.cost = goal == FlipGoal::worst ? kInverted : -kMeanGain;
}

void Flipper::plan_edge_removal(Index tet, int ia, int ib, int longest, Plan& best) {
  Ring ring;
  if (!find_ring(tet, ia, ib, longest, ring)) return;
  double worst = 0, sum = 0;
  for (int i = 0; i < ring.count; ++i) {
    worst = std::max(worst, mesh_.bad(ring.tet[i]));
    sum += mesh_.bad(ring.tet[i]) - kMeanBad;
  }
  Plan plan;
  plan.cost = triangulate(ring);
  if (goal_ == FlipGoal::mean) plan.cost -= sum;
  if (plan.cost >= best.cost || (goal_ == FlipGoal::worst && plan.cost > worst - kGain)) return;
  add_triangles(ring, 0, ring.count - 1, plan);
  plan.before_count = ring.count;
  std::copy_n(ring.tet.begin(), ring.count, plan.before.begin());
  if (is_allowed(plan)) best = plan;
}

// For the worst element only.
void Flipper::plan_face_removal(Index tet, int face, Plan& best) const {
  if (mesh_.marked(tet, face)) return;
  const Index n = mesh_.neighbour(tet, face);
  const Index a = mesh_.tet(tet)[face], b = mesh_.tet(n / 4)[n % 4];
  const double bound = std::min(best.cost, std::max(mesh_.bad(tet), mesh_.bad(n / 4)) - kGain);
  Plan plan;
  plan.cost = 0;
  for (int i = 0; i < 3 && plan.cost < bound; ++i) {
    const Index p = mesh_.tet(tet)[kFaceCorners[face][i]],
                q = mesh_.tet(tet)[kFaceCorners[face][(i + 1) % 3]];
    plan.after[plan.after_count++] = {p, q, b, a};
    plan.cost = std::max(plan.cost, mesh_.compute_bad({p, q, b, a}));
  }
  if (plan.cost >= bound) return;
  plan.before_count = 2;
  plan.before[0] = tet;
  plan.before[1] = n / 4;
  if (is_allowed(plan)) best = plan;
}

bool Flipper::is_allowed(const Plan& plan, std::span<const Triangle> boundary) const {
  AngleCosines before, after;
  for (int i = 0; i < plan.before_count; ++i) before.include(mesh_.cosines(mesh_.tet(plan.before[i])));
  for (int i = 0; i < plan.after_count; ++i) after.include(mesh_.cosines(plan.after[i]));
  if (!keeps_angles(before, after)) return false;
  const auto all_in = [](const auto& corners, const Triangle& f) {
    int shared = 0;
    for (Index v : corners) shared += v == f[0] || v == f[1] || v == f[2];
    return shared == 3;
  };
  const auto may_be = [&](const Triangle& f) {
    for (int i = 0; i < plan.before_count; ++i)
      if (all_in(mesh_.tet(plan.before[i]), f)) return true;
    return std::any_of(boundary.begin(), boundary.end(), [&](const Triangle& t) { return all_in(t, f); });
  };
  for (int i = 0; i < plan.after_count; ++i)
    for (const auto& f : kFaceCorners) {
      const Triangle corners{plan.after[i][f[0]], plan.after[i][f[1]], plan.after[i][f[2]]};
      if (mesh_.on_one_face(corners[0], corners[1], corners[2]) && !may_be(corners)) return false;
    }
  return true;
}

std::span<const Index> Flipper::apply(const Plan& plan) {
  if (plan.before_count == 0) return {};
  return mesh_.replace({plan.before.data(), static_cast<std::size_t>(plan.before_count)},
                       {plan.after.data(), static_cast<std::size_t>(plan.after_count)});
}

bool Flipper::improve(Index tet) {
  Plan best;
  start(FlipGoal::worst, best);
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) plan_edge_removal(tet, i, j, kMaxRing, best);
  for (int i = 0; i < 4; ++i) plan_face_removal(tet, i, best);
  return !apply(best).empty();
}

Flipper::Plan Flipper::plan_blunt(Index tet, FlipGoal goal) {
  constexpr int kEdge[6][2] = {{2, 3}, {1, 3}, {1, 2},
                               {0, 3}, {0, 2}, {0, 1}};  // between the faces kFacePairs
  const Tet& c = mesh_.tet(tet);
  const auto cosines =
      dihedral_cosines(mesh_.point(c[0]), mesh_.point(c[1]), mesh_.point(c[2]), mesh_.point(c[3]));
  int first = 0, second = 1;
  if (cosines[second] < cosines[first]) std::swap(first, second);
  for (int k = 2; k < 6; ++k) {
    if (cosines[k] < cosines[first]) {
      second = first;
      first = k;
    } else if (cosines[k] < cosines[second]) {
      second = k;
    }
  }
  Plan best;
  start(goal, best);
  for (const int k : {first, second})
    if (cosines[k] < kBluntEdge) plan_edge_removal(tet, kEdge[k][0], kEdge[k][1], kShortRing, best);
  best.tet = tet;
  return best;
}

}  // namespace dm
