// Splines with known shapes for the tests.
#pragma once

#include "base/random.h"
#include "plc/geometry.h"
#include "shapes.h"

namespace dm::test {

// The arc of `quarters` quarter turns in the plane z = 0, degree 2, one knot unit per quarter.
inline SplineCurveRecord arc(double radius, int quarters) {
  SplineCurveRecord c;
  c.degree = 2;
  for (int i = 0; i <= 2 * quarters; ++i) {
    const double angle = pi / 4 * i, r = i % 2 ? radius * std::sqrt(2.0) : radius;
    c.poles.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    c.weights.push_back(i % 2 ? std::sqrt(0.5) : 1);
  }
  c.poles.back() = quarters == 4 ? c.poles.front() : c.poles.back();
  c.knots = {0};
  for (int q = 0; q <= quarters; ++q) c.knots.insert(c.knots.end(), 2, q);
  c.knots.push_back(quarters);
  c.u0 = 0, c.u1 = quarters;
  return c;
}

// The profile's (x, y) taken as (distance from the axis, height), turned round the z axis along v.
inline SplineSurfaceRecord revolve(const SplineCurveRecord& profile, int quarters) {
  const SplineCurveRecord turn = arc(1, quarters);
  SplineSurfaceRecord s;
  s.degree_u = profile.degree, s.degree_v = 2;
  s.nu = static_cast<Index>(profile.poles.size()), s.nv = static_cast<Index>(turn.poles.size());
  for (Index i = 0; i < s.nu; ++i) {
    for (Index j = 0; j < s.nv; ++j) {
      const Vec3 &p = profile.poles[i], &q = turn.poles[j];
      s.poles.push_back({p.x * q.x, p.x * q.y, p.y});
      s.weights.push_back((profile.weights.empty() ? 1 : profile.weights[i]) * turn.weights[j]);
    }
  }
  s.knots_u = profile.knots, s.knots_v = turn.knots;
  s.u0 = profile.u0, s.u1 = profile.u1, s.v0 = 0, s.v1 = quarters;
  return s;
}

inline SplineCurveRecord line(const Vec3& a, const Vec3& b) { return {1, {a, b}, {}, {0, 0, 1, 1}, 0, 1}; }

// n poles, clamped, with knots between unevenly spread over [0, 1].
inline std::vector<double> uneven_knots(int degree, int n, double power) {
  std::vector<double> knots(degree + 1, 0.0);
  for (int i = 1; i < n - degree; ++i)
    knots.push_back(std::pow(static_cast<double>(i) / (n - degree), power));
  knots.insert(knots.end(), degree + 1, 1.0);
  return knots;
}

// A bumpy sheet over [0, 1] x [0, 1].
inline SplineSurfaceRecord bumpy(int degree, int n, bool rational, double power, double height, int seed) {
  SplineSurfaceRecord s;
  s.degree_u = s.degree_v = degree;
  s.nu = s.nv = n;
  Random random(seed);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = static_cast<double>(i) / (n - 1), y = static_cast<double>(j) / (n - 1);
      s.poles.push_back({x, y, height * random.symmetric()});
      if (rational) s.weights.push_back(0.5 + random.uniform());
    }
  }
  s.knots_u = s.knots_v = uneven_knots(degree, n, power);
  return s;
}

}  // namespace dm::test
