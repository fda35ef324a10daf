#include "optimisation/check_mesh.h"

#include <doctest/doctest.h>

#include <string>

#include "sample_meshes.h"

using namespace dm;

namespace {

std::string defect(const VolumeMesh& mesh) {
  try {
    check_volume_mesh(mesh);
  } catch (const Failure& f) {
    return f.code;
  }
  return "";
}

}  // namespace

TEST_CASE("sound meshes pass, each broken invariant is named") {
  const auto sound = sample::box(2, 0.2).mesh;
  CHECK(defect(sound) == "");
  CHECK(defect(sample::ball(1, 1).mesh) == "");
  CHECK(defect(sample::cylinder(1, 2, 8, 3).mesh) == "");
  auto m = sound;
  std::swap(m.tets[3][0], m.tets[3][1]);
  CHECK(defect(m) == "orientation");
  m = sound;
  for (auto& n : m.neighbours)
    if (n[0] >= 0) {
      n[0] = -1;
      break;
    }
  CHECK(defect(m) == "neighbour");
  m = sound;
  m.triangles.pop_back();
  m.triangle_face.pop_back();
  CHECK(defect(m) == "boundary");
  m = sound;
  m.triangles.push_back(m.triangles[0]);
  m.triangle_face.push_back(0);
  CHECK(defect(m) == "boundary");
  m = sound;
  m.points.push_back({9, 9, 9});
  m.point_entity.push_back({3, 1});
  CHECK(defect(m) == "isolated");
  m = sound;
  m.tets[0][0] = 1000;
  CHECK(defect(m) == "index");
  m = sound;
  m.segments[0] = {0, 26};
  CHECK(defect(m) == "segment");
  m = sound;
  m.tet_solid.pop_back();
  CHECK(defect(m) == "sizes");
}

TEST_CASE("a point off its CAD face is found") {
  auto s = sample::ball(1, 1);
  const Geometry geometry(s.plc, s.records);
  check_on_geometry(s.mesh, geometry, 1e-9);
  s.mesh.points[3] = 1.001 * s.mesh.points[3];
  CHECK_THROWS_AS(check_on_geometry(s.mesh, geometry, 1e-9), Failure);
}
