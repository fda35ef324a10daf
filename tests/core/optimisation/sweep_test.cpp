#include "optimisation/sweep.h"

#include <doctest/doctest.h>

#include "base/parallel.h"
#include "optimisation/spatial_order.h"
#include "sample_meshes.h"

using namespace dm;

TEST_CASE("every movable point has its turn, and no two lists of a stage share a tetrahedron") {
  auto s = sample::box(16, 0.2);
  sort_in_space(s.mesh);
  EditMesh edit(s.mesh);
  edit.list_stars();
  const SweepOrder order(edit);
  CHECK(order.stages().size() > 5);
  CHECK(order.stages()[0].size() > 4);
  std::vector<int> turns(edit.vertex_count(), 0);
  for (const auto& stage : order.stages()) {
    std::vector<int> list_of(edit.vertex_count(), -1);
    for (std::size_t k = 0; k < stage.size(); ++k)
      for (const Index v : stage[k]) list_of[v] = static_cast<int>(k), ++turns[v];
    int shared = 0;
    for (const Tet& t : s.mesh.tets)
      for (const Index v : t)
        for (const Index w : t) shared += list_of[v] >= 0 && list_of[w] >= 0 && list_of[v] != list_of[w];
    CHECK(shared == 0);
  }
  for (Index v = 0; v < edit.vertex_count(); ++v) CHECK(turns[v] == (edit.entity(v).dimension > 0));
}

TEST_CASE("a loop on several threads does each item once and hands failures on") {
  Context context;
  context.threads = 3;
  std::vector<int> done(1000, 0);
  for_all(1000, context, 0, [&](int, int item) { ++done[item]; });
  CHECK(done == std::vector<int>(1000, 1));
  CHECK_THROWS_AS(for_all(1000, context, 0,
                          [](int, int item) {
                            if (item == 500) throw Failure("optimisation", "test", "for the test");
                          }),
                  Failure);
  for_all(0, context, 0, [&](int, int) { FAIL("nothing to do"); });
}
