// Exact geometric predicates: static filter, then adaptive expansions, then symbolic perturbation.
#pragma once

#include <cstdint>

#include "base/vec3.h"

namespace dm {

// Sign of dot(cross(b - a, c - a), d - a): +1 when (a, b, c, d) is positively oriented, 0 when coplanar.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// +1 when e lies strictly inside the sphere through the positively oriented (a, b, c, d), -1 outside, 0 on it.
int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

struct PredicateCounters {
  std::uint64_t orient_exact = 0, insphere_exact = 0, insphere_perturbed = 0;
};
PredicateCounters& predicate_counters();  // of the calling thread

}  // namespace dm
