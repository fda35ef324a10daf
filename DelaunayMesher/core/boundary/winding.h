// How often the surface of a solid winds round a place: 1 inside, 0 outside, 2 where the solid overlaps
// itself.
//
// Idea: the sum of the triangles' solid angles, over that of the sphere (Jacobson et al. 2013).  It needs no
// triangulation that contains the triangles, and no triangles that keep clear of each other.  Far groups of
// triangles count as one dipole (Barill et al. 2018).
// Precondition: the triangles are closed and oriented, if only together.
// Cost: O(n log n) to build, O(log n) for a place.  Limits: within rounding of a triangle either side is
// taken; dipoles make an error of about 0.01.
#pragma once

#include <vector>

#include "base/box_tree.h"
#include "base/vec3.h"

namespace dm {

class WindingNumber {
 public:
  // The right-hand normals of the triangles point out of the solid.
  WindingNumber(const std::vector<Vec3>& points, std::vector<Triangle> triangles);
  double at(const Vec3& place) const;

 private:
  struct Dipole {
    Vec3 moment;  // sum of the area vectors
    Vec3 centre;
    double radius = 0;  // of the ball round the centre that holds the triangles
  };
  void add_up(Index node);

  const std::vector<Vec3>& points_;
  std::vector<Triangle> triangles_;
  BoxTree tree_;
  std::vector<Dipole> dipoles_;  // of the nodes of the tree
};

}  // namespace dm
