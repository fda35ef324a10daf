// Which triangles of a surface cross each other: no triangulation can contain both.
#pragma once

#include <vector>

#include "base/vec3.h"

namespace dm {

// Pairs (i < j) of triangles whose interiors cross properly, by exact predicates.  Triangles that share an
// edge or merely touch do not count.  Cost O(n log n + candidates).
std::vector<std::array<Index, 2>> find_intersections(const std::vector<Vec3>& points,
                                                     const std::vector<Triangle>& triangles);

}  // namespace dm
