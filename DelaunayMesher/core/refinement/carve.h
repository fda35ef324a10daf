// Tetrahedra that are flat (is_flat()) are left out of the mesh: their volume is nothing, and no solver takes
// them.  Those on the outer boundary are carved from the triangulation; those between solids at the end.
//
// They are left where the input forces them: tangential contacts, faces closer than rounding.  Precondition
// and postcondition: check_boundary.  Cost: one pass, and another only when something was carved.
#pragma once

#include <vector>

#include "base/volume_mesh.h"
#include "boundary/recovery.h"

namespace dm {

// Returns the number of tetrahedra left out.  Segments that are no edge of the mesh any more are dropped.
Index carve_flat_tets(LabelledTriangulation& mesh);

// The flat ones that are left, most of them between solids that touch where no CAD face separates them, so
// that the other tetrahedra cannot meet in their place.  The boundary triangles stay, as do the last
// tetrahedra of a point. Neighbours are not kept.  Returns the places of what was left out.
std::vector<Vec3> leave_out_flat_tets(VolumeMesh& mesh);

}  // namespace dm
