// Filtered sphere tests of many tetrahedra against one point: four at a time where the processor has AVX2.
//
// Precondition: every corner but a ghost (corner 3 = -1) is a valid index of `points`.
// Postcondition: sign[k] is +1 when p is certainly inside the sphere of tets[k], -1 when certainly outside, 0
// when the filter of predicates.h cannot tell or when the tetrahedron is a ghost.  Both versions round alike.
// `tets` and `sign` must have room up to the next multiple of 4 (those entries of tets are overwritten).
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/vec3.h"

namespace dm {

using SphereTests = void (*)(const Vec3* points, const Tet* corners, Index* tets, std::size_t count,
                             const Vec3& p, std::int8_t* sign);

// The fastest version that this processor runs.
SphereTests sphere_tests();
void sphere_tests_plain(const Vec3* points, const Tet* corners, Index* tets, std::size_t count, const Vec3& p,
                        std::int8_t* sign);

}  // namespace dm
