// The tetrahedral mesh between refinement, optimisation and order, and at the end.
//
// Tetrahedra are positively oriented: dot(cross(b - a, c - a), d - a) > 0 (VTK order).  Face i is opposite
// corner i.  neighbours: across face i, 4 * tet + its face, or -1 outside all solids; empty without
// optimisation.
#pragma once

#include <vector>

#include "base/failure.h"
#include "base/vec3.h"

namespace dm {

struct VolumeMesh {
  std::vector<Vec3> points;
  std::vector<Entity> point_entity;  // lowest-dimensional CAD element each point lies on (3 = inside a solid)
  std::vector<Tet> tets;
  std::vector<std::array<Index, 4>> neighbours;
  std::vector<Index> tet_solid;     // 1-based
  std::vector<Triangle> triangles;  // boundary and interfaces, oriented as the PLC's faces
  std::vector<Index> triangle_face;
  std::vector<Segment> segments;
  std::vector<Index> segment_edge;
};

}  // namespace dm
