#include "optimisation/spatial_order.h"

#include <doctest/doctest.h>

#include "optimisation/check_mesh.h"
#include "sample_meshes.h"

using namespace dm;

TEST_CASE("sorting keeps the mesh and brings neighbours together") {
  auto s = sample::box(8, 0.2);
  const Geometry geometry(s.plc, s.records);
  const auto spread = [&] {
    double sum = 0;
    for (const Tet& t : s.mesh.tets) sum += std::abs(t[0] - t[3]);
    return sum;
  };
  // Shuffle the points first: that is how refinement leaves them.
  VolumeMesh& m = s.mesh;
  std::vector<Index> place(m.points.size());
  for (Index v = 0; v < static_cast<Index>(place.size()); ++v) place[v] = v;
  Random random(3);
  for (std::size_t v = place.size(); v > 1; --v) std::swap(place[v - 1], place[random.next() % v]);
  const auto points = m.points;
  const auto entities = m.point_entity;
  for (std::size_t v = 0; v < place.size(); ++v) {
    m.points[place[v]] = points[v];
    m.point_entity[place[v]] = entities[v];
  }
  const auto rename = [&](auto& items) {
    for (auto& item : items)
      for (Index& v : item) v = place[v];
  };
  rename(m.tets);
  rename(m.triangles);
  rename(m.segments);
  check_volume_mesh(m);
  const double before = spread();
  sort_in_space(m);
  check_volume_mesh(m);
  check_on_geometry(m, geometry, 1e-9);
  CHECK(sample::volume(m) == doctest::Approx(512));
  CHECK(spread() < 0.5 * before);
}

TEST_CASE("an empty mesh stays empty") {
  VolumeMesh m;
  sort_in_space(m);
  CHECK(m.points.empty());
}
