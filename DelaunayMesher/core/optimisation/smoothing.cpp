#include "optimisation/smoothing.h"

namespace dm {

// Gathers the star of v; false when v is fixed or has too many tetrahedra.
bool Smoother::load(Index v, bool soft) {
  if (mesh_.entity(v).dimension < 1 || mesh_.vertex_tet(v) < 0 || mesh_.pinched(v)) return false;
  const auto star = mesh_.star(v);
  if (star.size() > Fan::kCapacity) return false;
  place_ = mesh_.point(v);
  entity_ = mesh_.entity(v);
  fan_.start(place_);
  for (Index t : star) {
    const Tet& c = mesh_.tet(t);
    const auto& f = kFaceCorners[mesh_.corner_index(t, v)];
    const Vec3 &a = mesh_.point(c[f[0]]), &b = mesh_.point(c[f[1]]), &d = mesh_.point(c[f[2]]);
    tets_[fan_.count] = t;
    fan_.add(a, b, d);
  }
  fan_.close();
  begin(soft);
  return true;
}

void Smoother::begin(bool soft) {
  const Vec3 from = place_ - fan_.origin;
  double reach2 = 0;
  for (int k = 0; k < fan_.count; ++k)
    reach2 += norm2(Vec3{fan_.corner[0][k], fan_.corner[1][k], fan_.corner[2][k]} - from);
  size_ = std::sqrt(reach2 / fan_.count);
  soft_ = soft;
  stride_ = 0.12;
  now_ = fan_score(fan_, place_, soft_, bad_.data());
}

Vec3 Smoother::gradient() const {
  const double h = 1e-3 * size_;
  float bad[Fan::kCapacity];
  Vec3 g;
  for (int i = 0; i < 3; ++i) {
    Vec3 q = place_;
    q[i] += h;
    g[i] = (fan_score(fan_, q, soft_, bad).sum - now_.sum) / h;
  }
  return g;
}

// The triangles of the boundary at v must not turn by more than 30 degrees.
bool Smoother::keeps_boundary(Index v, const Vec3& p) const {
  for (int k = 0; k < fan_.count; ++k) {
    const Tet& c = mesh_.tet(tets_[k]);
    const int own = mesh_.corner_index(tets_[k], v);
    for (int i = 0; i < 4; ++i) {
      if (i == own || !mesh_.marked(tets_[k], i)) continue;
      std::array<Vec3, 3> before, after;
      for (int j = 0; j < 3; ++j) {
        const Index w = c[kFaceCorners[i][j]];
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

// Goes to p if the guard allows it.
bool Smoother::attempt(Index v, const Vec3& p) {
  const FanScore score = fan_score(fan_, p, soft_, trial_bad_.data());
  if (!(score.sum < now_.sum * (1 - 1e-3)) || !keeps_angles(now_.extremes, score.extremes)) return false;
  if (v != kNew && entity_.dimension < 3 && !keeps_boundary(v, p)) return false;
  now_ = score;
  place_ = p;
  std::swap(bad_, trial_bad_);
  return true;
}

// Towards the mean of the neighbours, each counted once for every tetrahedron it shares with v: one or two
// evaluations, and neighbouring points move together, which single gradient steps need many sweeps for.
bool Smoother::centre(Index v) {
  Vec3 sum;
  for (int k = 0; k < fan_.count; ++k)
    for (int i = 0; i < 9; ++i) sum[i % 3] += fan_.corner[i][k];
  const Vec3 from = place_, step = (1.0 / (3 * fan_.count)) * sum;
  return attempt(v, from + step) || attempt(v, from + 0.5 * step);
}

bool Smoother::descend(Index v) {
  const Entity entity = entity_;
  Vec3 direction = -gradient();
  if (entity.dimension == 2) {
    const Vec3 n = geometry_.normal(entity.index, place_);
    direction -= dot(direction, n) * n;
  }
  const double length = norm(direction);
  if (!(length > 0)) return false;
  direction = (size_ / length) * direction;
  const Vec3 from = place_;
  // Beside the point on the face, the one in the tangent plane shows what comes of it for much less.
  const bool curved = entity.dimension == 2 && !geometry_.is_plane(entity.index);
  const auto go = [&](double s) {
    const Vec3 p = from + s * direction;
    if (curved && !(fan_score(fan_, p, soft_, trial_bad_.data()).sum < now_.sum)) return false;
    return attempt(v, geometry_.project(entity, p));
  };
  double s = stride_;
  bool moved = go(s);
  if (moved) {
    while (s < 0.2 && go(2 * s)) s *= 2;
  } else {
    while (!moved && s > 0.02) moved = go(s *= 0.5);
  }
  stride_ = std::clamp(s, 0.02, 0.2);
  return moved;
}

bool Smoother::smooth(Index v, bool soft, int steps) {
  if (!load(v, soft)) return false;
  bool moved = soft && mesh_.interior(v) && centre(v);
  for (int i = 0; i < steps && descend(v); ++i) moved = true;
  if (!moved) return false;
  mesh_.move_point(v, place_, {tets_.data(), static_cast<std::size_t>(fan_.count)}, bad_);
  return true;
}

bool Smoother::shift(Index v, int cube_corner) {
  if (!load(v, false)) return false;
  const Vec3 direction{cube_corner & 1 ? 1. : -1., cube_corner & 2 ? 1. : -1., cube_corner & 4 ? 1. : -1.};
  const Vec3 from = place_;
  for (const double part : {0.3, 0.15, 0.075}) {
    const Vec3 p = geometry_.project(entity_, from + part * size_ * direction);
    if (fan_score(fan_, p, false, bad_.data()).extremes.blunt <= -1) continue;
    if (entity_.dimension < 3 && !keeps_boundary(v, p)) continue;
    mesh_.move_point(v, p, {tets_.data(), static_cast<std::size_t>(fan_.count)}, bad_);
    return true;
  }
  return false;
}

Vec3 Smoother::best_apex(const Fan& fan, const Vec3& start, Entity entity, int steps) {
  fan_ = fan;
  entity_ = entity;
  place_ = start;
  begin(false);
  for (int i = 0; i < steps && descend(kNew); ++i) continue;
  return place_;
}

}  // namespace dm
