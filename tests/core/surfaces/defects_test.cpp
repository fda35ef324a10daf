#include "surfaces/defects.h"

#include <doctest/doctest.h>

#include "shapes.h"

using namespace dm;

namespace {

// The lengths wanted on a box of side 1: 0.24.
struct BoxLengths {
  shapes::Shape shape = shapes::box(1, 1, 1);
  Geometry geometry{shape.plc, shape.records};
  Context context;
  SizeField size{shape.plc, geometry, options(), context};
  LengthField lengths{size, 0.8};

  static SizeOptions options() {
    SizeOptions options;
    options.max_size = 0.3;
    return options;
  }
};

}  // namespace

TEST_CASE("two points of a face on the same place count as a face that crosses itself") {
  BoxLengths box;
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0},  {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0},
                 {0, -1, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  mesh.point_entity.assign(9, {2, 0});
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  mesh.triangle_face = {0, 0, 1};
  const auto found = find_crossing_defects(mesh, box.lengths, box.context);
  REQUIRE(found.size() == 2);
  for (const Defect& d : found) {
    CHECK(d.face == 0);
    CHECK(d.other == 0);
  }
}

TEST_CASE(
    "a strip far narrower than its triangles asks for small ones, but not where faces meet at an acute "
    "angle") {
  const BoxLengths box;
  const auto least_length = [&](const Vec3& beyond) {
    SurfaceMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 0.002, 0}, {0, 0.002, 0}, beyond};
    mesh.point_entity = {{1, 0}, {1, 0}, {1, 1}, {1, 1}, {2, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 4}};
    mesh.triangle_face = {0, 0, 1};
    mesh.segments = {{0, 1}, {2, 3}};
    mesh.segment_edge = {0, 1};
    double least = HUGE_VAL;
    for (const Defect& d : find_narrow_places(mesh, box.shape.plc, box.lengths))
      least = std::min(least, d.length);
    return least;
  };
  CHECK(least_length({0.5, -0.5, 0}) == doctest::Approx(0.01));
  CHECK(least_length({0.5, 0.5, -0.05}) == doctest::Approx(0.03));
}
