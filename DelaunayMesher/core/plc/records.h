// The CAD geometry as it comes in: checked, and splines that are really planes or lines made so.
#pragma once

#include "plc/geometry.h"

namespace dm {

// Throws Failure("plc", "bad_geometry", ...) naming the face or edge with an impossible record.
void check_records(const GeometryRecords& records, std::size_t face_count, std::size_t edge_count);

// Precondition: check_records() passed.  A spline counts as flat or straight when its poles are within 1e-11
// of its size and 1e-10 mm.
void simplify_records(GeometryRecords& records);

}  // namespace dm
