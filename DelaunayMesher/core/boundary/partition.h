// The last resort of boundary recovery: where labelled triangles cannot be made faces of the triangulation,
// the boundary is taken from the tetrahedra instead.
//
// Idea: labelled faces divide the tetrahedra into rooms; a room whose walls say the same solid is of that
// solid. Elsewhere, and wherever a missing triangle may pass, a tetrahedron is of the solid whose surface
// winds round its middle most often, if at all (boundary/winding.h): where a solid overlaps itself the faces
// inside it vanish.  Where two solids then meet without a label, the face between them becomes a boundary
// triangle of the CAD face that has these two solids and most corners there. Precondition: all triangles of
// the complex that are faces of the triangulation are marked; the others are in `missing`.  Postcondition
// (check_boundary): as for recover_boundary; every boundary node still lies on its CAD face, but the boundary
// between the nodes is replaced locally; a segment that is no edge of it any more is dropped, and a point
// without a triangle is one of the interior. Cost: O(n log n).  Limits: a feature thinner than the triangles'
// own sagitta can vanish.
#pragma once

#include "boundary/recovery.h"

namespace dm {

struct Replaced {
  Index triangles = 0;        // boundary triangles
  std::vector<Index> points;  // corners of these and of those that were missing, ascending
};

// Throws Failure("boundary", "leak") when no CAD face has the two solids that meet.
Replaced partition_solids(LabelledTriangulation& mesh, const std::vector<Index>& missing, Context& context);

}  // namespace dm
