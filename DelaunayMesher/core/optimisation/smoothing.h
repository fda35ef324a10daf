// Vertex smoothing: one point moves, its tetrahedra stay.
//
// The objective of a star is the sum of badness^p of its tetrahedra: p = 2 raises the average angle, p = 16
// nearly only the worst one (a smooth form of the active set of Freitag, Ollivier-Gooch 1997).  A step goes
// along the negative gradient, taken by differences since an evaluation is cheap (fan.h), with a line search
// that doubles or halves.  With p = 2 an interior point first tries the mean of its neighbours.
// Boundary points are put back on their CAD face or edge.
// Guard, but of shift(): the objective falls, keeps_angles() (quality.h) holds, boundary triangles keep their
// side. Cost: about 1 us per vertex and step.
#pragma once

#include "optimisation/edit_mesh.h"
#include "optimisation/fan.h"
#include "plc/geometry.h"

namespace dm {

class Smoother {
 public:
  Smoother(EditMesh& mesh, const Geometry& geometry) : mesh_(mesh), geometry_(geometry) {}

  // Both return whether v moved; CAD vertices never do.
  bool smooth_soft(Index v, int steps) { return smooth(v, true, steps); }    // p = 2
  bool smooth_worst(Index v, int steps) { return smooth(v, false, steps); }  // p = 16

  // Puts v elsewhere, about a third of its size in the direction of one of a cube's eight corners, whatever
  // that does to the angles; less far where a tetrahedron or a boundary triangle would turn over.
  bool shift(Index v, int cube_corner);

  // Where the worst tetrahedra from the fan to a new point are best, after some steps from `start`.
  Vec3 best_apex(const Fan& fan, const Vec3& start, Entity entity, int steps);

 private:
  bool smooth(Index v, bool soft, int steps);
  bool load(Index v, bool soft);
  void begin(bool soft);
  bool attempt(Index v, const Vec3& p);
  bool centre(Index v);
  bool descend(Index v);
  static constexpr Index kNew = -1;  // a point that is not in the mesh yet
  Vec3 gradient() const;
  bool keeps_boundary(Index v, const Vec3& p) const;

  EditMesh& mesh_;
  const Geometry& geometry_;
  Fan fan_;
  std::array<Index, Fan::kCapacity> tets_{};
  double size_ = 0;    // root mean square distance from the vertex to its neighbours
  double stride_ = 0;  // first trial length, relative to size_
  Entity entity_;      // what it lies on
  bool soft_ = true;
  Vec3 place_;
  FanScore now_;
  std::array<float, Fan::kCapacity> bad_{}, trial_bad_{};
};

}  // namespace dm
