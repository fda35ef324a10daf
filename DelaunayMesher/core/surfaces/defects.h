// What may be wrong with a remeshed boundary: triangles that cross, strips too narrow for their triangles.
// mesh_surfaces asks for smaller lengths there and does the faces again.
#pragma once

#include <vector>

#include "curves/length_field.h"
#include "surfaces/surface_mesh.h"

namespace dm {

// A place that needs a smaller length.
struct Defect {
  Vec3 place;
  double length = 0;            // edge length that may cure it
  Index face = -1, other = -1;  // other: a face it crosses, itself first
};

// Triangles that cross another one (every one of them, with half the length wanted there), and those at
// points that lie on the same place; not all of them when there are many times more crossings than triangles.
// Cost: find_crossings.
std::vector<Defect> find_crossing_defects(const SurfaceMesh& mesh, const LengthField& lengths,
                                          Context& context);

// Triangles with an angle under 20 degrees between curves closer together than the wanted length, or opposite
// a segment of a CAD edge.  Not where the curves meet at such an angle in the tip of a wedge or needle of a
// solid (its solid angle there is small), nor below a 24th of the length that the size field wants, an eighth
// where faces meet at less than 20 degrees.
std::vector<Defect> find_narrow_places(const SurfaceMesh& mesh, const Plc& plc, const LengthField& lengths);

}  // namespace dm
