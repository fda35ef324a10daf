// Places of CAD faces that are too narrow for the wanted sizes, and edges too short: which points would have
// to become one to absorb each.
//
// A face is narrow where a point of one of its curves has another one at less than the tolerance across the
// face, and at less than a fifth of the radius of one of them: the step in a hole is no detail of it.  Where
// the other curve has no point there, its segment is divided, on the exact curve; flips then make every
// triangle there have a side across, also where the segments bulge further than the face is wide.  These
// sides, and tiny edges, are the pairs of points.
// Where two curves run together in a sharp tip, one of them is divided at the width that may just be
// absorbed; so is one that comes near another between two of its points, on both sides of the neck.  Points
// of the tessellation inside tips and strips are left out.  Connected ones belong together: a strip is
// absorbed at both of its ends or not at all.  Cost: linear, and logarithmic in the size of faces with narrow
// places.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "plc/geometry.h"
#include "plc/plc.h"

namespace dm {

using Tolerance = std::function<double(const Vec3&)>;  // mm, at a place

using SmallFeature = std::vector<std::pair<Index, Index>>;  // points that become one

// Largest distance of points that become one (mm).
double width_of(const SmallFeature& feature, const std::vector<Vec3>& points);

// Narrowest first.  Segments of the PLC may be divided, triangles at narrow places flipped, and points of the
// tessellation inside a face left out near its curves.
std::vector<SmallFeature> find_small_features(Plc& plc, const Geometry& geometry, const Tolerance& tolerance);

}  // namespace dm
