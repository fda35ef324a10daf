// Sizes that thin walls, narrow gaps and necks need.
//
// From places on every triangle a ray is shot along both normals.  It measures a wall (inside a solid) or a
// gap (outside) of width t if the triangle that it hits first is roughly opposed: less than 15 degrees
// from parallel, else it is a taper.  The size is such that the edges of the boundary (kBoundaryEdge of it)
// are 2 / elements_across * c * t long with c = 2 (2.4 if the mesh will be optimised), 4.8 for gaps, or 1.48
// when the other side of the place is tight too (a gap or wall not wider than 2 t; any solid beside a wall,
// for which 2 is enough if the mesh will be optimised).  Measured limits for a 20 degree mesh before
// optimisation are 2.1 t and 1.5 t, for free walls after it 2.5 t. Two faces that meet at an acute angle (a
// wedge, a cusp at a tangent fillet) are no wall near their common edge: there t goes to zero and refinement
// would never end.  Necks between edges are found apart (edge_necks.h).  Cost: two short rays per place;
// places are one to two h_local apart, closer where the width varies.  Known limit: a feature much smaller
// than the triangles on both of its sides and the local size can be missed.
#pragma once

#include "sizing/boundary_tree.h"
#include "sizing/sources.h"

namespace dm {

// A triangle with a wall behind it that is at most about one element thick.
struct ThinWall {
  std::array<Vec3, 3> corner;
  double width;       // mm
  double weight = 1;  // with triangles beside it that are taken to be like it: their area, over its own
};

struct ProximityResult {
  std::vector<Index> limited;  // faces whose walls and gaps ask for smaller sizes than they get, and there:
  double wanted = HUGE_VAL, given = HUGE_VAL;      // mm, the smallest size asked for, and given
  double elements_wanted = 0, elements_given = 0;  // in all walls and gaps, about
  double floor = 0;                                // mm, the least they may get
  double crossing_floor = 0;                       // ... where facets would cross a gap
  std::vector<ThinWall> walls;
};

// Precondition: elements_across > 0.  triangle_size: size on each triangle by the other sources.
ProximityResult add_proximity(const Plc& plc, const Geometry& geometry, const BoundaryTree& boundary,
                              const SizeOptions& options, const SizeLimits& limits,
                              const std::vector<double>& triangle_size, Context& context,
                              std::vector<SizeSource>& sources);

}  // namespace dm
