#include "plc/analytic_surface.h"

#include <algorithm>

namespace dm {
namespace {

constexpr double on_axis = 1e-13;  // relative distance from the axis below which the direction is noise

double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

Vec3 any_perpendicular(const Vec3& axis) {
  const double x = std::abs(axis.x), y = std::abs(axis.y), z = std::abs(axis.z);
  const Vec3 other = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  return normalized(cross(axis, other));
}

}  // namespace

AnalyticSurface::AnalyticSurface(const SurfaceRecord& record, const Vec3& towards)
    : record_(record), towards_(towards) {
  if (record_.kind == SurfaceKind::sphere && norm2(record_.axis) == 0) record_.axis = {0, 0, 1};
  record_.axis = normalized(record_.axis);
  perpendicular_ = any_perpendicular(record_.axis);
  if (record_.kind == SurfaceKind::cone) cosine_ = std::cos(record_.a), sine_ = std::sin(record_.a);
  const Vec3 d = towards_ - record_.origin;
  const Vec3 side = d - dot(d, record_.axis) * record_.axis;
  if (norm(side) > 1e-6 * norm(d)) perpendicular_ = normalized(side);
}

void AnalyticSurface::restrict_sheets(const std::vector<Vec3>& points_of_face) {
  const bool spindle = record_.kind == SurfaceKind::torus && record_.b > record_.a;
  if (record_.kind != SurfaceKind::cone && !spindle) return;
  double extent = 0;
  for (const Vec3& p : points_of_face) extent = std::max(extent, distance(p, record_.origin));
  bool seen[2] = {false, false};
  for (const Vec3& p : points_of_face) {
    const Meridian m = meridian(p);
    // Points at the apex or where the sheets meet say nothing.
    const bool undecided = spindle ? m.r < 1e-6 * extent : std::abs(m.z) < 1e-6 * extent;
    if (!undecided) seen[sheet(p)] = true;
  }
  if (seen[0] != seen[1])
    used_[0] = seen[0], used_[1] = seen[1];
  else if (!spindle)
    choose_nappe(points_of_face);
}

// Of an almost flat cone, the points' side of the apex is noise; their distances from the nappes are not.
void AnalyticSurface::choose_nappe(const std::vector<Vec3>& points_of_face) {
  double farthest[2] = {0, 0};
  for (const Vec3& p : points_of_face) {
    const Meridian m = meridian(p);
    farthest[0] = std::max(farthest[0], std::abs(m.z * sine_ - m.r * cosine_));
    farthest[1] = std::max(farthest[1], std::abs(m.z * sine_ + m.r * cosine_));
  }
  for (int i = 0; i < 2; ++i)
    if (farthest[i] < 0.1 * farthest[1 - i]) used_[i] = true, used_[1 - i] = false;
}

AnalyticSurface::Meridian AnalyticSurface::meridian(const Vec3& p) const {
  const Vec3 d = p - record_.origin;
  const double z = dot(d, record_.axis);
  const Vec3 side = d - z * record_.axis;
  const double r = norm(side);
  if (r <= on_axis * (norm(d) + record_.a)) return {z, r, perpendicular_};
  return {z, r, (1 / r) * side};
}

Vec3 AnalyticSurface::at(double z, double r, const Vec3& radial) const {
  return record_.origin + z * record_.axis + r * radial;
}

Vec3 AnalyticSurface::sphere_direction(const Vec3& p) const {
  const Vec3 d = p - record_.origin;
  if (norm(d) > on_axis * record_.a) return normalized(d);
  const Vec3 t = towards_ - record_.origin;
  return norm(t) > on_axis * record_.a ? normalized(t) : record_.axis;
}

int AnalyticSurface::cone_nappe(const Meridian& m) const {
  return used_[0] && used_[1] ? (m.z >= 0 ? 0 : 1) : (used_[0] ? 0 : 1);
}

double AnalyticSurface::cone_length(const Meridian& m) const {
  const double z = cone_nappe(m) == 0 ? m.z : -m.z;
  return std::max(0.0, z * cosine_ + m.r * sine_);
}

// Sheet 1, the inner one of a spindle torus, belongs to the circle beyond the axis.
int AnalyticSurface::torus_sheet(const Meridian& m) const {
  if (record_.b <= record_.a || !used_[1]) return 0;
  if (!used_[0]) return 1;
  const double outer = std::abs(length_of(m.r - record_.a, m.z) - record_.b);
  const double inner = std::abs(length_of(m.r + record_.a, m.z) - record_.b);
  return inner < outer ? 1 : 0;
}

// From the centre of the tube to p.
Vec3 AnalyticSurface::torus_normal(const Meridian& m) const {
  const double centre = torus_sheet(m) == 0 ? record_.a : -record_.a;
  const double r = m.r - centre, length = length_of(r, m.z);
  if (length <= on_axis * record_.a) return m.radial;
  return (1 / length) * (r * m.radial + m.z * record_.axis);
}

Vec3 AnalyticSurface::project(const Vec3& p) const {
  switch (record_.kind) {
    case SurfaceKind::plane:
      return p - dot(p - record_.origin, record_.axis) * record_.axis;
    case SurfaceKind::sphere:
      return record_.origin + record_.a * sphere_direction(p);
    case SurfaceKind::cylinder: {
      const Meridian m = meridian(p);
      return at(m.z, record_.a, m.radial);
    }
    case SurfaceKind::cone: {
      const Meridian m = meridian(p);
      const double length = cone_length(m), side = cone_nappe(m) == 0 ? 1 : -1;
      return at(side * length * cosine_, length * sine_, m.radial);
    }
    default: {
      const Meridian m = meridian(p);
      const double centre = torus_sheet(m) == 0 ? record_.a : -record_.a;
      return at(0, centre, m.radial) + record_.b * torus_normal(m);
    }
  }
}

Vec3 AnalyticSurface::normal(const Vec3& p) const {
  switch (record_.kind) {
    case SurfaceKind::plane:
      return record_.axis;
    case SurfaceKind::sphere:
      return sphere_direction(p);
    case SurfaceKind::cylinder:
      return meridian(p).radial;
    case SurfaceKind::cone: {
      const Meridian m = meridian(p);
      const double side = cone_nappe(m) == 0 ? 1 : -1;
      if (cone_length(m) == 0) return {};  // the apex has none
      return cosine_ * m.radial - side * sine_ * record_.axis;
    }
    default:
      return torus_normal(meridian(p));
  }
}

double AnalyticSurface::curvature(const Vec3& p) const {
  constexpr double smallest_radius = 1e-300;
  switch (record_.kind) {
    case SurfaceKind::plane:
      return 0;
    case SurfaceKind::sphere:
    case SurfaceKind::cylinder:
      return 1 / record_.a;
    case SurfaceKind::cone:
      return cosine_ / std::max(cone_length(meridian(p)) * sine_, smallest_radius);
    default: {
      const Meridian m = meridian(p);
      const double centre = torus_sheet(m) == 0 ? record_.a : -record_.a;
      const double cosine = dot(torus_normal(m), m.radial);
      const double r = std::abs(centre + record_.b * cosine);
      return std::max(1 / record_.b, std::abs(cosine) / std::max(r, smallest_radius));
    }
  }
}

int AnalyticSurface::sheet(const Vec3& p) const {
  if (record_.kind == SurfaceKind::cone) return cone_nappe(meridian(p));
  return record_.kind == SurfaceKind::torus ? torus_sheet(meridian(p)) : 0;
}

}  // namespace dm
