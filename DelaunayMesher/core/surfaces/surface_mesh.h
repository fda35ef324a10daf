// The triangulated boundary: what the surfaces stage returns and the boundary stage recovers.
//
// Invariants (check_surface_mesh): closed and consistently oriented as the PLC was; every segment is an edge
// of at least two triangles or of a non-manifold junction; an edge between different faces is a segment;
// every point lies on its entity; no triangle repeats.
#pragma once

#include <vector>

#include "base/failure.h"
#include "base/vec3.h"
#include "plc/geometry.h"
#include "plc/plc.h"

namespace dm {

struct SurfaceMesh {
  std::vector<Vec3> points;
  std::vector<Entity> point_entity;  // CAD vertex, edge or face of each point
  std::vector<Triangle> triangles;   // oriented as the PLC's
  std::vector<Index> triangle_face;
  std::vector<Segment> segments;
  std::vector<Index> segment_edge;
};

void check_surface_mesh(const SurfaceMesh& mesh, const Plc& plc, const Geometry& geometry);

}  // namespace dm
