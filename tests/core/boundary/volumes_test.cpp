// The volumes of solids by their surface mesh and by their tetrahedra.
#include "boundary/volumes.h"

#include <doctest/doctest.h>

#include "../surfaces/shapes.h"

using namespace dm;

TEST_CASE("volumes: both sides of a shared wall, far from the origin") {
  const shapes::Shape s = shapes::two_boxes();
  SurfaceMesh surface;
  surface.points = s.plc.points;
  for (Vec3& p : surface.points) p = p + Vec3{1e6, 2e6, 3e6};
  surface.triangles = s.plc.triangles;
  surface.triangle_face = s.plc.triangle_face;
  const auto volumes = surface_volumes(surface, s.plc);
  REQUIRE(volumes.size() == 2);
  CHECK(volumes[0] == doctest::Approx(1000));
  CHECK(volumes[1] == doctest::Approx(1500));
}

TEST_CASE("volumes: of tetrahedra") {
  VolumeMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -2}};
  mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.tet_solid = {2, 1};
  CHECK(tet_volumes(mesh, 2) == std::vector<double>{2.0 / 6, 1.0 / 6});
}
