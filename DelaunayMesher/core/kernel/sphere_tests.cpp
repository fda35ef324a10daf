#include "kernel/sphere_tests.h"

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

// Corner i of four tetrahedra relative to p; a ghost is read as vertex 0.
__attribute__((target("avx2"), always_inline)) inline Four gather(const Vec3* points, const Tet* const* tet,
                                                                  int i, const Four& p) {
  const Vec3* q[4];
  for (int k = 0; k < 4; ++k) q[k] = points + ((*tet[k])[i] < 0 ? 0 : (*tet[k])[i]);
  const __m256d xy02 =
      _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(&q[0]->x)), _mm_loadu_pd(&q[2]->x), 1);
  const __m256d xy13 =
      _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(&q[1]->x)), _mm_loadu_pd(&q[3]->x), 1);
  const __m128d z01 = _mm_loadh_pd(_mm_load_sd(&q[0]->z), &q[1]->z);
  const __m128d z23 = _mm_loadh_pd(_mm_load_sd(&q[2]->z), &q[3]->z);
  return {_mm256_unpacklo_pd(xy02, xy13) - p.x, _mm256_unpackhi_pd(xy02, xy13) - p.y,
          _mm256_insertf128_pd(_mm256_castpd128_pd256(z01), z23, 1) - p.z};
}

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
  for (std::size_t k = count; k % 4 != 0; ++k) tets[k] = tets[count - 1];
  for (std::size_t k = 0; k < count; k += 4) {
    const Tet* tet[4] = {&corners[tets[k]], &corners[tets[k + 1]], &corners[tets[k + 2]],
                         &corners[tets[k + 3]]};
    const Four A = gather(points, tet, 0, q), B = gather(points, tet, 1, q);
    const Four C = gather(points, tet, 2, q), D = gather(points, tet, 3, q);
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
    const int certain = _mm256_movemask_pd(_mm256_cmp_pd(power * power, error2, _CMP_GT_OQ));
    const int positive = _mm256_movemask_pd(_mm256_cmp_pd(power, _mm256_setzero_pd(), _CMP_GT_OQ));
    for (int j = 0; j < 4; ++j) {
      const int known = (certain >> j & 1) & ((*tet[j])[3] >= 0);
      sign[k + j] = static_cast<std::int8_t>(known * (2 * (positive >> j & 1) - 1));
    }
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
