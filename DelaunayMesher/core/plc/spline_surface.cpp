#include "plc/spline_surface.h"

#include <algorithm>
#include <cmath>

namespace dm {
namespace {

constexpr double bend =
    0.06;  // distance of quarter points from where the chord has them, relative to the chord
constexpr int max_depth = 7, max_steps = 40, max_cross_lines = 17, max_breaks = 150;
constexpr double settled = 2e-7;  // last step, relative to a cell: Newton squares it
constexpr std::size_t max_cells = 40000;

// At most `most` of the breaks, at least 5 parameters, the ends among them.
std::vector<double> thinned(const std::vector<double>& breaks, std::size_t most) {
  std::vector<double> all = refine_parameters(breaks, 4, 0, nullptr);
  if (all.size() <= most) return all;
  std::vector<double> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(all[i * (all.size() - 1) / (most - 1)]);
  return chosen;
}

double extent_of(const BSplineSurface& s, const std::vector<double>& us, const std::vector<double>& vs) {
  Vec3 low = s.point(us[0], vs[0]), high = low;
  for (const double u : us) {
    for (const double v : vs) {
      const Vec3 p = s.point(u, v);
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    }
  }
  return distance(low, high);
}

struct Step {
  double u = 0, v = 0;
  bool cut = false;  // short of where it wanted to go
};

// A quadratic bowl gu du + gv dv + (a du^2 + 2 b du dv + c dv^2) / 2.
struct Bowl {
  double gu, gv, a, b, c;
};

// Half the squared distance from p round (u, v).  Where that is no bowl the second-order terms are left out
// (Gauss-Newton).
Bowl bowl_of(const SurfaceJet& jet, const Vec3& d) {
  const double gu = dot(jet.u, d), gv = dot(jet.v, d);
  const double e = norm2(jet.u), f = dot(jet.u, jet.v), g = norm2(jet.v);
  const double a = e + dot(jet.uu, d), b = f + dot(jet.uv, d), c = g + dot(jet.vv, d);
  const bool round = a > 0.1 * e && c > 0.1 * g && a * c - b * b > 0.05 * (e * g - f * f);
  return round ? Bowl{gu, gv, a, b, c} : Bowl{gu, gv, e, f, g};
}

// The bottom along one direction after a step in the other.
double bottom(double slope, double curved, double mixed, double other) {
  return curved > 0 ? -(slope + mixed * other) / curved : 0;
}

Step to_bottom(const Bowl& w) {
  const double det = w.a * w.c - w.b * w.b;
  if (det > 1e-20 * w.a * w.c) return {(w.b * w.gv - w.c * w.gu) / det, (w.b * w.gu - w.a * w.gv) / det};
  // One direction is degenerate, or both are the same.
  return w.a >= w.c ? Step{bottom(w.gu, w.a, 0, 0), 0} : Step{0, bottom(w.gv, w.c, 0, 0)};
}

// A parameter's range: where it ends, or that it has no ends.
struct Bounds {
  const KnotVector& knots;
  bool closed;

