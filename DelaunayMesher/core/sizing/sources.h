// Where the size field comes from: sizes given on CAD elements and points, and curvature.
#pragma once

#include "sizing/size_field.h"
#include "sizing/size_source.h"

namespace dm {

// What a size found by the mesher itself (not given by the user) may not go below, in mm.
struct SizeLimits {
  double floor = 0;      // min_size of the options; sizes that the user gives are raised to it as well
  double curvature = 0;  // finest size for curvature
  double proximity = 0;  // finest size for walls and gaps
  double crossing = 0;   // finest size that keeps the facets of curved faces from crossing a gap
};
SizeLimits size_limits(const SizeOptions& options);

// Throws Failure("sizing", ...) for sizes, growth and counts that are not positive numbers.
void check_options(const SizeOptions& options);

// Sizes of faces, edges, vertices, solids (their boundary faces) and size points.  Lowers triangle_size (one
// per triangle) by what applies to the whole triangle; so does add_curvature.
void add_given_sizes(const Plc& plc, const SizeOptions& options, std::vector<double>& triangle_size,
                     std::vector<SizeSource>& sources);

// 2 pi r / (kBoundaryEdge * elements_per_circle) on curved faces and edges, so that that many edges of the
// boundary go around a circle; r from the CAD's curvature, or from the angles between the triangles of a
// smooth face that is known by its facets only.
void add_curvature(const Plc& plc, const Geometry& geometry, const SizeOptions& options,
                   const SizeLimits& limits, Context& context, std::vector<double>& triangle_size,
                   std::vector<SizeSource>& sources);

}  // namespace dm
