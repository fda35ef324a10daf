#include "surfaces/edge_paths.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace dm;

namespace {

// Two edges from the same point, on both sides of a face whose width over the length x is width(x).
template <typename Width>
SurfaceMesh two_edges(int n, Width width) {
  SurfaceMesh mesh;
  mesh.points = {{}};
  mesh.point_entity = {{0, 0}};
  for (const Index edge : {0, 1})
    for (int i = 1; i <= n; ++i) {
      const double x = 10.0 * i / n, y = (edge - 0.5) * width(x);
      const auto p = static_cast<Index>(mesh.points.size());
      mesh.points.push_back({x, y, 0});
      mesh.point_entity.push_back({static_cast<std::int8_t>(i < n), edge});
      mesh.segments.push_back({p, i == 1 ? 0 : p - 1});
      mesh.segment_edge.push_back(edge);
    }
  return mesh;
}

}  // namespace

TEST_CASE("edges that meet at an angle or tangentially do not run in parallel, those of a strip do") {
  constexpr int n = 40;
  const auto parallel = [&](auto width) {
    const SurfaceMesh mesh = two_edges(n, width);
    const EdgePaths paths(mesh);
    REQUIRE(paths.ends()[0] == std::vector<Index>{0, n});
    REQUIRE(paths.ends()[1] == std::vector<Index>{0, 2 * n});
    const Index half = n / 2;
    const bool one = paths.run_in_parallel(0, half, 1, 0, width(5));
    CHECK(one == paths.run_in_parallel(1, n + half, 0, 0, width(5)));
    return one;
  };
  CHECK(!parallel([](double x) { return 0.05 * x; }));
  CHECK(!parallel([](double x) { return 0.01 * x * x; }));
  CHECK(parallel([](double x) { return 0.1 * std::sqrt(x); }));
  CHECK(parallel([](double x) { return std::min(0.2, x); }));
}
