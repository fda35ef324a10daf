// Labelled triangles that are no faces of the triangulation are made so by flips on the surface and splits.
//
// Idea and rules: docs/boundary.md, steps 2 to 4 (Chew 1993; Ruppert 1995; Shewchuk 1998).  Splitting is of
// no use where faces cross or touch: it only makes more triangles that cross, and with them bad elements.  So
// where it fails it is taken back, and everything is done over without it thereabouts.
// Precondition: the labelled triangles that are faces are marked.  Postcondition: the same, and those that
// are not are the ones returned.  Cost: proportional to what is missing, and a copy of the triangulation; a
// few more where splitting fails.  Limit: where ten faces or more meet at one edge, splitting often fails.
#pragma once

#include <vector>

#include "boundary/recovery.h"

namespace dm {

// missing: the labelled triangles that are no faces.  Returns those that are none afterwards, maybe twice.
std::vector<Index> recover_triangles(LabelledTriangulation& mesh, const Geometry& geometry,
                                     const SizeField& size, const std::vector<Index>& missing, bool may_split,
                                     Context& context, RecoveryReport& report);

}  // namespace dm
