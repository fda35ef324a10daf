// A tetrahedron with two labelled faces of one CAD face belongs to the side where its circumcentre lies
// (rules R2 and R3): flipping the common edge hands it over; either diagonal represents the CAD equally well.
#pragma once

#include "boundary/recovery.h"

namespace dm {

// Gives tet (inside a solid) to the other side of its two labelled faces when its circumcentre lies beyond
// them, when it is flat to rounding, or when `sliver` says that it is below target.  Returns whether it did.
bool peel(LabelledTriangulation& mesh, Index tet, const Vec3& circumcentre, bool sliver);

// The reverse: takes a tetrahedron of another region into region `tag` when its circumcentre lies there.
bool flip_in(LabelledTriangulation& mesh, Index tet, std::uint16_t tag);

}  // namespace dm
