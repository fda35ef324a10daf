// The piecewise linear complex: what the core takes (docs/plc.md).
//
// Precondition of every later stage: the triangles are closed and consistently oriented round each solid,
// every segment is an edge of some triangle, points are distinct.  check_plc() proves it.
#pragma once

#include <cstdint>
#include <vector>

#include "base/context.h"
#include "base/vec3.h"

namespace dm {

// Solids are numbered in the 16 bits of a tetrahedron's tag; the largest number stands for unknown.
constexpr Index kMostSolids = 0xfffe;
constexpr std::uint16_t kUnknownSolid = kMostSolids + 1;

struct Plc {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<Index> triangle_face;  // CAD face of each triangle
  std::vector<Segment> segments;     // triangle edges that lie on a CAD edge which is a feature (no seams)
  std::vector<Index> segment_edge;   // CAD edge of each segment
  std::vector<Index> corners;        // points that are CAD vertices
  std::vector<Index> corner_vertex;  // CAD vertex of each
  // Per CAD face the solids {behind, in front of} its triangles' right-hand normal; 0 = outside, 1-based.
  std::vector<std::array<Index, 2>> face_solids;
  Index edge_count = 0, vertex_count = 0, solid_count = 0;
  // CAD faces and edges that loads or groups refer to: never absorbed, however small (surfaces/absorb.h).
  std::vector<Index> kept_faces, kept_edges;
};

// Throws Failure("plc", code, ...) naming face and place at the first defect.  Codes: bad_arrays, empty,
// too_many_solids, bad_index, collapsed_triangle, not_a_number, repeated_point, not_a_solid, free_face,
// coincident_faces, loose_segment, loose_corner, open, orientation, empty_solid, no_volume, inside_out.
// Legal: faces shared by two solids, edges with any number of faces, sheets inside a solid (both sides the
// same solid), points that nothing uses, zero-area triangles.  Not looked for: self-intersection, which is
// for the finished boundary to show.  O(n log n).
void check_plc(const Plc& plc, Context& context);

}  // namespace dm
