#include "surfaces/face_patch.h"

#include <doctest/doctest.h>

#include "base/random.h"

using namespace dm;

namespace {

// A square of n by n cells, each cut into two triangles.
FacePatch grid(Index n) {
  FacePatch patch;
  for (Index j = 0; j <= n; ++j)
    for (Index i = 0; i <= n; ++i) {
      const bool boundary = i == 0 || j == 0 || i == n || j == n;
      patch.add_vertex({1.0 * i, 1.0 * j, 0}, boundary ? VertexKind::fixed : VertexKind::interior, -1);
    }
  std::vector<Index> corners;
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      for (Index v : {a, b, c, a, c, d}) corners.push_back(v);
    }
  std::vector<Index> twins(corners.size(), -1);
  const Index m = static_cast<Index>(corners.size());
  for (Index e = 0; e < m; ++e)
    for (Index f = 0; f < m; ++f)
      if (corners[FacePatch::next(e)] == corners[FacePatch::prev(f)] &&
          corners[FacePatch::prev(e)] == corners[FacePatch::next(f)])
        twins[e] = f;
  patch.start(corners, twins);
  return patch;
}

Index alive_count(const FacePatch& patch) {
  Index n = 0;
  for (Index t = 0; t < patch.triangle_slots(); ++t) n += patch.alive(t);
  return n;
}

}  // namespace

TEST_CASE("each operation leaves a valid patch and changes the counts as it should") {
  FacePatch patch = grid(4);
  patch.check();
  CHECK(alive_count(patch) == 32);
  patch.split_triangle(5, patch.add_vertex({}, VertexKind::interior, -1));
  patch.check();
  CHECK(alive_count(patch) == 34);

  Index inner = 0, outer = 0;
  while (patch.twin[inner] < 0) ++inner;
  patch.split_edge(inner, patch.add_vertex({}, VertexKind::interior, -1));
  patch.check();
  CHECK(alive_count(patch) == 36);
  while (patch.twin[outer] >= 0) ++outer;
  const Index a = patch.origin(outer), b = patch.target(outer);
  const Index v = patch.add_vertex({}, VertexKind::dropped, -1);
  const Index rest = patch.split_edge(outer, v);
  patch.check();
  CHECK(alive_count(patch) == 37);
  CHECK(patch.origin(outer) == a);
  CHECK(patch.target(outer) == v);
  CHECK(patch.origin(rest) == v);
  CHECK(patch.target(rest) == b);

  REQUIRE(patch.can_collapse(outer, v));
  patch.collapse(outer, v);
  patch.check();
  CHECK(alive_count(patch) == 36);
  CHECK(patch.find_edge(a, b) >= 0);
}

TEST_CASE("a flip done twice gives the old edge") {
  FacePatch patch = grid(3);
  Index e = 0;
  while (patch.twin[e] < 0) ++e;
  const Index a = patch.origin(e), b = patch.target(e), c = patch.apex(e), d = patch.apex(patch.twin[e]);
  patch.flip(e);
  patch.check();
  CHECK(patch.find_edge(a, b) < 0);
  const Index f = patch.find_edge(c, d);
  REQUIRE(f >= 0);
  patch.flip(f);
  patch.check();
  CHECK(patch.find_edge(a, b) >= 0);
}

TEST_CASE("a collapse that would pinch the boundary or double an edge is refused") {
  FacePatch patch = grid(1);  // two triangles: every vertex on the boundary
  for (Index e = 0; e < 6; ++e)
    if (patch.twin[e] >= 0) CHECK(!patch.can_collapse(e, patch.origin(e)));
}

TEST_CASE("thousands of random operations keep the patch valid") {
  FacePatch patch = grid(6);
  Random random(7);
  for (int step = 0; step < 4000; ++step) {
    const Index e = static_cast<Index>(random.uniform() * static_cast<double>(patch.vertex.size()));
    if (!patch.alive(e / 3)) continue;
    const double dice = random.uniform();
    const Index m = patch.twin[e];
    if (dice < 0.4) {
      if (m >= 0 && patch.apex(e) != patch.apex(m) && patch.find_edge(patch.apex(e), patch.apex(m)) < 0)
        patch.flip(e);
    } else if (dice < 0.75) {
      const Index gone = random.uniform() < 0.5 ? patch.origin(e) : patch.target(e);
      const bool may = m < 0 || patch.kinds[gone] == VertexKind::interior;
      if (may && patch.can_collapse(e, gone)) patch.collapse(e, gone);
    } else if (dice < 0.9) {
      patch.split_edge(e, patch.add_vertex({}, m < 0 ? VertexKind::fixed : VertexKind::interior, -1));
    } else {
      patch.split_triangle(e / 3, patch.add_vertex({}, VertexKind::interior, -1));
    }
    if (step % 50 == 0) patch.check();
  }
  patch.check();
  CHECK(alive_count(patch) > 0);
}
