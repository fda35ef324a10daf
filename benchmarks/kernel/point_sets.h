// Point sets of the kernel benchmarks, the same for both rivals.
#pragma once

#include <algorithm>
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

// The surface mesh of a CAD part: a plate with holes and bosses, its nodes where a mesher puts them, in rows
// on planes, circles and cylinders, about `n` of them.  Most spheres of the triangulation pass near other
// nodes.
inline std::vector<Vec3> plate(int n) {
  const double width = 200, depth = 120, thickness = 8, radius = 6, boss = 12, pitch = 40;
  const double h = std::sqrt(2.6 * width * depth / n);
  const int holes_x = 5, holes_y = 3;
  std::vector<Vec3> points;
  const auto centre = [&](int k) { return Vec3{20 + pitch * (k % holes_x), 20 + pitch * (k / holes_x), 0}; };
  const auto in_hole = [&](double x, double y, double r) {
    for (int k = 0; k < holes_x * holes_y; ++k)
      if (std::hypot(x - centre(k).x, y - centre(k).y) < r + 0.4 * h) return true;
    return false;
  };
  const int nx = int(std::ceil(width / h)), ny = int(std::ceil(depth / h));
  const int nz = std::max(1, int(std::ceil(thickness / h)));
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j) {
      const double x = width * i / nx, y = depth * j / ny;
      const bool side = i == 0 || j == 0 || i == nx || j == ny;
      for (int k = 0; k <= nz; ++k)
        if (side || k == 0 || k == nz)
          if (!in_hole(x, y, k == nz ? boss : radius)) points.push_back({x, y, thickness * k / nz});
    }
  const auto cylinder_at = [&](const Vec3& c, double r, double low, double high) {
    const int around = std::max(12, int(std::ceil(2 * std::numbers::pi * r / h)));
    const int up = std::max(1, int(std::ceil((high - low) / h)));
    for (int i = 0; i < around; ++i)
      for (int k = 0; k <= up; ++k) {
        const double angle = 2 * std::numbers::pi * i / around;
        points.push_back({c.x + r * std::cos(angle), c.y + r * std::sin(angle), low + (high - low) * k / up});
      }
  };
  for (int k = 0; k < holes_x * holes_y; ++k) {
    cylinder_at(centre(k), radius, 0, 2 * thickness);
    cylinder_at(centre(k), boss, thickness, 2 * thickness);
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
