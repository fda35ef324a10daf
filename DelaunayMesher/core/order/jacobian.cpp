#include "order/jacobian.h"

#include <algorithm>

namespace dm {
namespace {

// Number of the coefficient of the product of linear terms i, j, k.
constexpr std::array<std::array<std::array<int, 4>, 4>, 4> make_slots() {
  std::array<std::array<std::array<int, 4>, 4>, 4> slots{};
  int next = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j)
      for (int k = j; k < 4; ++k) {
        slots[i][j][k] = slots[i][k][j] = slots[j][i][k] = slots[j][k][i] = slots[k][i][j] = slots[k][j][i] =
            next;
        ++next;
      }
  return slots;
}
constexpr auto kSlots = make_slots();

constexpr std::array<int, 20> make_counts() {
  std::array<int, 20> counts{};
  for (const auto& plane : kSlots)
    for (const auto& row : plane)
      for (const int slot : row) ++counts[slot];
  return counts;
}
constexpr auto kCounts = make_counts();

}  // namespace

std::array<double, 20> jacobian_coefficients(const TenNodes& x) {
  Vec3 control[4][4];  // Bezier control points of the quadratic map
  for (int i = 0; i < 4; ++i) control[i][i] = x[i];
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kTetEdges[e];
    control[i][j] = control[j][i] = 2 * x[4 + e] - 0.5 * (x[i] + x[j]);
  }
  // Derivatives along the three edges at corner 0: linear, with control value i at corner i.
  Vec3 d[3][4];
  for (int m = 0; m < 3; ++m)
    for (int i = 0; i < 4; ++i) d[m][i] = control[i][m + 1] - control[i][0];
  std::array<double, 20> sum{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const Vec3 n = cross(d[0][i], d[1][j]);
      for (int k = 0; k < 4; ++k) sum[kSlots[i][j][k]] += dot(n, d[2][k]);
    }
  for (int s = 0; s < 20; ++s) sum[s] *= 8.0 / kCounts[s];  // each derivative carries a factor 2
  return sum;
}

double jacobian_ratio(const TenNodes& nodes) {
  const auto c = jacobian_coefficients(nodes);
  const auto [low, high] = std::minmax_element(c.begin(), c.end());
  const double scale = std::max(std::abs(*low), std::abs(*high));
  return scale > 0 ? *low / scale : -1;
}

}  // namespace dm
