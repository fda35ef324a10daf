// From the labelled triangulation to the mesh of the solids: compact arrays, outside tetrahedra dropped.
#pragma once

#include "base/volume_mesh.h"
#include "boundary/recovery.h"

namespace dm {

// Uses the triangulation up, so that it never stands beside the whole mesh.  Only optimisation needs the
// neighbours.
VolumeMesh extract_volume_mesh(LabelledTriangulation mesh, bool with_neighbours = true);

}  // namespace dm
