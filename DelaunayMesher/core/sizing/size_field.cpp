#include "sizing/size_field.h"

#include <cstdio>

#include "sizing/exact_field.h"
#include "sizing/octree.h"
#include "sizing/proximity.h"
#include "sizing/sources.h"

namespace dm {

namespace {

// Volume of an element of a mesh whose mean edge is h, over h^3: between the regular tetrahedron's 0.118 and
// what random sites give.
constexpr double kElementVolume = 0.106;
// Elements beside the boundary are smaller, for its edges are 0.8 h: elements more per h^2 of boundary.
constexpr double kBoundaryElements = 5;

double domain_volume(const Plc& plc) {
  double sixfold = 0;
  const Vec3 origin = plc.points[plc.triangles[0][0]];
  for (std::size_t t = 0; t < plc.triangles.size(); ++t) {
    const auto [behind, front] = plc.face_solids[plc.triangle_face[t]];
    const int sign = (behind > 0) - (front > 0);
    const auto [a, b, c] = plc.triangles[t];
    sixfold += sign * dot(plc.points[a] - origin, cross(plc.points[b] - origin, plc.points[c] - origin));
  }
  return std::abs(sixfold) / 6;
}

// Integral of 1 / h^2 over the boundary, by parts of triangles not much larger than h.
template <class Field>
double inverse_area(const Field& h, const Vec3& a, const Vec3& b, const Vec3& c, int levels) {
  const Vec3 middle = (1.0 / 3) * (a + b + c);
  const double size = h(middle);
  const double longest2 = std::max({norm2(b - a), norm2(c - b), norm2(a - c)});
  if (levels == 0 || longest2 <= 9 * size * size) return 0.5 * norm(area_vector(a, b, c)) / (size * size);
  const Vec3 d = 0.5 * (a + b), e = 0.5 * (b + c), f = 0.5 * (c + a);
  return inverse_area(h, a, d, f, levels - 1) + inverse_area(h, d, b, e, levels - 1) +
         inverse_area(h, f, e, c, levels - 1) + inverse_area(h, d, e, f, levels - 1);
}

std::string limited_walls(const ProximityResult& found) {
  char text[240];
  std::snprintf(
      text, sizeof text,
      "Some walls or gaps are so thin that they need elements of %.3g mm; they get %.3g mm. Angles may be "
      "below the target there. A minimum size makes the elements as small as it allows.",
      found.wanted, found.finest);
  return text;
}

std::vector<double> used_solid_sizes(const SizeOptions& options) {
  std::vector<double> sizes;
  bool used = false;
  for (const double s : options.solid_size) {
    sizes.push_back(std::clamp(s, options.min_size, options.max_size));
    used = used || s < options.max_size;
  }
  if (!used) sizes.clear();
  return sizes;
}

}  // namespace

struct SizeField::Impl {
  double smallest = 0, largest = 0, growth = 0, predicted = 0;
  bool constant = true;
  std::vector<std::string> warnings;
  std::unique_ptr<Octree> octree;
};

SizeField::SizeField(const Plc& plc, const Geometry& geometry, const SizeOptions& options, Context& context)
    : impl_(std::make_unique<Impl>()) {
  check_options(options);
  if (plc.triangles.empty()) throw Failure("sizing", "empty", "There is nothing to mesh.");
  const SizeLimits limits = size_limits(options);
  const BoundaryTree boundary(plc);
  std::vector<SizeSource> sources;
  std::vector<double> triangle_size(plc.triangles.size(), options.max_size);
  add_given_sizes(plc, options, triangle_size, sources);
  add_curvature(plc, geometry, options, limits, context, triangle_size, sources);
  const ProximityResult proximity =
      add_proximity(plc, geometry, boundary, options, limits, triangle_size, context, sources);
  if (proximity.wanted < 0.99 * proximity.finest) impl_->warnings.push_back(limited_walls(proximity));
  ExactField field;
  field.max_size = options.max_size;
  field.floor = limits.floor;
  field.growth = options.growth;
  field.regions = options.regions;
  field.solid_size = used_solid_sizes(options);
  field.boundary = &boundary;
  double smallest_source = options.max_size;
  for (const SizeSource& s : sources)
    if (s.on_boundary) smallest_source = std::min(smallest_source, s.size);
  field.sources = SourceTree(std::move(sources), options.growth);

  impl_->growth = options.growth;
  impl_->smallest = impl_->largest = options.max_size;
  double inverse_volume = domain_volume(plc) / (options.max_size * options.max_size * options.max_size);
  if (!field.constant()) {
    impl_->octree = std::make_unique<Octree>(field, boundary, context);
    impl_->smallest = std::max(field.smallest(), std::min(impl_->octree->smallest(), smallest_source));
    impl_->largest = impl_->octree->largest();
    impl_->constant = false;
    inverse_volume = impl_->octree->inverse_volume();
  }
  impl_->predicted = inverse_volume / kElementVolume + kBoundaryElements * inverse_boundary_area(plc);
}

double SizeField::inverse_boundary_area(const Plc& plc) const {
  double sum = 0;
  const int deepest = impl_->constant ? 0 : 8;
  for (const auto& [a, b, c] : plc.triangles)
    sum += inverse_area([&](const Vec3& p) { return at(p); }, plc.points[a], plc.points[b], plc.points[c],
                        deepest);
  return sum;
}

SizeField::~SizeField() = default;

double SizeField::at(const Vec3& p) const { return impl_->constant ? impl_->largest : impl_->octree->at(p); }
double SizeField::smallest() const { return impl_->smallest; }
double SizeField::largest() const { return impl_->largest; }
double SizeField::growth() const { return impl_->growth; }
const std::vector<std::string>& SizeField::warnings() const { return impl_->warnings; }
double SizeField::predicted_tetrahedra() const { return impl_->predicted; }

}  // namespace dm
