// From the labelled triangulation to the mesh of the solids: compact arrays, outside tetrahedra dropped.
#pragma once

#include "base/volume_mesh.h"
#include "boundary/recovery.h"

namespace dm {

// Uses the triangulation up, array by array, so that it never stands beside the whole mesh.
VolumeMesh extract_volume_mesh(LabelledTriangulation mesh);

}  // namespace dm
