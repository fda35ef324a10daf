#include "surfaces/defects.h"

#include <doctest/doctest.h>

#include "shapes.h"

using namespace dm;

TEST_CASE("two points of a face on the same place count as a face that crosses itself") {
  const shapes::Shape box = shapes::box(1, 1, 1);
  const Geometry geometry(box.plc, box.records);
  Context context;
  SizeOptions options;
  options.max_size = 0.3;
  const SizeField size(box.plc, geometry, options, context);
  const LengthField lengths(size, 0.8);
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0},  {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0},
                 {0, -1, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  mesh.point_entity.assign(9, {2, 0});
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  mesh.triangle_face = {0, 0, 1};
  const auto found = find_crossing_defects(mesh, lengths);
  REQUIRE(found.size() == 2);
  for (const Defect& d : found) {
    CHECK(d.face == 0);
    CHECK(d.other == 0);
  }
}
