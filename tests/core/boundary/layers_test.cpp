// Thin layers: plates and walls far thinner than their triangles are large.
#include "boundary/layers.h"

#include <doctest/doctest.h>

#include "../surfaces/shapes.h"
#include "boundary/recovery.h"
#include "surfaces/remesh.h"

using namespace dm;

namespace {

SizeOptions fixed_size(double h) {
  SizeOptions options;
  options.max_size = h;
  options.min_size = h;  // walls and gaps ask for smaller elements otherwise
  return options;
}

void check_recovery(const shapes::Shape& shape, double h) {
  const Plc& plc = shape.plc;
  const Geometry geometry(plc, shape.records);
  Context context;
  const SizeField size(plc, geometry, fixed_size(h), context);
  const SurfaceMesh surface = mesh_surfaces(plc, geometry, size, {}, context);
  RecoveryReport report;
  const auto mesh = recover_boundary(surface, plc, geometry, size, context, report);
  check_complex(mesh.boundary);
  check_boundary(mesh);
  CHECK(report.replaced == 0);
  // Hardly any splitting: the sheets are matched instead.
  CHECK(10 * (report.segment_splits + report.triangle_splits) < static_cast<Index>(surface.points.size()));
  CHECK(static_cast<double>(mesh.tets.points().size()) < 1.6 * static_cast<double>(surface.points.size()));
}

// Two blocks, one above the other, with a gap between them.
shapes::Shape gap(double width) {
  shapes::Shape s;
  shapes::box_walls(s, {0, 0, 0}, {6, 4, 3}, 1, false, 0);
  shapes::box_walls(s, {0, 0, 3 + width}, {6, 4, 6 + width}, 2, false, 0);
  return s;
}

}  // namespace

TEST_CASE("layers: the sides of a narrow gap are recovered whatever its width") {
  for (const double width : {0.2, 0.1, 0.02, 1e-3, 1e-5}) {
    CAPTURE(width);
    check_recovery(gap(width), 0.6);
  }
}

TEST_CASE("layers: the sides of a thin tube are recovered as long as its facets do not cross") {
  for (const double thickness : {0.2, 0.05, 0.02}) {
    CAPTURE(thickness);
    check_recovery(shapes::turned(5, 5, 8, 5 - thickness, 128), 0.8);
  }
}

TEST_CASE("layers: matching keeps a valid surface and leaves matched sheets alone") {
  const shapes::Shape shape = gap(0.02);
  const Geometry geometry(shape.plc, shape.records);
  Context context;
  const SizeField size(shape.plc, geometry, fixed_size(0.6), context);
  SurfaceMesh surface = mesh_surfaces(shape.plc, geometry, size, {}, context);
  std::vector<Index> all(surface.triangles.size());
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<Index>(t);
  std::vector<char> fixed;
  CHECK(match_layers(surface, shape.plc, geometry, size, all, fixed, context) > 0);
  check_surface_mesh(surface, shape.plc, geometry);
  all.clear();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) all.push_back(static_cast<Index>(t));
  const std::vector<Vec3> before = surface.points;
  fixed.clear();
  match_layers(surface, shape.plc, geometry, size, all, fixed, context);
  Index moved = 0;
  for (std::size_t v = 0; v < before.size(); ++v) moved += distance(before[v], surface.points[v]) > 1e-6;
  CHECK(moved * 20 < static_cast<Index>(before.size()));
}

TEST_CASE("layers: matching can be cancelled") {
  const shapes::Shape shape = gap(0.02);
  const Geometry geometry(shape.plc, shape.records);
  Context context, cancelled([](const char*, double) { return false; });
  const SizeField size(shape.plc, geometry, fixed_size(0.6), context);
  SurfaceMesh surface = mesh_surfaces(shape.plc, geometry, size, {}, context);
  std::vector<char> fixed;
  CHECK_THROWS_AS(match_layers(surface, shape.plc, geometry, size, {0, 1}, fixed, cancelled), Cancelled);
}
