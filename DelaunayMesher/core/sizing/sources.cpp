#include "sizing/sources.h"

namespace dm {

namespace {

constexpr double kCurvatureFloor = 1.0 / 100;  // of max_size, unless min_size is given
constexpr double kProximityFloor = 1.0 / 50;
constexpr double kCrossingFloor = 1.0 / 1000;

double size_of(const std::vector<double>& sizes, Index i) {
  return i >= 0 && i < static_cast<Index>(sizes.size()) ? sizes[i] : HUGE_VAL;
}

void check_sizes(const std::vector<double>& sizes, const char* what, std::int8_t dimension) {
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i] > 0) continue;
    throw Failure("sizing", "bad_size",
                  std::string("The size given for a ") + what + " must be greater than zero.", {},
                  {dimension, static_cast<Index>(dimension == 3 ? i + 1 : i)});
  }
}

}  // namespace

SizeLimits size_limits(const SizeOptions& options) {
  if (options.min_size > 0) return {options.min_size, options.min_size, options.min_size, options.min_size};
  return {0, kCurvatureFloor * options.max_size, kProximityFloor * options.max_size,
          kCrossingFloor * options.max_size};
}

void check_options(const SizeOptions& options) {
  const auto fail = [](const char* code, const char* message) { throw Failure("sizing", code, message); };
  if (!(options.max_size > 0 && std::isfinite(options.max_size)))
    fail("bad_size", "The maximum element size must be a number greater than zero.");
  if (!(options.min_size >= 0)) fail("bad_size", "The minimum element size must not be negative.");
  if (options.min_size > options.max_size)
    fail("bad_size", "The minimum element size is larger than the maximum element size.");
  if (!(options.growth > 0)) fail("bad_growth", "The growth rate must be greater than zero.");
  if (!(options.elements_per_circle >= 0)) fail("bad_count", "Elements per circle must not be negative.");
  if (!(options.elements_across >= 0)) fail("bad_count", "Elements across must not be negative.");
  if (options.points.size() != options.point_size.size())
    fail("bad_points", "There must be one size for each size point.");
  check_sizes(options.face_size, "face", 2);
  check_sizes(options.edge_size, "edge", 1);
  check_sizes(options.vertex_size, "vertex", 0);
  check_sizes(options.solid_size, "solid", 3);
  for (std::size_t i = 0; i < options.points.size(); ++i) {
    const Vec3& p = options.points[i];
    if (!(options.point_size[i] > 0) || !std::isfinite(p.x + p.y + p.z))
      throw Failure("sizing", "bad_size",
                    "A size point needs finite coordinates and a size greater than zero.", p);
  }
  for (const SizeRegion& r : options.regions)
    if (!(r.size > 0) || !(r.transition >= 0) || !(r.radius >= 0) || !std::isfinite(norm(r.a) + norm(r.b)))
      throw Failure("sizing", "bad_region",
                    "A size region needs finite coordinates, a size greater than zero, and a radius and "
                    "transition that are not negative.",
                    r.a);
}

void add_given_sizes(const Plc& plc, const SizeOptions& options, std::vector<double>& triangle_size,
                     std::vector<SizeSource>& sources) {
  const auto add = [&](SizeSource source) {
    if (!(source.size < options.max_size)) return;
    source.size = std::max(source.size, options.min_size);
    sources.push_back(source);
  };
  for (std::size_t t = 0; t < plc.triangles.size(); ++t) {
    const Index face = plc.triangle_face[t];
    double size = size_of(options.face_size, face);
    for (const Index solid : plc.face_solids[face])
      size = std::min(size, size_of(options.solid_size, solid - 1));
    const auto [a, b, c] = plc.triangles[t];
    triangle_size[t] = std::min(triangle_size[t], std::max(size, options.min_size));
    add(SizeSource::triangle({plc.points[a], plc.points[b], plc.points[c]}, size, empty_side(plc, face)));
  }
  for (std::size_t s = 0; s < plc.segments.size(); ++s) {
    const auto [a, b] = plc.segments[s];
    add(SizeSource::segment(plc.points[a], plc.points[b], size_of(options.edge_size, plc.segment_edge[s])));
  }
  for (std::size_t c = 0; c < plc.corners.size(); ++c)
    add(SizeSource::point(plc.points[plc.corners[c]], size_of(options.vertex_size, plc.corner_vertex[c])));
  for (std::size_t i = 0; i < options.points.size(); ++i)
    add(SizeSource::point(options.points[i], options.point_size[i]));
}

}  // namespace dm
