#include "kernel/sphere_tests.h"

#include <cstring>

#include "kernel/predicates.h"

#if defined(__GNUC__) && defined(__x86_64__)
#define DM_AVX2 1
#include <immintrin.h>
#endif

namespace dm {

void sphere_tests_plain(const Vec3* points, const Tet* corners, Index* tets, std::size_t count, const Vec3& p,
                        std::int8_t* sign) {
  for (std::size_t k = 0; k < count; ++k) {
    const Tet& c = corners[tets[k]];
    if (c[3] < 0) {
      sign[k] = 0;
      continue;
    }
    const filter::Seen seen = filter::see(points[c[0]], points[c[1]], points[c[2]], points[c[3]], p);
    const double power = seen.power();
    const int certain = power * power > seen.power_error2();
    sign[k] = static_cast<std::int8_t>(power > 0 ? certain : -certain);
  }
}

#ifdef DM_AVX2
namespace {

struct Four {
  __m256d x, y, z;
};

// Where the corners of a tetrahedron are among the coordinates (3 * vertex); a ghost is read as vertex 0.
struct Places {
  std::uint64_t at[4];
  unsigned ghost;
};
__attribute__((target("avx2"), always_inline)) inline Places places(const Tet& corners) {
  const __m128i v = _mm_loadu_si128(reinterpret_cast<const __m128i*>(corners.data()));
  const __m128i at = _mm_max_epi32(_mm_add_epi32(_mm_add_epi32(v, v), v), _mm_setzero_si128());
  const auto low = static_cast<std::uint64_t>(_mm_cvtsi128_si64(at));
  const auto high = static_cast<std::uint64_t>(_mm_extract_epi64(at, 1));
  constexpr std::uint64_t half = 0xffffffff;
  return {{low & half, low >> 32, high & half, high >> 32}, static_cast<std::uint32_t>(corners[3]) >> 31};
}

// Corner i of four tetrahedra relative to p.
__attribute__((target("avx2"), always_inline)) inline Four gather(const double* x, const Places* tet, int i,
                                                                  const Four& p) {
  const double *q0 = x + tet[0].at[i], *q1 = x + tet[1].at[i], *q2 = x + tet[2].at[i], *q3 = x + tet[3].at[i];
  const __m256d xy02 = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(q0)), _mm_loadu_pd(q2), 1);
  const __m256d xy13 = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(q1)), _mm_loadu_pd(q3), 1);
  const __m128d z01 = _mm_loadh_pd(_mm_load_sd(q0 + 2), q1 + 2);
  const __m128d z23 = _mm_loadh_pd(_mm_load_sd(q2 + 2), q3 + 2);
  return {_mm256_unpacklo_pd(xy02, xy13) - p.x, _mm256_unpackhi_pd(xy02, xy13) - p.y,
          _mm256_insertf128_pd(_mm256_castpd128_pd256(z01), z23, 1) - p.z};
}

// Byte k of the result is 1 where bit k of the four is set.
inline std::uint32_t spread(unsigned bits) { return (bits * 0x00204081u) & 0x01010101u; }

__attribute__((target("avx2"), always_inline)) inline __m256d minor_xy(const Four& a, const Four& b) {
  return a.x * b.y - a.y * b.x;
}
__attribute__((target("avx2"), always_inline)) inline __m256d square(const Four& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}

// The formulas of filter::see, in the same order.
__attribute__((target("avx2"))) void sphere_tests_avx2(const Vec3* points, const Tet* corners, Index* tets,
                                                       std::size_t count, const Vec3& p, std::int8_t* sign) {
  const Four q = {_mm256_set1_pd(p.x), _mm256_set1_pd(p.y), _mm256_set1_pd(p.z)};
  if (count == 0) return;
  const double* x = &points->x;
  for (std::size_t k = count; k % 4 != 0; ++k) tets[k] = tets[count - 1];
  for (std::size_t k = 0; k < count; k += 4) {
    const Places tet[4] = {places(corners[tets[k]]), places(corners[tets[k + 1]]),
                           places(corners[tets[k + 2]]), places(corners[tets[k + 3]])};
    const Four A = gather(x, tet, 0, q), B = gather(x, tet, 1, q);
    const Four C = gather(x, tet, 2, q), D = gather(x, tet, 3, q);
    const __m256d ab = minor_xy(A, B), ac = minor_xy(A, C), ad = minor_xy(A, D);
    const __m256d bc = minor_xy(B, C), bd = minor_xy(B, D), cd = minor_xy(C, D);
    const __m256d a2 = square(A), b2 = square(B), c2 = square(C), d2 = square(D);
    const __m256d va = (B.z * cd - C.z * bd) + D.z * bc, vb = (C.z * ad - A.z * cd) - D.z * ac;
    const __m256d vc = (A.z * bd - B.z * ad) + D.z * ab, vd = (B.z * ac - A.z * bc) - C.z * ab;
    const __m256d power = (a2 * va + b2 * vb) + (c2 * vc + d2 * vd);
    const __m256d largest = _mm256_max_pd(_mm256_max_pd(a2, b2), _mm256_max_pd(c2, d2));
    const __m256d l2 = largest * largest;
    const __m256d error2 = _mm256_set1_pd(filter::kInsphere * filter::kInsphere) * (l2 * l2 * largest) +
                           _mm256_set1_pd(filter::kTiny);
    const __m256d certain = _mm256_cmp_pd(power * power, error2, _CMP_GT_OQ);
    const __m256d inside = _mm256_cmp_pd(power, _mm256_setzero_pd(), _CMP_GT_OQ);
    const unsigned finite = 15u ^ (tet[0].ghost | tet[1].ghost << 1 | tet[2].ghost << 2 | tet[3].ghost << 3);
    const auto known = static_cast<unsigned>(_mm256_movemask_pd(certain)) & finite;
    const auto plus = known & static_cast<unsigned>(_mm256_movemask_pd(inside));
    const std::uint32_t signs = spread(plus) | spread(known ^ plus) * 255u;
    std::memcpy(sign + k, &signs, sizeof(signs));
  }
}

}  // namespace
#endif

SphereTests sphere_tests() {
#ifdef DM_AVX2
  if (__builtin_cpu_supports("avx2")) return sphere_tests_avx2;
#endif
  return sphere_tests_plain;
}

}  // namespace dm
