// The order stage: mid-side nodes on the exact CAD geometry, each element proved valid.
#pragma once

#include "base/context.h"
#include "base/volume_mesh.h"
#include "plc/geometry.h"

namespace dm {

// Mid-side nodes in VTK order: edges 01 12 02 03 13 23 of a tetrahedron, 01 12 02 of a triangle, 01 of a
// line. They are appended after the corner points.
struct SecondOrder {
  std::vector<Vec3> points;  // mid-side nodes only
  std::vector<Entity> point_entity;
  std::vector<std::array<Index, 6>> tet_nodes;  // global numbers (corner count + index into points)
  std::vector<std::array<Index, 3>> triangle_nodes;
  std::vector<Index> segment_nodes;
  std::vector<Index> straightened;  // tetrahedra that needed a straight-sided boundary edge: last resort
};

// Precondition: check_volume_mesh(mesh).  Postcondition: every Bernstein coefficient of every element's
// Jacobian is positive (Johnen et al. 2013), but of elements without volume.  Cost: a projection for each
// boundary edge, some 100 us for each element to be repaired.  May move interior corner points of `mesh` to
// get there.
SecondOrder make_second_order(VolumeMesh& mesh, const Geometry& geometry, Context& context);

}  // namespace dm
