// CAD edges and faces far smaller than the elements are absorbed before anything is sized by them.
//
// Idea: a step of a thousandth of the element size (a print, a modelling error), a fillet with such a radius,
// an edge left over by a Boolean operation can only be meshed with tiny or with flat elements all along.  The
// points of a tiny edge become one; those that face each other across a narrow face, or a narrow part of one,
// do, and with them the two curves along it: the face ends there, or is gone.  Faces beside it then end up to
// the tolerance off their surface, up to 2.5 tolerances where several such features lie side by side.
//
// Nothing is absorbed where that would do harm: where a triangle would turn over, coincide with or cross
// another, or two faces come to meet at an acute angle (the rim of a thin plate, the floor of a slit), nor a
// face or edge that a load refers to.  What is rejected at one place is kept whole; so is what else has a
// part in it, unless it is far narrower.
//
// Precondition: check_plc.  Postcondition: check_plc; points keep their numbers, new ones follow; CAD
// elements that are gone are reported and have no triangles, segments or corners any more.
// Cost: linear where nothing is small, else a few sorts of the triangles round what is.
// Known limit: nothing is done about a narrow slit or wall, whose sides are different faces.
#pragma once

#include <vector>

#include "base/context.h"
#include "sizing/size_field.h"
#include "surfaces/small_features.h"

namespace dm {

struct Absorbed {
  std::vector<Index> faces, edges, vertices;  // CAD elements that are gone, ascending
  bool any() const { return !faces.empty() || !edges.empty() || !vertices.empty(); }
};

// The tolerance is a fiftieth of the size given at the place, or min_size if that is given and smaller.
Plc absorb_small_features(const Plc& plc, const Geometry& geometry, SizeOptions sizes, Context& context,
                          Absorbed& absorbed);

}  // namespace dm
