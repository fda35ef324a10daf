#include "optimisation/fan.h"

#if defined(__GNUC__) && defined(__x86_64__)
#define DM_INLINE inline __attribute__((always_inline))
#define DM_WIDE __attribute__((target("avx2")))
#else
#define DM_INLINE inline
#endif

namespace dm {
namespace {

DM_INLINE double larger(double a, double b) { return a > b ? a : b; }
DM_INLINE double smaller(double a, double b) { return a < b ? a : b; }

// Face normals (all outward or all inward) are cross products of the edges at the apex; the fourth is minus
// their sum.  The cosine of a dihedral angle is minus that of the angle between two normals.
DM_INLINE void extreme_cosines(const Fan& fan, const Vec3& p, double side, double* __restrict sharp,
                               double* __restrict blunt) {
  const auto& c = fan.corner;
  for (int k = 0; k < fan.count; ++k) {
    const double ux = c[0][k] - p.x, uy = c[1][k] - p.y, uz = c[2][k] - p.z;
    const double vx = c[3][k] - p.x, vy = c[4][k] - p.y, vz = c[5][k] - p.z;
    const double wx = c[6][k] - p.x, wy = c[7][k] - p.y, wz = c[8][k] - p.z;
    const double ax = vy * wz - vz * wy, ay = vz * wx - vx * wz, az = vx * wy - vy * wx;
    const double bx = wy * uz - wz * uy, by = wz * ux - wx * uz, bz = wx * uy - wy * ux;
    const double gx = uy * vz - uz * vy, gy = uz * vx - ux * vz, gz = ux * vy - uy * vx;
    const double volume = -side * (ax * ux + ay * uy + az * uz);
    const double aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz;
    const double gg = gx * gx + gy * gy + gz * gz;
    const double ab = ax * bx + ay * by + az * bz, ag = ax * gx + ay * gy + az * gz;
    const double bg = bx * gx + by * gy + bz * gz;
    const double ad = aa + ab + ag, bd = bb + ab + bg,
                 gd = gg + ag + bg;  // minus the products with the fourth
    const double dd = ad + bd + gd;
    const double la = 1 / std::sqrt(aa), lb = 1 / std::sqrt(bb), lg = 1 / std::sqrt(gg),
                 ld = 1 / std::sqrt(dd);
    const double c0 = -ab * la * lb, c1 = -ag * la * lg, c2 = -bg * lb * lg;
    const double c3 = ad * la * ld, c4 = bd * lb * ld, c5 = gd * lg * ld;
    const double high = larger(larger(larger(c0, c1), larger(c2, c3)), larger(c4, c5));
    const double low = smaller(smaller(smaller(c0, c1), smaller(c2, c3)), smaller(c4, c5));
    const bool valid = volume > 0 && high <= 1 && low >= -1;  // false for NaN
    sharp[k] = valid ? high : 1;
    blunt[k] = valid ? low : -1;
  }
}

DM_INLINE void badness_of(int count, const double* __restrict sharp, const double* __restrict blunt,
                          double* __restrict bad) {
  for (int k = 0; k < count; ++k) {
    const double b = larger(sharp[k] - 1.0 / 3, kBluntWeight * (1.0 / 3 - blunt[k]));
    bad[k] = blunt[k] > -1 ? b : kInverted;
  }
}

DM_INLINE void evaluate(const Fan& fan, const Vec3& apex, double side, double* bad) {
  double sharp[Fan::kCapacity], blunt[Fan::kCapacity];
  extreme_cosines(fan, apex, side, sharp, blunt);
  badness_of(fan.count, sharp, blunt, bad);
}

// Four running values each, combined in a fixed order: the same for every vector width.
DM_INLINE FanScore score(const Fan& fan, const Vec3& apex, bool soft, double* bad) {
  alignas(32) double sharp[Fan::kCapacity], blunt[Fan::kCapacity], power[Fan::kCapacity];
  extreme_cosines(fan, apex, 1, sharp, blunt);
  badness_of(fan.count, sharp, blunt, bad);
  for (int k = 0; k < fan.count; ++k) {
    const double p2 = bad[k] * bad[k], p4 = p2 * p2, p8 = p4 * p4;
    power[k] = soft ? p2 : p8 * p8;
  }
  for (int k = fan.count; k < ((fan.count + 3) & ~3); ++k) {  // padding that changes nothing
    power[k] = 0;
    sharp[k] = -1;
    blunt[k] = 1;
  }
  double sum[4] = {0, 0, 0, 0}, high[4] = {-1, -1, -1, -1}, low[4] = {1, 1, 1, 1};
  for (int k = 0; k < fan.count; k += 4)
    for (int j = 0; j < 4; ++j) {
      sum[j] += power[k + j];
      high[j] = larger(high[j], sharp[k + j]);
      low[j] = smaller(low[j], blunt[k + j]);
    }
  return {(sum[0] + sum[1]) + (sum[2] + sum[3]),
          {larger(larger(high[0], high[1]), larger(high[2], high[3])),
           smaller(smaller(low[0], low[1]), smaller(low[2], low[3]))}};
}

#ifdef DM_WIDE
DM_WIDE void evaluate_wide(const Fan& fan, const Vec3& apex, double side, double* bad) {
  evaluate(fan, apex, side, bad);
}
DM_WIDE FanScore score_wide(const Fan& fan, const Vec3& apex, bool soft, double* bad) {
  return score(fan, apex, soft, bad);
}
#endif

}  // namespace

void fan_badness(const Fan& fan, const Vec3& apex, double side, double* bad) {
#ifdef DM_WIDE
  static const bool wide = __builtin_cpu_supports("avx2");
  if (wide) return evaluate_wide(fan, apex, side, bad);
#endif
  evaluate(fan, apex, side, bad);
}

FanScore fan_score(const Fan& fan, const Vec3& apex, bool soft, double* bad) {
#ifdef DM_WIDE
  static const bool wide = __builtin_cpu_supports("avx2");
  if (wide) return score_wide(fan, apex, soft, bad);
#endif
  return score(fan, apex, soft, bad);
}

}  // namespace dm
