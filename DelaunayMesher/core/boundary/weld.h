// Points of a replaced boundary that nearly coincide become one.
//
// Idea: where sheets of the boundary touch or run closer together than can be recovered, the boundary that
// the tetrahedra give passes from points of one sheet to those of the other, with triangles as flat as the
// sheets are close.  With points that are far closer to each other than their triangles are large made one,
// the sheets are one there: triangles with the same corners cancel, or the one with the solids of both stays.
// Precondition: check_boundary.  Postcondition: a boundary for a new triangulation; its points lie on their
// CAD elements, triangles may reach to points off their face by what was welded.  CAD vertices stay.
// Cost: O(n log n).  Limits: welded triangles may cross others, and are replaced again then.
#pragma once

#include <vector>

#include "boundary/labelled_triangulation.h"
#include "plc/plc.h"

namespace dm {

// points: where welding may take place, ascending.  False when there is nothing to weld.
bool weld_points(const LabelledTriangulation& mesh, const Plc& plc, const std::vector<Index>& points,
                 SurfaceMesh& welded);

}  // namespace dm
