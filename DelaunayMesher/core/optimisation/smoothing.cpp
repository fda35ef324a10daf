#include "optimisation/smoothing.h"

#include "optimisation/flips.h"

namespace dm {

// Gathers the star of v; false when it has too many tetrahedra.
bool Smoother::load(Index v) {
  const auto star = mesh_.star(v);
  if (star.size() > Fan::kCapacity) return false;
  fan_.clear();
  place_ = mesh_.point(v);
  double reach = 0;
  for (Index t : star) {
    const Tet& c = mesh_.tet(t);
    const auto& f = EditMesh::kFace[mesh_.corner_index(t, v)];
    const Vec3 &a = mesh_.point(c[f[0]]), &b = mesh_.point(c[f[1]]), &d = mesh_.point(c[f[2]]);
    tets_[fan_.count] = t;
    fan_.add(a, b, d);
    reach += distance(place_, a);
  }
  size_ = reach / fan_.count;
  return true;
}

Smoother::Score Smoother::score(const Vec3& p, double* bad) const {
  fan_badness(fan_, p, 1, bad);
  Score s;
  for (int k = 0; k < fan_.count; ++k) {
    double power = bad[k] * bad[k];
    for (int i = 1; i < log_power_; ++i) power *= power;
    s.sum += power;
    s.worst = std::max(s.worst, bad[k]);
  }
  return s;
}

Vec3 Smoother::gradient(const Vec3& p, double base) const {
  const double h = 1e-4 * size_;
  double bad[Fan::kCapacity];
  Vec3 g;
  for (int i = 0; i < 3; ++i) {
    Vec3 q = p;
    q[i] += h;
    g[i] = (score(q, bad).sum - base) / h;
  }
  return g;
}

// The triangles of the boundary at v must not turn over: their normal keeps its side of the CAD face.
bool Smoother::keeps_boundary(Index v, const Vec3& p) const {
  for (int k = 0; k < fan_.count; ++k) {
    const Tet& c = mesh_.tet(tets_[k]);
    const int own = mesh_.corner_index(tets_[k], v);
    for (int i = 0; i < 4; ++i) {
      if (i == own || !mesh_.marked(tets_[k], i)) continue;
      std::array<Vec3, 3> before, after;
      for (int j = 0; j < 3; ++j) {
        const Index w = c[EditMesh::kFace[i][j]];
        before[j] = mesh_.point(w);
        after[j] = w == v ? p : before[j];
      }
      const Vec3 m = area_vector(before[0], before[1], before[2]),
                 n = area_vector(after[0], after[1], after[2]);
      const double d = dot(m, n);
      if (d <= 0 || d * d < 0.75 * norm2(m) * norm2(n)) return false;
    }
  }
  return true;
}

bool Smoother::is_allowed(Index v, const Vec3& p) const {
  AngleCosines before, after;
  for (int k = 0; k < fan_.count; ++k) {
    const auto corner = [&](int i) {
      return Vec3{fan_.corner[i][k], fan_.corner[i + 1][k], fan_.corner[i + 2][k]};
    };
    before.include(angle_cosines(corner(0), corner(3), corner(6), place_));
    after.include(angle_cosines(corner(0), corner(3), corner(6), p));
  }
  return is_better(before, after) && (mesh_.interior(v) || keeps_boundary(v, p));
}

bool Smoother::step(Index v) {
  const Entity entity = mesh_.entity(v);
  double bad[Fan::kCapacity];
  Vec3 direction = -gradient(place_, now_.sum);
  if (entity.dimension == 2) {
    const Vec3 n = geometry_.normal(entity.index, place_);
    direction -= dot(direction, n) * n;
  }
  const double length = norm(direction);
  if (!(length > 0)) return false;
  direction = (size_ / length) * direction;
  Vec3 best = place_;
  Score best_score = now_;
  const auto attempt = [&](double s) {
    const Vec3 q = geometry_.project(entity, place_ + s * direction);
    const Score trial = score(q, bad);
    if (!(trial.sum < best_score.sum) || trial.worst > now_.worst) return false;
    best = q;
    best_score = trial;
    return true;
  };
  double s = stride_;
  if (attempt(s)) {
    while (s < 0.25 && attempt(2 * s)) s *= 2;
  } else {
    do s *= 0.5;
    while (s > 0.01 && !attempt(s));
  }
  stride_ = std::clamp(s, 0.01, 0.2);
  if (best_score.sum >= now_.sum * (1 - 1e-3)) return false;
  if (!is_allowed(v, best)) return false;
  place_ = best;
  now_ = best_score;
  return true;
}

bool Smoother::smooth(Index v, int log_power, int steps) {
  if (mesh_.entity(v).dimension < 1 || mesh_.vertex_tet(v) < 0 || !load(v)) return false;
  log_power_ = log_power;
  stride_ = 0.08;
  double bad[Fan::kCapacity];
  now_ = score(place_, bad);
  bool moved = false;
  for (int i = 0; i < steps && step(v); ++i) {
    moved = true;
    mesh_.set_point(v, place_);
  }
  if (!moved) return false;
  score(place_, bad);
  for (int k = 0; k < fan_.count; ++k) mesh_.set_bad(tets_[k], bad[k]);
  return true;
}

}  // namespace dm
