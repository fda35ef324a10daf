// The optimisation stage: worst elements first, no step lowers the worst angle it touches.
#pragma once

#include "base/context.h"
#include "base/volume_mesh.h"
#include "plc/geometry.h"
#include "sizing/size_field.h"

namespace dm {

struct OptimiseOptions {
  double target_angle = 30;  // degrees: elements below it (or above the matching maximum) are worked on
};
struct OptimiseReport {
  double min_before = 0, min_after = 0, max_before = 0, max_after = 0;  // degrees
  std::int64_t smoothed = 0, flipped = 0, collapsed = 0, inserted = 0;
};

// Interior points move freely, points on a CAD face or edge slide on it, CAD vertices stay.  The boundary
// triangulation changes only by moving its points and by flips inside one CAD face.
OptimiseReport optimise(VolumeMesh& mesh, const Geometry& geometry, const SizeField& size,
                        const OptimiseOptions& options, Context& context);

}  // namespace dm
