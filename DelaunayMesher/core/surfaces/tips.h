// Sharp tips: corners of a CAD face where two of its curves run together at less than 10 degrees, as those of
// a crescent, or of a fillet that runs out.
//
// Cost: a sort of the segments' sides, and two projections on a curve for each corner of a face.
#pragma once

#include <vector>

#include "plc/geometry.h"
#include "surfaces/small_features.h"

namespace dm {

struct Tip {
  Index face, point;
  Index edge, other_edge;
};

// The tolerance says how near to the corner the angle is measured.
std::vector<Tip> find_tips(const Plc& plc, const Geometry& geometry, const Tolerance& tolerance);

}  // namespace dm
