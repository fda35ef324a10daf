// Insertion order of a point set: random rounds of growing size, each along a Hilbert curve.
//
// Idea: biased randomised insertion order (Amenta, Choi, Rote 2003) on a Hilbert curve
// (base/hilbert_curve.h).  The rounds keep the expected cost of the worst point set, the curve keeps
// consecutive points near each other.
// Postcondition: a permutation that depends on the points alone.  Cost: linear (radix sort).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.h"

namespace dm {

struct InsertionOrder {
  std::vector<Index> order;          // point numbers
  std::vector<std::uint32_t> codes;  // codes[k]: position of order[k] on the curve; ascending within a round
  std::vector<Index> rounds;         // round r is order[rounds[r]] .. order[rounds[r + 1] - 1]
};

InsertionOrder insertion_order(std::span<const Vec3> points);

}  // namespace dm
