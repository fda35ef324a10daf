// What every kind of CAD face and CAD edge can do; Geometry holds one of these per face and edge.
#pragma once

#include "base/vec3.h"

namespace dm {

class Surface {
 public:
  virtual ~Surface() = default;
  virtual Vec3 project(const Vec3& p) const = 0;
  // The same where the surface's own normal is not opposite to `side`, if it is so anywhere.
  virtual Vec3 project(const Vec3& p, const Vec3& /*side*/) const { return project(p); }
  // Unit normal at the projection of p; its side is the surface's own, constant on each sheet. Zero at an
  // apex.
  virtual Vec3 normal(const Vec3& p) const = 0;
  // Largest absolute principal curvature at the projection of p.
  virtual double curvature(const Vec3& p) const = 0;
  // 0 or 1: the nappe of a cone or the sheet of a spindle torus that p is projected on.
  virtual int sheet(const Vec3&) const { return 0; }
};

class Curve {
 public:
  virtual ~Curve() = default;
  virtual Vec3 project(const Vec3& p) const = 0;
  virtual double curvature(const Vec3& p) const = 0;
};

}  // namespace dm
