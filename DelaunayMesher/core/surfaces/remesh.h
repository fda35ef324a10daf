// The curves and surfaces stages: the CAD tessellation becomes a boundary triangulation of the wanted size.
#pragma once

#include "base/context.h"
#include "sizing/size_field.h"
#include "surfaces/surface_mesh.h"

namespace dm {

// Edge length aimed at on the boundary is `edge_ratio` * h; see research.md section 2.7 for 0.8.
struct SurfaceOptions {
  double edge_ratio = 0.8;
  double jitter = 0.1;  // random displacement of points, relative to the edge length: exact patterns make slivers
};

// Throws Failure("surfaces", ...) naming the face when it cannot represent it.
SurfaceMesh mesh_surfaces(const Plc& plc, const Geometry& geometry, const SizeField& size,
                          const SurfaceOptions& options, Context& context);

}  // namespace dm
