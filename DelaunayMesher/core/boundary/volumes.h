// The volume of each solid, once by the triangles of the surface mesh and once by its tetrahedra.
//
// They agree but for the points that later stages put on curved faces; where the surface mesh crosses itself,
// and tetrahedra went to the wrong side, they do not.  Cost: one pass over each.
#pragma once

#include <vector>

#include "base/volume_mesh.h"
#include "surfaces/surface_mesh.h"

namespace dm {

// mm3, of the solids 1, 2, ... in order.
std::vector<double> surface_volumes(const SurfaceMesh& surface, const Plc& plc);
std::vector<double> tet_volumes(const VolumeMesh& mesh, Index solid_count);

}  // namespace dm
