// CAD edges and faces that are too small for the wanted sizes: what would have to be joined to absorb each.
//
// A face is narrow when the distance of every point of its boundary from the curves opposite is below the
// tolerance; where a point of one curve has none facing
// it on the other, the other's segment is divided there, on the exact curve.  An edge is tiny when its length
// is below the tolerance and it is not closed.  Cost: linear, and quadratic in the boundary of narrow faces.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "plc/geometry.h"
#include "plc/plc.h"

namespace dm {

using Tolerance = std::function<double(const Vec3&)>;  // mm, at a place

struct SmallFeature {
  Index face = -1, edge = -1;                  // one of them
  std::vector<std::pair<Index, Index>> pairs;  // points that become one
};

// Narrow faces first, then tiny edges by length.  Segments of the PLC may be divided.
std::vector<SmallFeature> find_small_features(Plc& plc, const Geometry& geometry, const Tolerance& tolerance);

// Segments by their ends, and those round a face with the direction in which its triangles run along them.
class SegmentTable {
 public:
  explicit SegmentTable(const Plc& plc);
  Index find(Index a, Index b) const;  // -1 = none
  // Directed boundary of each face of `wanted` (by face).
  std::vector<std::vector<Segment>> boundaries(const Plc& plc, const std::vector<char>& wanted) const;

 private:
  std::vector<std::array<Index, 3>> ends_;  // sorted: lower point, higher point, segment
};

}  // namespace dm
