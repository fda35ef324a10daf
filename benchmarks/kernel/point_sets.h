// Point sets of the kernel benchmarks, the same for both rivals.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"

namespace dm::benchmark {

inline std::vector<Vec3> uniform(int n) {
  Random random(1, n);
  std::vector<Vec3> points(n);
  for (Vec3& p : points) p = {random.uniform(), random.uniform(), random.uniform()};
  return points;
}

inline std::vector<Vec3> sphere(int n) {
  Random random(2, n);
  std::vector<Vec3> points(n);
  for (Vec3& p : points) p = normalized(random.in_ball());
  return points;
}

// Rows of points on circles, as a mesher places them on a cylinder: many exact and near ties.
inline std::vector<Vec3> cylinder(int n) {
  const int around = static_cast<int>(std::sqrt(n));
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * (i % around) / around;
    points.push_back({10 * std::cos(angle), 10 * std::sin(angle), 50.0 * (i / around) / around});
  }
  return points;
}

inline std::vector<Vec3> clusters(int n) {
  Random random(3, n);
  std::vector<Vec3> centres(100), points(n);
  for (Vec3& c : centres) c = {random.uniform(), random.uniform(), random.uniform()};
  for (int i = 0; i < n; ++i) points[i] = centres[i % 100] + 0.002 * random.in_ball();
  return points;
}

}  // namespace dm::benchmark
