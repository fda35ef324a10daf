// Points of a surface mesh at one and the same place, where a face is folded sharply (the nearest place of
// the other leaf) or a curve passes a corner: no triangulation can hold both. Cost: a sort of the points.
#pragma once

#include <vector>

#include "surfaces/surface_mesh.h"

namespace dm {

// Of each point the one that stands for all at its place: that on the CAD element of the lowest dimension.
std::vector<Index> first_at_place(const SurfaceMesh& mesh);

bool has_repeated_points(const SurfaceMesh& mesh);

// Makes points at the same place one: an edge without length goes with its two triangles, else the surface
// touches itself there.  Points stay if other edges would become one by it.
void join_repeated_points(SurfaceMesh& mesh);

}  // namespace dm
