// The last resort of boundary recovery: where labelled triangles cannot be made faces of the triangulation,
// the boundary is taken from the tetrahedra instead.
//
// Idea: every tetrahedron on a labelled face knows its solid; all others take the solid of the nearest such
// tetrahedron (breadth-first, never through a labelled face).  Where two solids then meet without a label,
// the face between them becomes a boundary triangle of the CAD face that has these two solids and most
// corners there. Precondition: all triangles of the complex that are faces of the triangulation are marked;
// the others are in `missing`.  Postcondition (check_boundary): as for recover_boundary; every boundary node
// still lies on its CAD face, but the boundary between the nodes is replaced locally, and a segment that is
// no edge of it any more is dropped. Cost: linear.  Limits: thin features that are missing entirely vanish.
#pragma once

#include "boundary/recovery.h"

namespace dm {

// Returns the number of boundary triangles that were replaced.  Throws Failure("boundary", "leak") when no
// CAD face has the two solids that meet.
Index partition_solids(LabelledTriangulation& mesh, const std::vector<Index>& missing);

}  // namespace dm
