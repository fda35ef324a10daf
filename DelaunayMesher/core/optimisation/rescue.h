// The last resort for an element: a change that need not help at once, then smoothing and flips round it, and
// all of it is taken back unless the angles of everything it touched are better in the end.
//
// Changes: a point is inserted inside, on a boundary edge or on a boundary triangle (insertion.h), or a short
// edge is contracted (collapse.h).  Klingner and Shewchuk (2007): most insertions pay only after the
// neighbourhood has settled.
// Guard: the worst badness falls and keeps_angles() holds over all tetrahedra that were changed.
// Where one point is not enough, up to three more follow on the longest boundary edges of what is worst then.
// Cost: 1 to 2.5 ms for an element; their number is bounded.  Known limit: a strip of the boundary ten times
// narrower than its elements stays.
#pragma once

#include "optimisation/collapse.h"
#include "optimisation/flips.h"
#include "optimisation/insertion.h"

namespace dm {

class Rescuer {
 public:
  Rescuer(EditMesh& mesh, Smoother& smoother, Flipper& flipper, Contractor& contractor,
          const Geometry& geometry);

  // False without a try for an element that could not be helped before or whose sharp angle is that of the
  // CAD.
  bool rescue(Index tet);

 private:
  bool is_fixed(Index tet);
  bool insert(Index tet, bool deep);
  bool contract(Index tet);
  void settle(Index v);
  bool is_better() const;
  void follow_up();
  bool finish();

  EditMesh& mesh_;
  Smoother& smoother_;
  Flipper& flipper_;
  Contractor& contractor_;
  Inserter inserter_;
  const Geometry& geometry_;
  Index tries_left_;
  std::vector<double> failed_;  // per tetrahedron, its badness when nothing helped
  std::vector<Index> tets_, points_;
};

}  // namespace dm
