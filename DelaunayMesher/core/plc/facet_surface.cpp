#include "plc/facet_surface.h"

namespace dm {
namespace {

Vec3 sum_of_normals(const std::vector<TriangleItem>& triangles) {
  Vec3 sum;
  for (const TriangleItem& triangle : triangles) sum += triangle.area_normal();
  return norm2(sum) > 0 ? normalized(sum) : Vec3{0, 0, 1};
}

}  // namespace

FacetSurface::FacetSurface(std::vector<TriangleItem> triangles)
    : tree_(triangles), mean_normal_(sum_of_normals(triangles)) {}

Vec3 FacetSurface::project(const Vec3& p) const { return tree_.nearest(p).point; }

Vec3 FacetSurface::project(const Vec3& p, const Vec3& side) const {
  return nearest_facing(tree_, p, side).point;
}

Vec3 FacetSurface::normal(const Vec3& p) const {
  const TriangleItem& triangle = tree_.item(tree_.nearest(p).item);
  return triangle.flat() ? mean_normal_ : normalized(triangle.area_normal());
}

}  // namespace dm
