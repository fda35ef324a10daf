// The CAD edges of a surface mesh as paths of points, from one end to the other.
#pragma once

#include <array>
#include <vector>

#include "surfaces/surface_mesh.h"

namespace dm {

// Ends are points that one segment of the edge has, CAD vertices or not (absorbed faces).  Closed edges have
// none, and no path; of an edge in several pieces only the first one has a path.
// Cost to make: O(n log n) for n segments.
class EdgePaths {
 public:
  explicit EdgePaths(const SurfaceMesh& mesh);

  const std::vector<std::vector<Index>>& ends() const { return ends_; }  // by edge

  // Two edges meet at their common end `meeting` and are `width` apart at the point p of the first one.  Do
  // they run beside each other, as the sides of a strip?  Those of a wedge come closer on the way to where
  // they meet: half-way they are half of the width apart, less when they meet tangentially. Cost: O(log n)
  // for edges of about the same length.
  bool run_in_parallel(Index edge, Index p, Index other, Index meeting, double width) const;

 private:
  struct Path {
    std::vector<Index> points;
    std::vector<double> arc;  // from the first point
  };
  using Use = std::array<Index, 3>;  // edge, point, the other point of the segment

  void walk(const std::vector<Use>& uses, Index edge);
  Vec3 point_at(const Path& path, double arc) const;
  double distance_to(const Path& path, double arc, const Vec3& p) const;

  const SurfaceMesh& mesh_;
  std::vector<std::vector<Index>> ends_;
  std::vector<Path> paths_;      // by edge
  std::vector<Index> position_;  // of a point in the path of its edge
};

}  // namespace dm
