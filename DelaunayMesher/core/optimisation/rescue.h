// The last resort for an element: a change that need not help at once, then smoothing and flips round it, and
// all of it is taken back unless the angles of everything it touched are better in the end.
//
// Changes: a point is inserted inside, on a boundary edge or on a boundary triangle (insertion.h), a short
// edge is contracted (collapse.h), or corners are shifted to where no step of smoothing leads.  Klingner and
// Shewchuk (2007): most insertions pay only after the neighbourhood has settled.
// Guard, over all tetrahedra that were changed: keeps_angles() holds, and the worst badness falls; or it
// stays, as beside an angle that the CAD gives, and what they are short of 30 degrees becomes less.
// Where one point is not enough, up to three more follow on the longest boundary edges of what is worst then.
// Order: four efforts, what helps most elements for its time first, each with a number of tries, which grows
// by those that help. A trial is given up when it does not come nearer fast enough; one that failed is not
// made again, for whatever element, before something beside its points has changed. Precondition:
// EditMesh::start_clock().  Cost: 10 to 200 us for a trial, 0.3 to 3 ms for each that succeeds. Known limit:
// a strip of the boundary ten times narrower than its elements stays.
#pragma once

#include "optimisation/collapse.h"
#include "optimisation/flips.h"
#include "optimisation/insertion.h"

namespace dm {

class Rescuer {
 public:
  Rescuer(EditMesh& mesh, Smoother& smoother, Flipper& flipper, Contractor& contractor,
          const Geometry& geometry);

  // False without a try for an element whose sharp angle is that of the CAD.
  // Effort 0 tries what helps most for its time, kMostEffort everything.
  static constexpr int kMostEffort = 3;
  bool rescue(Index tet, int effort);
  std::int64_t tries() const { return tries_; }

 private:
  // What is changed: kind of change and the points it is made of (the element for one inside).
  using Site = std::array<Index, 4>;
  enum Kind { kInsertion, kDeepInsertion, kContraction, kDeepContraction, kShift };

  bool is_fixed(Index tet);
  template <class Change>
  bool attempt(const Site& site, Index last_change, bool deep, Change change);
  bool insert(Index tet, int place, bool deep);
  bool insert(Index tet, int first, int last, bool deep);
  bool contract(Index tet, int first, int last, bool deep);
  bool shift(Index tet);
  void settle(Index v);
  bool is_better() const;
  void follow_up();

  EditMesh& mesh_;
  Smoother& smoother_;
  Flipper& flipper_;
  Contractor& contractor_;
  Inserter inserter_;
  const Geometry& geometry_;
  std::int64_t tries_ = 0;
  std::array<Index, kMostEffort + 1> tries_left_;
  int effort_ = 0;
  std::unordered_map<Site, Index, IndexHash> failed_;  // when, by the clock of the mesh
  std::vector<Index> tets_, points_;
};

}  // namespace dm
