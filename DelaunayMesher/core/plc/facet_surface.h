// A face without CAD geometry: its triangles are the surface.  An edge without: its segments are the curve.
#pragma once

#include "plc/nearest_tree.h"
#include "plc/surface.h"

namespace dm {

class FacetSurface final : public Surface {
 public:
  explicit FacetSurface(std::vector<TriangleItem> triangles);
  Vec3 project(const Vec3& p) const override;
  Vec3 project(const Vec3& p, const Vec3& side) const override;
  Vec3 normal(const Vec3& p) const override;  // of the nearest triangle; zero-area ones have the face's mean
  double curvature(const Vec3&) const override { return 0; }

 private:
  NearestTree<TriangleItem> tree_;
  Vec3 mean_normal_;
};

class Polyline final : public Curve {
 public:
  explicit Polyline(std::vector<SegmentItem> segments) : tree_(std::move(segments)) {}
  Vec3 project(const Vec3& p) const override { return tree_.nearest(p).point; }
  double curvature(const Vec3&) const override { return 0; }

 private:
  NearestTree<SegmentItem> tree_;
};

// A face or edge that the PLC has nothing of: nothing can be asked of it that matters, p stays where it is.
class NoSurface final : public Surface {
 public:
  Vec3 project(const Vec3& p) const override { return p; }
  Vec3 normal(const Vec3&) const override { return {0, 0, 1}; }
  double curvature(const Vec3&) const override { return 0; }
};
class NoCurve final : public Curve {
 public:
  Vec3 project(const Vec3& p) const override { return p; }
  double curvature(const Vec3&) const override { return 0; }
};

}  // namespace dm
