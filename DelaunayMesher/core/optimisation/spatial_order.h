// Renumbers a mesh so that what is close in space is close in memory.
//
// Points follow a Hilbert curve, tetrahedra their smallest point.  A refined mesh comes in the
// order of its insertions; sorted, everything that walks from element to element runs about twice as fast,
// and solvers get a smaller bandwidth.  Cost: about 0.1 us per tetrahedron.
#pragma once

#include "base/volume_mesh.h"

namespace dm {

void sort_in_space(VolumeMesh& mesh);

}  // namespace dm
