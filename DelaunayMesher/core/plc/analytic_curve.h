// Line and circle, between the ends that the PLC's segments of the edge have.
#pragma once

#include "plc/geometry.h"
#include "plc/surface.h"

namespace dm {

// The PLC's segments of one edge; `ends` are the points where only one of them ends.
struct EdgePath {
  std::vector<std::array<Vec3, 2>> segments;
  std::vector<Vec3> ends;
};

class LineCurve final : public Curve {
 public:
  LineCurve(const CurveRecord& record, const EdgePath& path);
  Vec3 project(const Vec3& p) const override;
  double curvature(const Vec3&) const override { return 0; }

 private:
  Vec3 origin_, axis_;
  double low_, high_;  // along the axis
};

class CircleCurve final : public Curve {
 public:
  CircleCurve(const CurveRecord& record, const EdgePath& path);
  Vec3 project(const Vec3& p) const override;
  double curvature(const Vec3&) const override { return 1 / radius_; }

 private:
  Vec3 origin_, axis_, x_, y_;  // x towards the middle of the arc
  double radius_;
  bool closed_ = true;
  double half_ = 0, cosine_ = 0;  // half the arc's angle
};

}  // namespace dm
