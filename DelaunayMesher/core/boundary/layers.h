// Thin layers: where two sheets of the boundary face each other much closer than their triangles are large
// (the sides of a thin wall or of a narrow gap), their points are made to face each other.
//
// Idea: a triangle is a face of the Delaunay triangulation if some sphere through its corners is empty.
// Between two sheets at a small distance no sphere is, unless every point of one sheet has its image on the
// other: then both are the same planar Delaunay triangulation, and prisms stand between them whatever their
// height.  So each point that lies close above the other sheet pulls the nearest free point there under
// itself, moves over it, or makes a new one; edge flips on the surface follow.
// Precondition: check_surface_mesh.  Postcondition: check_surface_mesh; points stay on their CAD entity.
// Cost: a search of close points and triangles per missing triangle.
// Limits: CAD vertices stay; in a stack of several narrow sheets the images of different sheets can get in
// each other's way, and what is then missing is left to recovery.
#pragma once

#include "base/context.h"
#include "boundary/complex.h"
#include "sizing/size_field.h"

namespace dm {

// missing: the triangles that are no faces of the Delaunay triangulation; only what faces these, or is a
// corner of them, is matched.  fixed: which points face another and stay; kept from call to call, empty at
// first. Returns the number of points that were moved or made.
Index match_layers(SurfaceMesh& mesh, const Plc& plc, const Geometry& geometry, const SizeField& size,
                   const std::vector<Index>& missing, std::vector<char>& fixed, Context& context);

}  // namespace dm
