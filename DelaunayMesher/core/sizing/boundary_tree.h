// The PLC's triangles in a box tree: what a ray hits first, which solid a point is in.  Used to measure walls
// and gaps, and to know which part of space will be meshed.
#pragma once

#include "base/box_tree.h"
#include "plc/plc.h"

namespace dm {

struct RayHit {
  double distance = HUGE_VAL;  // mm along the unit direction
  Index triangle = -1;
  double cosine = 0;  // between the ray and the triangle's unit normal
};

class BoundaryTree {
 public:
  explicit BoundaryTree(const Plc& plc);

  // First triangle hit at a distance in (from, to), triangle `skip` left out.
  RayHit first_hit(const Vec3& origin, const Vec3& direction, double from, double to, Index skip = -1) const;
  // Solid (1-based) that p lies in, 0 = outside: by the side of the first triangle that rays from p hit, the
  // majority of three rays at most.  Not exact for points on the boundary.
  Index solid_at(const Vec3& p) const;
  // Solid that p lies in by the side of the nearest triangle.  within: a distance known not to be exceeded by
  // it; it saves time.
  Index solid_by_nearest(const Vec3& p, double within = HUGE_VAL) const;
  const Box& box() const { return tree_.nodes()[0].box; }  // of the whole PLC

 private:
  Index solid_along(const Vec3& p, const Vec3& direction) const;
  const Plc& plc_;
  BoxTree tree_;
};

}  // namespace dm
