// Repair of inverted ten-node tetrahedra.
//
// Boundary nodes are on the CAD and stay there; what can give way is inside.  In this order, each step kept
// only where it raises a smooth minimum of the Jacobian coefficients of all the elements it touches: interior
// mid-side nodes, interior corner points (the straight edges there follow), boundary mid-side nodes sliding
// on their CAD face or edge, and as a last resort boundary mid-side nodes put back on the straight edge.
// Method: steps along the gradient of that minimum, by differences (compare Toulorge et al. 2013).
// Postcondition: every ratio is positive, but those of elements that have no volume with straight edges
// either.  Cost: some 100 us per bad element.
#pragma once

#include <vector>

#include "order/curved_mesh.h"
#include "plc/geometry.h"

namespace dm {

// `bad`: elements whose ratio is below kGoodRatio.  Returns the elements that were straightened.
inline constexpr double kGoodRatio = 0.1;
std::vector<Index> repair(CurvedMesh& mesh, const Geometry& geometry, std::vector<Index> bad,
                          Context& context);

}  // namespace dm
