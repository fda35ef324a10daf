#include "sizing/size_field.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <unordered_set>

#include "base/random.h"
#include "plc/entity_names.h"
#include "sizing/field_sources.h"
#include "sizing/octree.h"
#include "sizing/proximity.h"
#include "sizing/sources.h"

namespace dm {

namespace {

// Elements per volume / h^3 and per boundary area / h^2, and, per area / h^2 of each side, what a wall
// thinner than kThickWall * h has in addition for each h that it is thinner; fitted to finished meshes.
constexpr double kPerVolume = 9.5, kPerArea = 1.2;
constexpr double kPerWallArea = 5.5, kThickWall = 0.98, kMostPerWallArea = 3.9;

constexpr double kGrown = 1.05;  // a size over the floor beside it, a little inside of a wall

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

template <class Field>
double inverse_boundary_area(const Field& h, const Plc& plc, int levels) {
  double sum = 0;
  for (const auto& [a, b, c] : plc.triangles)
    sum += inverse_area(h, plc.points[a], plc.points[b], plc.points[c], levels);
  return sum;
}

// "650000", in two digits.
std::string about(double count) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(count, 1.0))) - 1));
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", std::round(count / unit) * unit);
  return text;
}

std::string limited_walls(const ProximityResult& found) {
  char sizes[100];
  std::snprintf(sizes, sizeof sizes, "need elements of %.3g mm; they get %.3g mm", found.wanted, found.given);
  return "Walls, gaps or necks at " + entity_names(found.limited) + " are so thin that they " + sizes +
         ", and angles may be below the target there. A minimum size (--min-size) between the two lifts this "
         "limit: the smaller makes about " +
         about(found.elements_wanted) + " elements there, the larger about " + about(found.elements_given) +
         ".";
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

// Of the triangles of a fine tessellation that have about the same size, one per cube of a third of it.
std::vector<SizeSource> clustered(const std::vector<SizeSource>& sources) {
  constexpr double kCube = 0.35, kSizes = 8;  // cube over size; sizes per octave that count as equal
  std::vector<SizeSource> kept;
  std::unordered_set<std::uint64_t> seen;
  for (const SizeSource& s : sources) {
    const double octave = std::floor(kSizes * std::log2(s.size));
    const double cube = kCube * std::exp2(octave / kSizes);
    if (norm2(s.b - s.a) < cube * cube && norm2(s.c - s.a) < cube * cube) {
      const Vec3 q = (1 / (3 * cube)) * (s.a + s.b + s.c);
      Random random(static_cast<std::int64_t>(octave), s.empty_side,
                    static_cast<std::int64_t>(std::floor(q.x)), static_cast<std::int64_t>(std::floor(q.y)),
                    static_cast<std::int64_t>(std::floor(q.z)));
      if (!seen.insert(random.next()).second) continue;
    }
    kept.push_back(s);
  }
  return kept;
}

}  // namespace

struct SizeField::Impl {
  double smallest = 0, largest = 0, growth = 0, predicted = 0;
  std::array<double, 3> floors{};  // of curvature, walls and gaps, facets across gaps
  bool constant = true;
  std::vector<std::string> warnings;
  std::unique_ptr<Octree> octree;
};

SizeField::SizeField(const Plc& plc, const Geometry& geometry, const SizeOptions& options, Context& context)
    : impl_(std::make_unique<Impl>()) {
  check_options(options);
  if (plc.triangles.empty()) throw Failure("sizing", "empty", "There is nothing to mesh.");
  const SizeLimits limits = size_limits(options);
  std::vector<SizeSource> sources;
  std::vector<double> triangle_size(plc.triangles.size(), options.max_size);
  add_given_sizes(plc, options, triangle_size, sources);
  add_curvature(plc, geometry, options, limits, context, triangle_size, sources);
  context.poll(0.1);
  std::optional<BoundaryTree> boundary;  // costs more than a field without walls and sources
  ProximityResult proximity;
  if (options.elements_across > 0) {
    boundary.emplace(plc);
    proximity = add_proximity(plc, geometry, *boundary, options, limits, triangle_size, context, sources);
  }
  impl_->floors = {limits.curvature, proximity.floor, proximity.crossing_floor};
  if (!proximity.limited.empty()) impl_->warnings.push_back(limited_walls(proximity));
  FieldSources field;
  field.max_size = options.max_size;
  field.floor = limits.floor;
  field.growth = options.growth;
  field.regions = options.regions;
  field.solid_size = used_solid_sizes(options);
  field.sources = clustered(sources);

  impl_->growth = options.growth;
  impl_->smallest = impl_->largest = options.max_size;
  const double volume = domain_volume(plc);
  double inverse_volume = volume / (options.max_size * options.max_size * options.max_size);
  if (!field.constant()) {
    if (!boundary) boundary.emplace(plc);
    impl_->octree = std::make_unique<Octree>(field, plc, *boundary, volume, context);
    impl_->smallest = std::max(field.smallest(), impl_->octree->smallest());
    impl_->largest = impl_->octree->largest();
    impl_->constant = false;
    inverse_volume = impl_->octree->inverse_volume();
  }
  const int levels = impl_->constant ? 0 : 8;
  const auto size = [&](const Vec3& p) {
    context.tick(0.9);
    return at(p);
  };
  impl_->predicted = kPerVolume * inverse_volume + kPerArea * inverse_boundary_area(size, plc, levels);
  for (const ThinWall& wall : proximity.walls) {
    const auto& [p, q, r] = wall.corner;
    const double layers = wall.width / at((1.0 / 3) * (p + q + r));
    const double per_area = std::clamp(kPerWallArea * (kThickWall - layers), 0.0, kMostPerWallArea);
    if (per_area > 0) impl_->predicted += wall.weight * per_area * inverse_area(size, p, q, r, levels);
  }
}

SizeField::~SizeField() = default;

double SizeField::at(const Vec3& p) const { return impl_->constant ? impl_->largest : impl_->octree->at(p); }
double SizeField::smallest() const { return impl_->smallest; }
double SizeField::largest() const { return impl_->largest; }
bool SizeField::is_floor(double size) const {
  return std::any_of(impl_->floors.begin(), impl_->floors.end(), [&](double floor) {
    return size < kGrown * floor && size > 0.999 * floor && floor < impl_->largest;
  });
}
double SizeField::growth() const { return impl_->growth; }
const std::vector<std::string>& SizeField::warnings() const { return impl_->warnings; }
double SizeField::predicted_tetrahedra() const { return impl_->predicted; }

}  // namespace dm
