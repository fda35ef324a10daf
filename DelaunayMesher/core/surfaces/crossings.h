// Which triangles of a surface cross each other: no triangulation can contain both.
//
// A box tree is joined with itself; a pair whose boxes overlap is tested edge against triangle.  Orientations
// are floating-point with an error bound, and an uncertain one counts as touching: what matters to the
// surfaces stage is real crossings, not which side of rounding a contact lies on.
// Cost: O(n log n + pairs of triangles whose boxes overlap), about a microsecond per triangle.
#pragma once

#include <vector>

#include "base/context.h"
#include "base/vec3.h"

namespace dm {

// For each triangle: a surface with more crossings lies over itself or another one.
constexpr std::size_t kMostCrossings = 16;

// Pairs (i < j, sorted) of triangles whose interiors cross properly, or overlap in a common plane.  Triangles
// that share an edge or merely touch do not count.  The search ends when it has found `most`: a surface that
// crosses itself everywhere has a quadratic number of them.
std::vector<std::array<Index, 2>> find_crossings(const std::vector<Vec3>& points,
                                                 const std::vector<Triangle>& triangles, Context& context,
                                                 std::size_t most = SIZE_MAX);

}  // namespace dm
