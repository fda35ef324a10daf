// The curves and surfaces stages: the CAD tessellation becomes a boundary triangulation of the wanted size.
#pragma once

#include "base/context.h"
#include "sizing/size_field.h"
#include "surfaces/surface_mesh.h"

namespace dm {

// Edge length aimed at on the boundary is `edge_ratio` * h; the default serves the volume's angles best.
struct SurfaceOptions {
  double edge_ratio = kBoundaryEdge;
  // random displacement of points, relative to the edge length: exact patterns make slivers
  double jitter = 0.1;
};

// Precondition: check_plc.  Postcondition: check_surface_mesh.  Cost: some 2 microseconds of processor time
// per triangle on analytic surfaces; faces are spread over context.threads, with the same bytes for any
// number. Limits: docs/surfaces.md.
SurfaceMesh mesh_surfaces(const Plc& plc, const Geometry& geometry, const SizeField& size,
                          const SurfaceOptions& options, Context& context);

}  // namespace dm
