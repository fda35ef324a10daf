// Nearest point of a B-spline curve: nearest chord of an adaptive polyline, then Newton on the curve.
//
// The polyline bends and changes pace little between its points, so the nearest chord lies on the right
// branch and Newton starts close: 3 steps.  Postcondition: the result is a point of the curve within its
// range to rounding; closed curves wrap.  Cost about 0.3 microseconds for a cubic.
#pragma once

#include <optional>

#include "plc/bspline.h"
#include "plc/nearest_tree.h"
#include "plc/surface.h"

namespace dm {

class SplineCurve final : public Curve {
 public:
  explicit SplineCurve(const SplineCurveRecord& record);
  Vec3 project(const Vec3& p) const override;
  double curvature(const Vec3& p) const override;

 private:
  struct Foot {
    double t;
    Vec3 point;  // relative to the curve's origin
  };
  Foot foot(const Vec3& local) const;
  Foot newton(const Vec3& local, double t, double small_step) const;
  double moved(double t, double step) const;  // kept in the range, or wrapped

  BSplineCurve curve_;
  bool closed_;
  std::vector<double> samples_;
  std::optional<NearestTree<SegmentItem>> chords_;
};

}  // namespace dm
