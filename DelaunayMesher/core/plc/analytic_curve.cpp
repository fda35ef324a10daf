#include "plc/analytic_curve.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace dm {

LineCurve::LineCurve(const CurveRecord& record, const EdgePath& path)
    : origin_(record.origin), axis_(normalized(record.axis)) {
  low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
  for (const auto& segment : path.segments) {
    for (const Vec3& p : segment) {
      const double t = dot(p - origin_, axis_);
      low_ = std::min(low_, t), high_ = std::max(high_, t);
    }
  }
  if (path.segments.empty()) std::swap(low_, high_);
}

Vec3 LineCurve::project(const Vec3& p) const {
  return origin_ + std::clamp(dot(p - origin_, axis_), low_, high_) * axis_;
}

CircleCurve::CircleCurve(const CurveRecord& record, const EdgePath& path)
    : origin_(record.origin), axis_(normalized(record.axis)), radius_(record.a) {
  const auto direction = [&](const Vec3& p) {
    const Vec3 d = p - origin_;
    return normalized(d - dot(d, axis_) * axis_);
  };
  x_ = path.segments.empty() ? Vec3{} : direction(path.segments[0][0]);
  if (norm2(x_) == 0) x_ = normalized(cross(axis_, std::abs(axis_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  y_ = cross(axis_, x_);
  if (path.ends.size() != 2) return;

  const auto angle_of = [&](const Vec3& p) {
    const Vec3 d = p - origin_;
    return std::atan2(dot(d, y_), dot(d, x_));
  };
  constexpr double turn = 2 * std::numbers::pi;
  const auto turned = [&](double angle) { return angle < 0 ? angle + turn : angle; };
  double first = angle_of(path.ends[0]), sweep = turned(angle_of(path.ends[1]) - first);
  // Two arcs join the ends: ours holds the middle of any of the edge's segments.
  const auto& inside = path.segments[path.segments.size() / 2];
  const Vec3 middle = 0.5 * (inside[0] + inside[1]);
  if (turned(angle_of(middle) - first) > sweep) first += sweep, sweep = turn - sweep;
  closed_ = false;
  half_ = 0.5 * sweep, cosine_ = std::cos(half_);
  const double centre = first + half_;
  x_ = std::cos(centre) * x_ + std::sin(centre) * y_;
  x_ = normalized(x_ - dot(x_, axis_) * axis_);
  y_ = cross(axis_, x_);
}

Vec3 CircleCurve::project(const Vec3& p) const {
  const Vec3 d = p - origin_;
  const double x = dot(d, x_), y = dot(d, y_), length = std::sqrt(x * x + y * y);
  if (length <= 1e-13 * radius_) return origin_ + radius_ * x_;
  double c = x / length, s = y / length;
  if (!closed_ && c < cosine_) c = cosine_, s = std::copysign(std::sin(half_), s);
  return origin_ + (radius_ * c) * x_ + (radius_ * s) * y_;
}

}  // namespace dm