  // What is left of a step; `cut` is set when it stops at an end that t was not at.
  double within(double t, double step, bool& cut) const {
    if (closed) return step;
    const double kept = std::clamp(step, knots.first() - t, knots.last() - t);
    cut = cut || (kept != step && kept != 0);
    return kept;
  }
  double moved(double t, double step) const {
    const double first = knots.first(), last = knots.last(), length = last - first;
    t += std::clamp(step, -0.5 * length, 0.5 * length);
    if (closed) return t < first ? t + length : t > last ? t - length : t;
    return std::clamp(t, first, last);
  }
};

// Newton's step, along the bounds where it would leave the range.
Step bounded_step(const Bowl& bowl, const Bounds& bu, const Bounds& bv, double u, double v) {
  Step step = to_bottom(bowl);
  const double du = bu.within(u, step.u, step.cut), dv = bv.within(v, step.v, step.cut);
  if (du != step.u) {
    step.u = du;
    step.v = bv.within(v, bottom(bowl.gv, bowl.c, bowl.b, du), step.cut);
  } else if (dv != step.v) {
    step.v = dv;
    step.u = bu.within(u, bottom(bowl.gu, bowl.a, bowl.b, dv), step.cut);
  }
  return step;
}

}  // namespace

SplineSurface::SplineSurface(const SplineSurfaceRecord& record) : surface_(record) {
  choose_lines();
  build_grid();
}

// The lines of the grid; and whether the surface is closed.
void SplineSurface::choose_lines() {
  const KnotVector &ku = surface_.knots_u(), &kv = surface_.knots_v();
  const std::vector<double> us = thinned(ku.breaks(), max_cross_lines);
  const std::vector<double> vs = thinned(kv.breaks(), max_cross_lines);
  const double extent = extent_of(surface_, us, vs);
  closed_u_ = surface_.closed_u(), closed_v_ = surface_.closed_v();
  for (double tolerance = bend;
       lines_u_.empty() || (lines_u_.size() * lines_v_.size() > max_cells && tolerance < 1); tolerance *= 2) {
    const auto bent = [&](const std::vector<double>& across, bool along_u, double a, double b) {
      for (const double w : across) {
        const auto at = [&](double t) { return along_u ? surface_.point(t, w) : surface_.point(w, t); };
        const Vec3 pa = at(a), pb = at(b);
        const double allowed = std::max(tolerance * distance(pa, pb), 1e-5 * extent);
        for (const double s : {0.25, 0.5, 0.75}) {
          if (distance(at(a + s * (b - a)), pa + s * (pb - pa)) > allowed) return true;
        }
      }
      return false;
    };
    lines_u_ = refine_parameters(thinned(ku.breaks(), max_breaks), 4, max_depth,
                                 [&](double a, double b) { return bent(vs, true, a, b); });
    lines_v_ = refine_parameters(thinned(kv.breaks(), max_breaks), 4, max_depth,
                                 [&](double a, double b) { return bent(us, false, a, b); });
  }
}

void SplineSurface::build_grid() {
  const std::size_t nu = lines_u_.size(), nv = lines_v_.size();
  std::vector<Vec3> points;
  points.reserve(nu * nv);
  for (const double u : lines_u_) {
    for (const double v : lines_v_) points.push_back(surface_.point(u, v));
  }
  std::vector<TriangleItem> triangles;
  triangles.reserve(2 * (nu - 1) * (nv - 1));
  for (std::size_t i = 0; i + 1 < nu; ++i) {
    for (std::size_t j = 0; j + 1 < nv; ++j) {
      const Vec3* corner = &points[i * nv + j];
      triangles.emplace_back(corner[0], corner[nv], corner[nv + 1]);
      triangles.emplace_back(corner[0], corner[nv + 1], corner[1]);
    }
  }
  grid_.emplace(std::move(triangles));
}

SplineSurface::Foot SplineSurface::newton(const Vec3& p, double u, double v, double small_step) const {
  const Bounds bu{surface_.knots_u(), closed_u_}, bv{surface_.knots_v(), closed_v_};
  SurfaceJet jet = surface_.jet(u, v);
  for (int count = 0; count < max_steps; ++count) {
    const Vec3 d = jet.point - p;
    Step step = bounded_step(bowl_of(jet, d), bu, bv, u, v);
    const double now2 = norm2(d), length = norm(step.u * jet.u + step.v * jet.v);
    // Beside a degenerate edge a short step can still turn far round it.
    const bool small =
        std::abs(step.u) < 1e-4 * bu.knots.length() && std::abs(step.v) < 1e-4 * bv.knots.length();
    const bool last = length < 1e-6 * small_step || (length < small_step && small && !step.cut);
    double next_u = bu.moved(u, step.u), next_v = bv.moved(v, step.v);
    if (last) return {next_u, next_v, surface_.point(next_u, next_v), true};
    jet = surface_.jet(next_u, next_v);
    for (int halving = 0; norm2(jet.point - p) > now2; ++halving) {
      if (halving == 12) return {u, v, surface_.point(u, v), false};
      step.u *= 0.5, step.v *= 0.5;
      next_u = bu.moved(u, step.u), next_v = bv.moved(v, step.v);
      jet = surface_.jet(next_u, next_v);
    }
    u = next_u, v = next_v;
  }
  return {u, v, jet.point, false};
}

// Nearest, or on a sheet turned away from that one whose grid is farther away by less than its error.
SplineSurface::Foot SplineSurface::foot(const Vec3& p) const {
  const NearestPoint nearest = grid_->nearest(p);
  const Foot first = foot_from(p, nearest);
  const double size = cell_size(nearest.item), away = distance(first.point, p);
  if (away < settled * size) return first;
  const Vec3 normal = grid_->item(nearest.item).area_normal();
  const double reach = away + bend * size;
  const NearestPoint behind = grid_->nearest(
      p, [&](const TriangleItem& t) { return dot(t.area_normal(), normal) < 0; }, reach * reach);
  if (behind.item < 0) return first;
  const Foot second = foot_from(p, behind);
  return norm2(second.point - p) < norm2(first.point - p) ? second : first;
}

// The diagonal of the cell.
double SplineSurface::cell_size(Index item) const {
  const TriangleItem& triangle = grid_->item(item);
  return distance(triangle.corner(0), triangle.corner(item % 2 == 0 ? 2 : 1));
}

SplineSurface::Foot SplineSurface::foot_from(const Vec3& p, const NearestPoint& nearest) const {
  const std::size_t cell = nearest.item / 2, cells_v = lines_v_.size() - 1, i = cell / cells_v,
                    j = cell % cells_v;
  const double u0 = lines_u_[i], u1 = lines_u_[i + 1], v0 = lines_v_[j], v1 = lines_v_[j + 1];
  const bool lower = nearest.item % 2 == 0;
  const double s = lower ? nearest.s + nearest.t : nearest.s, t = lower ? nearest.t : nearest.s + nearest.t;
  const double size = cell_size(nearest.item);
  Foot best = newton(p, u0 + s * (u1 - u0), v0 + t * (v1 - v0), settled * size);
  if (best.settled && distance(best.point, p) <= std::sqrt(nearest.distance2) + 2 * bend * size) return best;
  for (const double u : {u0, u1}) {
    for (const double v : {v0, v1}) {
      const Foot other = newton(p, u, v, settled * size);
      if (norm2(other.point - p) < norm2(best.point - p)) best = other;
    }
  }
  return best;
}

Vec3 SplineSurface::project(const Vec3& p) const {
  return surface_.origin() + foot(p - surface_.origin()).point;
}

Vec3 SplineSurface::project(const Vec3& p, const Vec3& side) const {
  const Vec3 local = p - surface_.origin();
  return surface_.origin() + foot_from(local, nearest_facing(*grid_, local, side)).point;
}

// The jet a fraction of the range further inside.
SurfaceJet SplineSurface::inner_jet(double u, double v, double fraction) const {
  const KnotVector &ku = surface_.knots_u(), &kv = surface_.knots_v();
  const double middle_u = 0.5 * (ku.first() + ku.last()), middle_v = 0.5 * (kv.first() + kv.last());
  return surface_.jet(u + fraction * (middle_u - u), v + fraction * (middle_v - v));
}

// Neither direction degenerates: at a pole, the end of all its meridians, the parallels do.
bool SplineSurface::regular(const SurfaceJet& jet, double least) const {
  const double along_u = norm(jet.u) * surface_.knots_u().length();
  const double along_v = norm(jet.v) * surface_.knots_v().length();
  return along_u > least * along_v && along_v > least * along_u;
}

Vec3 SplineSurface::normal(const Vec3& p) const {
  const Foot at = foot(p - surface_.origin());
  for (const double fraction : {0.0, 1e-6, 1e-4, 1e-2}) {
    const SurfaceJet jet = inner_jet(at.u, at.v, fraction);
    const Vec3 n = cross(jet.u, jet.v);
    if (regular(jet, 1e-8) && norm(n) > 1e-7 * norm(jet.u) * norm(jet.v)) return normalized(n);
  }
  return {0, 0, 1};
}

// From the two fundamental forms; beside degenerate points and cusps a little further inside.
double SplineSurface::curvature(const Vec3& p) const {
  const Foot at = foot(p - surface_.origin());
  for (const double fraction : {0.0, 1e-3, 1e-2}) {
    const SurfaceJet jet = inner_jet(at.u, at.v, fraction);
    const double e = norm2(jet.u), f = dot(jet.u, jet.v), g = norm2(jet.v), area2 = e * g - f * f;
    if (!regular(jet, 1e-4) || area2 <= 1e-10 * e * g) continue;
    const Vec3 n = (1 / std::sqrt(area2)) * cross(jet.u, jet.v);
    const double l = dot(n, jet.uu), m = dot(n, jet.uv), k = dot(n, jet.vv);
    const double mean = (e * k + g * l - 2 * f * m) / (2 * area2), gauss = (l * k - m * m) / area2;
    return std::abs(mean) + std::sqrt(std::max(0.0, mean * mean - gauss));
  }
  return 0;
}

}  // namespace dm
