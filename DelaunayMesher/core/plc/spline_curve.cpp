#include "plc/spline_curve.h"

#include <algorithm>

namespace dm {
namespace {

constexpr double bend =
    0.06;  // distance of quarter points from where the chord has them, relative to the chord
constexpr int max_depth = 10, max_steps = 40;

double extent_of(const BSplineCurve& curve) {
  const double a = curve.knots().first(), b = curve.knots().last();
  Vec3 low = curve.point(a), high = low;
  for (int i = 1; i <= 64; ++i) {
    const Vec3 p = curve.point(i < 64 ? a + (b - a) * i / 64 : b);
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  return distance(low, high);
}

}  // namespace

SplineCurve::SplineCurve(const SplineCurveRecord& record) : curve_(record) {
  const double extent = extent_of(curve_);
  closed_ = curve_.closed();
  const auto bent = [&](double a, double b) {
    const Vec3 pa = curve_.point(a), pb = curve_.point(b);
    const double allowed = std::max(bend * distance(pa, pb), 1e-6 * extent);
    for (const double s : {0.25, 0.5, 0.75}) {
      if (distance(curve_.point(a + s * (b - a)), pa + s * (pb - pa)) > allowed) return true;
    }
    return false;
  };
  samples_ = refine_parameters(curve_.knots().breaks(), 4, max_depth, bent);
  std::vector<SegmentItem> segments;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    segments.emplace_back(curve_.point(samples_[i]), curve_.point(samples_[i + 1]));
  }
  chords_.emplace(std::move(segments));
}

double SplineCurve::moved(double t, double step) const {
  const double first = curve_.knots().first(), last = curve_.knots().last();
  t += std::clamp(step, first - last, last - first);
  if (closed_) return t < first ? t + (last - first) : t > last ? t - (last - first) : t;
  return std::clamp(t, first, last);
}

SplineCurve::Foot SplineCurve::newton(const Vec3& p, double t, double small_step) const {
  CurveJet jet = curve_.jet(t);
  for (int step_count = 0; step_count < max_steps; ++step_count) {
    const Vec3 d = jet.point - p;
    const double slope = dot(jet.d, d), speed2 = norm2(jet.d);
    double bowl = speed2 + dot(jet.dd, d);
    if (bowl < 0.1 * speed2) bowl = speed2;
    if (bowl <= 0) break;
    double step = -slope / bowl;
    const double now2 = norm2(d);
    double next = moved(t, step);
    if (next == t) break;
    CurveJet there = curve_.jet(next);
    const bool last = std::abs(step) * std::sqrt(speed2) < small_step;
    for (int halving = 0; !last && halving < 10 && norm2(there.point - p) > now2; ++halving) {
      step *= 0.5;
      next = moved(t, step);
      there = curve_.jet(next);
    }
    if (!last && norm2(there.point - p) > now2) break;
    t = next, jet = there;
    if (last) break;
  }
  return {t, jet.point};
}

SplineCurve::Foot SplineCurve::foot(const Vec3& p) const {
  const NearestPoint nearest = chords_->nearest(p);
  const SegmentItem& chord = chords_->item(nearest.item);
  const double a = samples_[nearest.item], b = samples_[nearest.item + 1];
  const double length = distance(chord.corner(0), chord.corner(1));
  Foot best = newton(p, a + nearest.s * (b - a), 1e-6 * length);
  if (distance(best.point, p) <= std::sqrt(nearest.distance2) + bend * length) return best;
  for (const double t : {a, b}) {
    const Foot other = newton(p, t, 1e-6 * length);
    if (norm2(other.point - p) < norm2(best.point - p)) best = other;
  }
  return best;
}

Vec3 SplineCurve::project(const Vec3& p) const { return curve_.origin() + foot(p - curve_.origin()).point; }

double SplineCurve::curvature(const Vec3& p) const {
  const CurveJet jet = curve_.jet(foot(p - curve_.origin()).t);
  const double speed = norm(jet.d);
  return speed > 0 ? norm(cross(jet.d, jet.dd)) / (speed * speed * speed) : 0;
}

}  // namespace dm
