// Tetrahedra that the input itself makes flat: between two CAD faces that meet at an acute edge, or the two
// sides of a thin wall, where the solid is thinner than its elements are long.
//
// No site and no split of the boundary betters their angles: there is no room inside, and more points on the
// faces make more of such elements.  Refinement leaves them alone unless they are too long.
#pragma once

#include "boundary/recovery.h"

namespace dm {

class ThinGaps {
 public:
  // After mark_acute_segments.
  ThinGaps(const LabelledTriangulation& mesh, const Geometry& geometry);

  // Does the tetrahedron reach from one face of an acute edge or wall to the other where they are closer
  // together than about half of `edge` (a quarter for walls), without an edge much longer than that?  Cost: a
  // look at its corners' faces, and at most four projections where they suit.
  bool holds(Index tet, double edge) const;

 private:
  bool in_wall(const Tet& v, double gap) const;
  bool opposed(Index a, Index b, std::array<Index, 2>& faces) const;
  bool spans(const Tet& v, const std::array<Index, 2>& faces, double gap) const;
  bool on_face(Index v, Index face) const;

  const LabelledTriangulation& mesh_;
  const Geometry& geometry_;
  std::vector<std::array<Index, 2>> pairs_;  // CAD faces that meet at an acute edge, both ways, sorted
};

}  // namespace dm
