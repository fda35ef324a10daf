// Nearest point of a B-spline surface: nearest triangle of an adaptive grid, then Newton on the surface.
//
// The grid bends and changes pace little from line to line, so Newton, with second-order terms, starts close:
// 3 steps (Ma, Hewitt 2003 treat the same two phases).  Sheets of the surface that face each other (the coils
// of a spring) may be nearer to each other than the grid is to them: the nearest triangle that is turned away
// from the first is tried too, or none that is turned away from the side asked for.
// Postcondition: the result is a point of the surface within its range to rounding, even where Newton does
// not settle (degenerate edges, kinks); surfaces closed in u or v wrap.  Limit: the surface, not the trimmed
// face, is projected on.  Cost about 1 microsecond for a bicubic surface.
#pragma once

#include <optional>

#include "plc/bspline.h"
#include "plc/nearest_tree.h"
#include "plc/surface.h"

namespace dm {

class SplineSurface final : public Surface {
 public:
  explicit SplineSurface(const SplineSurfaceRecord& record);
  Vec3 project(const Vec3& p) const override;
  Vec3 project(const Vec3& p, const Vec3& side) const override;
  Vec3 normal(const Vec3& p) const override;
  double curvature(const Vec3& p) const override;

 private:
  struct Foot {
    double u, v;
    Vec3 point;  // relative to the surface's origin
    bool settled;
  };
  void choose_lines();
  void build_grid();
  Foot foot(const Vec3& local) const;
  Foot foot_from(const Vec3& local, const NearestPoint& nearest) const;
  double cell_size(Index item) const;
  Foot newton(const Vec3& local, double u, double v, double small_step) const;
  bool regular(const SurfaceJet& jet, double least) const;
  SurfaceJet inner_jet(double u, double v, double fraction) const;

  BSplineSurface surface_;
  bool closed_u_ = false, closed_v_ = false;
  std::vector<double> lines_u_, lines_v_;
  std::optional<NearestTree<TriangleItem>> grid_;  // items 2 k and 2 k + 1 halve cell k
};

}  // namespace dm
