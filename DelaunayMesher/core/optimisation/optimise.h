// The optimisation stage: flips and smoothing, worst elements with all means, all elements with cheap ones.
//
// Idea: a refined Delaunay mesh has no slivers left, so three to five rounds of cheap flips of its sharp
// elements and one smoothing step of every point raise the average angle, and only some per mille of the
// elements need the full set of operations (Freitag, Ollivier-Gooch 1997; Klingner, Shewchuk 2007), the last
// of which inserts and removes points, also on the boundary (rescue.h).
// Precondition: check_volume_mesh(mesh).  Postcondition: the same; the smallest angle is no smaller and the
// largest no larger than before, unless within 30..136 degrees, or 26.5..140 where one of the two was worse
// (keeps_angles in quality.h); every boundary point lies on its CAD element;
// no interior triangle has its corners on one CAD face that did not have them before.
// The mesh is renumbered (spatial_order.h).  Threads: rounds over the whole mesh use all of the context's,
// the worst elements one; the result is the same for any number (sweep.h).  Cost: 1 to 1.5 us per
// tetrahedron, up to 20 in thin parts, where the number of rescues is bounded (rescue.h).  Limits: an element
// at an acute edge, or in a strip or gap far narrower than its size, stays as it is.
#pragma once

#include "base/context.h"
#include "base/volume_mesh.h"
#include "plc/geometry.h"

namespace dm {

struct OptimiseOptions {
  double target_angle = 30;  // degrees: elements below it (or above the matching maximum) are worked on
};
struct OptimiseReport {
  double min_before = 0, min_after = 0, max_before = 0, max_after = 0;  // degrees
  std::int64_t smoothed = 0, flipped = 0, collapsed = 0, rescued = 0;
};

// Interior points move freely, points on a CAD face or edge slide on it, CAD vertices stay.  The boundary
// triangulation changes by moving, inserting and removing its points and by flips inside one CAD face.
OptimiseReport optimise(VolumeMesh& mesh, const Geometry& geometry, const OptimiseOptions& options,
                        Context& context);

}  // namespace dm
