// Plane, cylinder, cone, sphere and torus: projection, normal and curvature in closed form.
//
// In the half-plane through p and the axis each of them is a line or a circle.  Precondition: a valid record
// (check_record in geometry.cpp).  `towards` is a point near the face: it settles where a point on the axis
// or at the centre goes, which is equally far from everything.
#pragma once

#include "plc/geometry.h"
#include "plc/surface.h"

namespace dm {

class AnalyticSurface final : public Surface {
 public:
  AnalyticSurface(const SurfaceRecord& record, const Vec3& towards);
  // Leaves only those sheets (cone: nappes, spindle torus: 0 outer, 1 inner) that the face's points lie on.
  void restrict_sheets(const std::vector<Vec3>& points_of_face);

  Vec3 project(const Vec3& p) const override;
  Vec3 normal(const Vec3& p) const override;
  double curvature(const Vec3& p) const override;
  int sheet(const Vec3& p) const override;

 private:
  // p in the half-plane through the axis: origin + z axis + r radial, r >= 0.
  struct Meridian {
    double z, r;
    Vec3 radial;
  };
  Meridian meridian(const Vec3& p) const;
  Vec3 at(double z, double r, const Vec3& radial) const;
  Vec3 sphere_direction(const Vec3& p) const;
  void choose_nappe(const std::vector<Vec3>& points_of_face);
  int cone_nappe(const Meridian& m) const;
  double cone_length(const Meridian& m) const;  // distance of the projection from the apex
  int torus_sheet(const Meridian& m) const;
  Vec3 torus_normal(const Meridian& m) const;

  SurfaceRecord record_;
  Vec3 towards_, perpendicular_;
  double cosine_ = 1, sine_ = 0;  // of a cone's half angle
  bool used_[2] = {true, true};   // sheets
};

}  // namespace dm
