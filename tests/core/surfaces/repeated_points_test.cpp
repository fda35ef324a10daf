#include "surfaces/repeated_points.h"

#include <doctest/doctest.h>

using namespace dm;

namespace {

// The surface of a tetrahedron, its first corner at the origin.
void add_tetrahedron(SurfaceMesh& mesh, double side) {
  const auto n = static_cast<Index>(mesh.points.size());
  for (const Vec3& p : {Vec3{0, 0, 0}, {side, 0, 0}, {0, side, 0}, {0, 0, side}}) {
    mesh.points.push_back(p);
    mesh.point_entity.push_back({2, 0});
  }
  for (const Triangle& t : {Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    mesh.triangle_face.push_back(n);
  }
}

}  // namespace

TEST_CASE("repeated points: surfaces that touch at a point get one point, of the lower dimension") {
  SurfaceMesh mesh;
  add_tetrahedron(mesh, 1);
  add_tetrahedron(mesh, -1);
  mesh.point_entity[4] = {0, 7};
  mesh.segments = {{4, 5}, {0, 1}};
  mesh.segment_edge = {3, 4};
  CHECK(first_at_place(mesh)[0] == 4);
  CHECK(has_repeated_points(mesh));
  join_repeated_points(mesh);
  CHECK(!has_repeated_points(mesh));
  CHECK(mesh.points.size() == 7);
  CHECK(mesh.triangles.size() == 8);
  CHECK(mesh.segment_edge == std::vector<Index>{3, 4});
  const Index shared = mesh.segments[0][0];
  CHECK(mesh.segments[1][0] == shared);
  CHECK(mesh.points[shared] == Vec3{0, 0, 0});
  CHECK(mesh.point_entity[shared].dimension == 0);
  int used = 0;
  for (const Triangle& t : mesh.triangles) used += t[0] == shared || t[1] == shared || t[2] == shared;
  CHECK(used == 6);
}

TEST_CASE("repeated points: an edge without length goes with its two triangles and its segment") {
  SurfaceMesh mesh;
  add_tetrahedron(mesh, 1);
  // the edge (1, 2) divided at a point on the same place as 1
  mesh.points.push_back(mesh.points[1]);
  mesh.point_entity.push_back({2, 0});
  mesh.triangles = {{0, 4, 1}, {0, 2, 4}, {0, 1, 3}, {0, 3, 2}, {1, 4, 3}, {4, 2, 3}};
  mesh.triangle_face = {0, 0, 1, 2, 3, 3};
  mesh.segments = {{1, 4}, {4, 2}};
  mesh.segment_edge = {5, 5};
  join_repeated_points(mesh);
  CHECK(!has_repeated_points(mesh));
  CHECK(mesh.triangles.size() == 4);
  CHECK(mesh.triangle_face == std::vector<Index>{0, 1, 2, 3});
  CHECK(mesh.segments == std::vector<Segment>{{1, 2}});
}

TEST_CASE("repeated points: they stay where other edges would become one") {
  SurfaceMesh mesh;
  add_tetrahedron(mesh, 1);
  add_tetrahedron(mesh, -1);
  // A second point in common: the edge between the two would have four triangles.
  mesh.points[5] = mesh.points[1];
  const std::vector<Triangle> before = mesh.triangles;
  join_repeated_points(mesh);
  CHECK(mesh.triangles == before);
  CHECK(mesh.points.size() == 8);
}
