// Tetrahedra on the outer boundary that are flat (is_flat()) are left out of the mesh: their volume is
// nothing, and no solver takes them.
//
// They are left where the input forces them: tangential contacts, faces closer than rounding.  Precondition
// and postcondition: check_boundary.  Cost: one pass, and another only when something was carved.
#pragma once

#include "boundary/recovery.h"

namespace dm {

// Returns the number of tetrahedra left out.  Segments that are no edge of the mesh any more are dropped.
Index carve_flat_tets(LabelledTriangulation& mesh);

}  // namespace dm
