#include "sizing/size_field.h"

#include "sizing/exact_field.h"
#include "sizing/octree.h"
#include "sizing/sources.h"

namespace dm {

namespace {

// Volume of an element of a mesh whose mean edge is h, over h^3: between the regular tetrahedron's 0.118 and
// what random sites give.
constexpr double kElementVolume = 0.106;

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
  std::unique_ptr<Octree> octree;
};

SizeField::SizeField(const Plc& plc, const Geometry& geometry, const SizeOptions& options, Context& context)
    : impl_(std::make_unique<Impl>()) {
  check_options(options);
  if (plc.triangles.empty()) throw Failure("sizing", "empty", "There is nothing to mesh.");
  const SizeLimits limits = size_limits(options);
  const BoundaryTree boundary(plc);
  std::vector<SizeSource> sources;
  add_given_sizes(plc, options, sources);
  add_curvature(plc, geometry, options, limits, context, sources);
  ExactField field;
  field.max_size = options.max_size;
  field.floor = limits.floor;
  field.growth = options.growth;
  field.regions = options.regions;
  field.solid_size = used_solid_sizes(options);
  field.boundary = &boundary;
  field.sources = SourceTree(std::move(sources), options.growth);

  impl_->growth = options.growth;
  impl_->smallest = impl_->largest = options.max_size;
  double inverse_volume = domain_volume(plc) / (options.max_size * options.max_size * options.max_size);
  if (!field.constant()) {
    impl_->octree = std::make_unique<Octree>(field, boundary, context);
    impl_->smallest = impl_->octree->smallest();
    impl_->largest = impl_->octree->largest();
    impl_->constant = false;
    inverse_volume = impl_->octree->inverse_volume();
  }
  impl_->predicted = inverse_volume / kElementVolume;
}

SizeField::~SizeField() = default;

double SizeField::at(const Vec3& p) const { return impl_->constant ? impl_->largest : impl_->octree->at(p); }
double SizeField::smallest() const { return impl_->smallest; }
double SizeField::largest() const { return impl_->largest; }
double SizeField::growth() const { return impl_->growth; }
double SizeField::predicted_tetrahedra() const { return impl_->predicted; }

}  // namespace dm
