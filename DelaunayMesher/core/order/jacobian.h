// Validity of a ten-node tetrahedron, proved: bounds of its Jacobian determinant over the whole element.
//
// The determinant is a cubic polynomial of the barycentric coordinates; it lies between the smallest and the
// largest of its 20 Bernstein coefficients (Johnen, Remacle, Geuzaine 2013).  If all are positive the element
// is nowhere inverted; for a straight-sided element all equal six times its volume.
#pragma once

#include <array>

#include "base/vec3.h"

namespace dm {

using TenNodes = std::array<Vec3, 10>;  // VTK order: corners, then the middles of 01 12 02 03 13 23

// Corners of the edge of mid-side node 4 + i.
inline constexpr int kTetEdges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

std::array<double, 20> jacobian_coefficients(const TenNodes& nodes);

// Smallest coefficient over the largest absolute one: 1 for straight sides, > 0 proves validity.
double jacobian_ratio(const TenNodes& nodes);

}  // namespace dm
