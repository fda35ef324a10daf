// The boundary recovery stage: every labelled triangle becomes a face of the Delaunay triangulation.
//
// Idea: put all boundary points in the triangulation; where a labelled triangle is missing because the other
// diagonal is Delaunay, flip it on the surface; where a foreign vertex intrudes, split the segment or the
// triangle on the exact CAD geometry (Chew 1993; Shewchuk 1998 for segments before facets).  Labels are
// carried, never guessed. Precondition: check_surface_mesh holds; triangles do not cross each other.
// Postcondition (check_boundary): every labelled triangle is a face of the triangulation and marked on both
// sides, every tetrahedron's tag is its solid (0 = outside), and tags change exactly at marked faces.
// Cost: one pass over the tetrahedra, then work proportional to what is missing.
// Limits: splitting stops at a floor relative to the size; what is then missing is taken from the tetrahedra
// (boundary/partition.h) and reported.  Where faces cross or touch splitting cannot help and is taken back.
#pragma once

#include "base/context.h"
#include "boundary/labelled_triangulation.h"
#include "sizing/size_field.h"

namespace dm {

struct RecoveryReport {
  Index missing_at_start = 0, flips = 0, segment_splits = 0, triangle_splits = 0;
  Index layer_points = 0;                // moved or made where sheets of the boundary are close to each other
  Index replaced = 0;                    // boundary triangles taken from the tetrahedra: the last resort
  std::vector<Index> unrecovered_faces;  // CAD faces of the triangles that made this necessary, ascending
};

// Throws Failure("boundary", "repeated_point" | "leak", ...).
LabelledTriangulation recover_boundary(SurfaceMesh surface, const Plc& plc, const Geometry& geometry,
                                       const SizeField& size, Context& context, RecoveryReport& report);

}  // namespace dm
