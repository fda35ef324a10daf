// Cavities that respect the boundary: the last means where no site can avoid a labelled triangle.
//
// Idea: in a thin or tangential place tiny labelled triangles lie inside the spheres of tetrahedra on both of
// their sides, and would refuse every site within those spheres.  The cavity then stops at labelled faces, as
// in a constrained Delaunay triangulation (Shewchuk 2002).  It is used only when it is a ball that the site
// sees entirely, so the triangulation stays valid; it is no longer Delaunay across that boundary, which is
// reported.
// Cost: linear in the cavity; what is spent on cavities that are no balls is bounded in all.
#pragma once

#include "boundary/recovery.h"

namespace dm {

class ConstrainedSearch {
 public:
  explicit ConstrainedSearch(const Triangulation& tets) : tets_(tets) {}
  // Fills tets, border and outside of `cavity`; false when it is no ball round p.
  bool find_cavity(const Vec3& p, Index start, Cavity& cavity);

 private:
  bool search(const Vec3& p, Index start, Cavity& cavity);
  bool collect(const Vec3& p, Index start, Cavity& cavity);
  bool is_inside(Index tet) const { return stamp_[tet] == 2 * epoch_ + 1; }
  bool drop_unseen(const Vec3& p, Cavity& cavity);
  void keep_connected(Index start, Cavity& cavity);
  bool collect_border(Cavity& cavity) const;
  const Triangulation& tets_;
  std::vector<std::uint32_t> stamp_;  // per slot: 2 * epoch_ = seen, + 1 = in conflict
  std::uint32_t epoch_ = 0;
  std::size_t wasted_ = 0;  // looks at tetrahedra of cavities that were no balls
};

// Is the cavity a topological ball without inner vertices?  Always so in a Delaunay triangulation.
bool is_ball(const Triangulation& tets, const Cavity& cavity);

// Squared distance from p to the nearest corner of its cavity, which is the nearest vertex that p sees.
double nearest_corner2(const Triangulation& tets, const Cavity& cavity, const Vec3& p);

// A tetrahedron in conflict with p among the nearest neighbours of hint, or -1.
Index conflict_near(const Triangulation& tets, const Vec3& p, Index hint);

}  // namespace dm
