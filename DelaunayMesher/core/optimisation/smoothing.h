// Vertex smoothing: one point moves, its tetrahedra stay.
//
// The objective of a star is the sum of badness^p of its tetrahedra: p small raises the average angle, p
// large approaches the worst one (Freitag, Ollivier-Gooch 1997, with a smooth maximum in the place of their
// active set).  A step goes along the negative gradient, taken by differences since an evaluation is cheap
// (fan.h), with a line search that halves and doubles.  Boundary points move in the tangent plane and are put
// back on their CAD face or edge. Guard: a move is accepted when the objective falls and the worst badness of
// the star does not rise, neither end of the angle range getting worse outside 32..136 degrees; boundary
// triangles keep their side. Cost: about 1 us per vertex and step.
#pragma once

#include "optimisation/edit_mesh.h"
#include "optimisation/fan.h"
#include "plc/geometry.h"

namespace dm {

class Smoother {
 public:
  Smoother(EditMesh& mesh, const Geometry& geometry) : mesh_(mesh), geometry_(geometry) {}

  // Moves v for the exponent 2^log_power; returns whether it moved.  CAD vertices never move.
  bool smooth(Index v, int log_power, int steps);

 private:
  struct Score {
    double sum = 0, worst = 0;
  };
  bool load(Index v);
  Score score(const Vec3& p, double* bad) const;
  Vec3 gradient(const Vec3& p, double base) const;
  bool step(Index v);
  bool is_allowed(Index v, const Vec3& p) const;
  bool keeps_boundary(Index v, const Vec3& p) const;

  EditMesh& mesh_;
  const Geometry& geometry_;
  Fan fan_;
  std::array<Index, Fan::kCapacity> tets_{};
  double size_ = 0;    // mean distance from the vertex to its neighbours
  double stride_ = 0;  // first trial length, relative to size_
  int log_power_ = 2;
  Vec3 place_;
  Score now_;
};

}  // namespace dm
