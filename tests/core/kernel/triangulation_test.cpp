#include "kernel/triangulation.h"

#include <doctest/doctest.h>

#include "base/failure.h"
#include "base/random.h"

using namespace dm;

TEST_CASE("random points") {
  Random random(7);
  std::vector<Vec3> points;
  for (int i = 0; i < 20000; ++i) points.push_back({random.uniform(), random.uniform(), random.uniform()});
  const Triangulation t(points);
  t.check();
}
TEST_CASE("grid") {
  std::vector<Vec3> points;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j)
      for (int k = 0; k < 30; ++k) points.push_back({i * 1.0, j * 1.0, k * 1.0});
  const Triangulation t(points);
  t.check();
}
