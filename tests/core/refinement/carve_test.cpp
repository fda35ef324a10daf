#include "refinement/carve.h"

#include <doctest/doctest.h>

using namespace dm;

namespace {

// Two solids with a third one between them that has no thickness at point 2, which is there twice.
VolumeMesh three_solids() {
  VolumeMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, {0.3, 1, 1e-10}, {0.3, 0.3, 1}, {0.3, 0.3, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 2, 1, 5}};
  mesh.tet_solid = {1, 2, 3};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  mesh.triangle_face = {0, 1};
  return mesh;
}

}  // namespace

TEST_CASE("an element without volume between two solids is left out, its boundary triangles stay") {
  VolumeMesh mesh = three_solids();
  const auto places = leave_out_flat_tets(mesh);
  REQUIRE(places.size() == 1);
  CHECK(distance(places[0], {0.4, 0.5, 0}) < 1e-9);
  CHECK(mesh.tets == std::vector<Tet>{{0, 1, 3, 4}, {0, 2, 1, 5}});
  CHECK(mesh.tet_solid == std::vector<Index>{2, 3});
  CHECK(mesh.triangles.size() == 2);
  CHECK(leave_out_flat_tets(mesh).empty());
}

TEST_CASE("boundary triangles and segments of no other element go with it") {
  VolumeMesh mesh = three_solids();
  mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 3}, {1, 2, 3}});
  mesh.triangle_face = {0, 1, 2, 3};
  mesh.segments = {{0, 1}, {2, 3}};
  mesh.segment_edge = {0, 1};
  CHECK(leave_out_flat_tets(mesh).size() == 1);
  CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}});
  CHECK(mesh.triangle_face == std::vector<Index>{0, 1});
  CHECK(mesh.segments == std::vector<Segment>{{0, 1}});
  CHECK(mesh.segment_edge == std::vector<Index>{0});
}

TEST_CASE("no point loses its last element") {
  VolumeMesh mesh = three_solids();
  mesh.tets.pop_back();
  mesh.tet_solid.pop_back();
  CHECK(leave_out_flat_tets(mesh).empty());
  CHECK(mesh.tets.size() == 2);
}
