// A size field together with what it is made from.
#pragma once

#include "base/random.h"
#include "shapes.h"
#include "sizing/size_field.h"

namespace dm::test {

struct Field {
  Shape shape;
  Context context;
  Geometry geometry;
  SizeField field;
  Field(Shape s, const SizeOptions& options)
      : shape(std::move(s)),
        geometry(shape.plc, shape.records),
        field(shape.plc, geometry, options, context) {}
  double at(const Vec3& p) const { return field.at(p); }
};

// Size only by what the test asks for.
inline SizeOptions plain(double max_size) {
  SizeOptions options;
  options.max_size = max_size;
  options.growth = 0.25;
  options.elements_per_circle = options.elements_across = 0;
  return options;
}

inline SizeOptions across(double max_size, double elements = 2) {
  SizeOptions options = plain(max_size);
  options.elements_across = elements;
  return options;
}

inline Vec3 random_in(Random& random, const Vec3& a, const Vec3& b) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {a.x + x * (b.x - a.x), a.y + y * (b.y - a.y), a.z + z * (b.z - a.z)};
}

// Elements per volume / h^3 and per boundary area / h^2 (docs/sizing.md).
inline constexpr double kPerVolume = 9.5, kPerArea = 1.2;

}  // namespace dm::test
