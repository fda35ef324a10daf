// Edge contraction: an interior point goes to the other end of one of its edges and leaves the mesh.
//
// The star of the point becomes the cone from the other end over the star's faces; it is valid exactly when
// every new tetrahedron is positively oriented.  Guard as for flips.  Cost: some microseconds.
#pragma once

#include "optimisation/edit_mesh.h"

namespace dm {

// Contracts the edge of `tet` that leaves the best worst element, if any is allowed.
bool collapse_best(EditMesh& mesh, Index tet);

}  // namespace dm
