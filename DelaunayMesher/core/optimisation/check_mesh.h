// Every invariant of a VolumeMesh (base/volume_mesh.h), for tests and for runs that check each stage.
#pragma once

#include "base/volume_mesh.h"
#include "plc/geometry.h"

namespace dm {

// Indices in range; positive orientation; neighbours mutual and sharing three corners; the boundary triangles
// are exactly the faces without a neighbour or between two solids (embedded ones are allowed), each once, and
// closed (every edge in an even number of them unless embedded); no isolated point.
// Throws Failure("check", code, ...) naming the first broken one.  Cost: about 1 us per tetrahedron.
void check_volume_mesh(const VolumeMesh& mesh);

// Every boundary point lies within `tolerance` mm of its CAD face or edge.
void check_on_geometry(const VolumeMesh& mesh, const Geometry& geometry, double tolerance = 1e-7);

}  // namespace dm
