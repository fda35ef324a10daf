#include "optimisation/fan.h"

#if defined(__GNUC__) && defined(__x86_64__)
#define DM_INLINE inline __attribute__((always_inline))
#define DM_WIDE __attribute__((target("avx2")))
#else
#define DM_INLINE inline
#endif

namespace dm {
namespace {

constexpr float kThird = 1.0f / 3, kWeight = static_cast<float>(kBluntWeight);
constexpr float kSoftWeight = 0.35f;  // large angles count less for the mean, which is one of smallest angles
constexpr float kFlat = 0.99999f;     // cosine of a quarter of a degree

DM_INLINE float larger(float a, float b) { return a > b ? a : b; }
DM_INLINE float smaller(float a, float b) { return a < b ? a : b; }

// Face normals (all outward or all inward) are cross products of the edges at the apex; the fourth is minus
// their sum.  The cosine of a dihedral angle is minus that of the angle between two normals.
DM_INLINE void extreme_cosines(const Fan& fan, const Vec3& apex, float side, float* __restrict sharp,
                               float* __restrict blunt) {
  const auto& c = fan.corner;
  const Vec3 from = apex - fan.origin;
  const float px = static_cast<float>(from.x), py = static_cast<float>(from.y),
              pz = static_cast<float>(from.z);
  const int count = fan.padded();
  for (int k = 0; k < count; ++k) {
    const float ux = c[0][k] - px, uy = c[1][k] - py, uz = c[2][k] - pz;
    const float vx = c[3][k] - px, vy = c[4][k] - py, vz = c[5][k] - pz;
    const float wx = c[6][k] - px, wy = c[7][k] - py, wz = c[8][k] - pz;
    const float ax = vy * wz - vz * wy, ay = vz * wx - vx * wz, az = vx * wy - vy * wx;
    const float bx = wy * uz - wz * uy, by = wz * ux - wx * uz, bz = wx * uy - wy * ux;
    const float gx = uy * vz - uz * vy, gy = uz * vx - ux * vz, gz = ux * vy - uy * vx;
    const float volume = -side * (ax * ux + ay * uy + az * uz);
    const float aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz;
    const float gg = gx * gx + gy * gy + gz * gz;
    const float ab = ax * bx + ay * by + az * bz, ag = ax * gx + ay * gy + az * gz;
    const float bg = bx * gx + by * gy + bz * gz;
    const float ad = aa + ab + ag, bd = bb + ab + bg,
                gd = gg + ag + bg;  // minus the products with the fourth
    const float dd = ad + bd + gd;
    const float la = 1.0f / std::sqrt(aa), lb = 1.0f / std::sqrt(bb), lg = 1.0f / std::sqrt(gg),
                ld = 1.0f / std::sqrt(dd);
    const float c0 = -ab * la * lb, c1 = -ag * la * lg, c2 = -bg * lb * lg;
    const float c3 = ad * la * ld, c4 = bd * lb * ld, c5 = gd * lg * ld;
    const float high = larger(larger(larger(c0, c1), larger(c2, c3)), larger(c4, c5));
    const float low = smaller(smaller(smaller(c0, c1), smaller(c2, c3)), smaller(c4, c5));
    const bool valid = volume > 0 && high <= kFlat && low >= -kFlat;  // false for NaN
    sharp[k] = valid ? high : 1;
    blunt[k] = valid ? low : -1;
  }
}

DM_INLINE void badness_of(int count, const float* __restrict sharp, const float* __restrict blunt,
                          float* __restrict bad) {
  for (int k = 0; k < count; ++k) {
    const float b = larger(sharp[k] - kThird, kWeight * (kThird - blunt[k]));
    bad[k] = blunt[k] > -1 ? b : static_cast<float>(kInverted);
  }
}

DM_INLINE void evaluate(const Fan& fan, const Vec3& apex, float side, float* bad) {
  float sharp[Fan::kCapacity], blunt[Fan::kCapacity];
  extreme_cosines(fan, apex, side, sharp, blunt);
  badness_of(fan.padded(), sharp, blunt, bad);
}

// Eight running values each, combined in a fixed order: the same for every vector width.
DM_INLINE FanScore score(const Fan& fan, const Vec3& apex, bool soft, float* bad) {
  alignas(32) float sharp[Fan::kCapacity], blunt[Fan::kCapacity], power[Fan::kCapacity];
  extreme_cosines(fan, apex, 1, sharp, blunt);
  badness_of(fan.padded(), sharp, blunt, bad);
  for (int k = 0; k < fan.padded(); ++k) {
    const float b =
        soft && blunt[k] > -1 ? larger(sharp[k] - kThird, kSoftWeight * (kThird - blunt[k])) : bad[k];
    const float p2 = b * b, p4 = p2 * p2, p8 = p4 * p4;
    power[k] = soft ? p2 : p8 * p8;
  }
  for (int k = fan.count; k < fan.padded(); ++k) power[k] = 0;
  float sum[8] = {}, high[8], low[8];
  for (int j = 0; j < 8; ++j) high[j] = -1, low[j] = 1;
  for (int k = 0; k < fan.padded(); k += 8)
    for (int j = 0; j < 8; ++j) {
      sum[j] += power[k + j];
      high[j] = larger(high[j], sharp[k + j]);
      low[j] = smaller(low[j], blunt[k + j]);
    }
  FanScore result{sum[0], {high[0], low[0]}};
  for (int j = 1; j < 8; ++j) {
    result.sum += sum[j];
    result.extremes.include({high[j], low[j]});
  }
  return result;
}

#ifdef DM_WIDE
DM_WIDE void evaluate_wide(const Fan& fan, const Vec3& apex, float side, float* bad) {
  evaluate(fan, apex, side, bad);
}
DM_WIDE FanScore score_wide(const Fan& fan, const Vec3& apex, bool soft, float* bad) {
  return score(fan, apex, soft, bad);
}
#endif

}  // namespace

void fan_badness(const Fan& fan, const Vec3& apex, float side, float* bad) {
#ifdef DM_WIDE
  static const bool wide = __builtin_cpu_supports("avx2");
  if (wide) return evaluate_wide(fan, apex, side, bad);
#endif
  evaluate(fan, apex, side, bad);
}

FanScore fan_score(const Fan& fan, const Vec3& apex, bool soft, float* bad) {
#ifdef DM_WIDE
  static const bool wide = __builtin_cpu_supports("avx2");
  if (wide) return score_wide(fan, apex, soft, bad);
#endif
  return score(fan, apex, soft, bad);
}

}  // namespace dm
