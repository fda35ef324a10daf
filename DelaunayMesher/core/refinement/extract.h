// From the labelled triangulation to the mesh of the solids: compact arrays, outside tetrahedra dropped.
#pragma once

#include "base/volume_mesh.h"
#include "boundary/recovery.h"

namespace dm {

VolumeMesh extract_volume_mesh(const LabelledTriangulation& mesh);

}  // namespace dm
