// Flips of boundary edges (flips.h).
#include "optimisation/flips.h"
#include "optimisation/sagitta.h"

namespace dm {
namespace {

bool share_edge(EditMesh& mesh, Index a, Index b) {
  for (Index t : mesh.star(a))
    for (Index v : mesh.tet(t))
      if (v == b) return true;
  return false;
}

}  // namespace

// The ring of an edge on the outer boundary, from one boundary triangle to the other: corner.size() is one
// more than the number of tetrahedra.
bool Flipper::find_open_ring(Index start, int ia, int ib, Ring& ring) const {
  const Tet& first = mesh_.tet(start);
  ring.a = first[ia];
  ring.b = first[ib];
  ring.count = 0;
  Tet rest{};  // the two corners off the edge, in the order of the turn
  int filled = 0;
  for (int i = 0; i < 4; ++i)
    if (i != ia && i != ib) rest[filled++] = i;
  if (!is_positive(mesh_.point(ring.a), mesh_.point(ring.b), mesh_.point(first[rest[0]]),
                   mesh_.point(first[rest[1]])))
    std::swap(rest[0], rest[1]);
  int ic = rest[0], id = rest[1];
  Index t = start;
  for (int steps = 0; !mesh_.marked(t, id); ++steps) {  // back to the first tetrahedron
    if (steps == kMaxRing) return false;
    const Index kept = mesh_.tet(t)[ic], n = mesh_.neighbour(t, id);
    t = n / 4;
    ic = n % 4;
    id = mesh_.corner_index(t, kept);
  }
  if (mesh_.neighbour(t, id) >= 0) return false;
  ring.corner[ring.count] = mesh_.tet(t)[ic];
  for (;;) {
    if (ring.count + 1 == kMaxRing) return false;
    ring.tet[ring.count++] = t;
    const Index last = mesh_.tet(t)[id];
    ring.corner[ring.count] = last;
    const Index n = mesh_.neighbour(t, ic);
    if (n < 0) break;
    if (mesh_.marked(t, ic)) return false;
    t = n / 4;
    id = n % 4;
    ic = mesh_.corner_index(t, last);
  }
  ++ring.count;
  return ring.count >= 3;
}

// May the edge (a, b) of the boundary become (first corner, last corner)?  Gives the triangles and what they
// turn into.
bool Flipper::keeps_surface(const Ring& ring, const Geometry& geometry, std::array<Index, 2>& triangles,
                            std::array<Triangle, 2>& turned) {
  const Index a = ring.a, b = ring.b, c = ring.corner[0], d = ring.corner[ring.count - 1];
  if (mesh_.is_segment(a, b)) return false;
  triangles = {mesh_.find_triangle(a, b, c), mesh_.find_triangle(a, b, d)};
  if (triangles[0] < 0 || triangles[1] < 0) return false;
  const Index face = mesh_.triangle_face(triangles[0]);
  if (mesh_.triangle_face(triangles[1]) != face) return false;
  const auto area = [&](const Triangle& t) {
    return area_vector(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]));
  };
  // The two after a flip have the same sum, even where one of the two before is folded back on the other.
  const Vec3 before = area(mesh_.triangle(triangles[0])) + area(mesh_.triangle(triangles[1]));
  turned = {Triangle{a, c, d}, Triangle{b, d, c}};
  if (dot(area(turned[0]), before) < 0) turned = {Triangle{a, d, c}, Triangle{b, c, d}};
  for (const Triangle& t : turned) {
    if (!turns_little(before, area(t))) return false;
    // share_edge() does not see the parts that touch at a pinched point.
    if (mesh_.find_triangle(t[0], t[1], t[2]) >= 0) return false;
  }
  const Vec3 middle = 0.5 * (mesh_.point(c) + mesh_.point(d));
  Segment old_edge{a, b};
  return lies_as_close(mesh_, geometry, face, {&middle, 1}, {&old_edge, 1});
}

bool Flipper::flip_boundary_edge(Index tet, int ia, int ib, const Geometry& geometry) {
  Ring ring;
  if (!find_open_ring(tet, ia, ib, ring)) return false;
  if (share_edge(mesh_, ring.corner[0], ring.corner[ring.count - 1])) return false;
  const int tets = std::min(ring.count, kMaxRing) - 1;
  double worst = 0;
  for (int i = 0; i < tets; ++i) worst = std::max(worst, mesh_.bad(ring.tet[i]));
  Plan plan;
  start(FlipGoal::worst, plan);
  plan.cost = triangulate(ring);
  if (plan.cost >= worst - 1e-3) return false;
  add_triangles(ring, 0, ring.count - 1, plan);
  plan.before_count = tets;
  std::copy_n(ring.tet.begin(), tets, plan.before.begin());
  std::array<Index, 2> triangles;
  std::array<Triangle, 2> turned;
  if (!keeps_surface(ring, geometry, triangles, turned)) return false;
  if (!is_allowed(plan, turned)) return false;
  for (int i = 0; i < 2; ++i) mesh_.set_triangle(triangles[i], turned[i], mesh_.triangle_face(triangles[i]));
  return !apply(plan).empty();
}

bool Flipper::is_on_boundary(Index a, Index b) {
  for (const Index t : mesh_.star(a)) {
    const Tet& c = mesh_.tet(t);
    if (std::find(c.begin(), c.end(), b) == c.end()) continue;
    for (int i = 0; i < 4; ++i)
      if (mesh_.marked(t, i) && c[i] != a && c[i] != b) return true;
  }
  return false;
}

// The four points of `tet` lie on a curved face, and either diagonal is as good a boundary: it goes, and the
// two faces behind it become the boundary.
bool Flipper::peel(Index tet, int ia, int ib, const Geometry& geometry) {
  const Tet c = mesh_.tet(tet);
  Ring ring;
  ring.a = c[ia];
  ring.b = c[ib];
  for (int i = 0; i < 4; ++i) {
    const bool at_edge = i == ia || i == ib;
    if (at_edge == mesh_.marked(tet, i) || mesh_.pinched(c[i])) return false;
    if (!at_edge && mesh_.neighbour(tet, i) >= 0) return false;
    if (!at_edge) ring.corner[ring.count++] = c[i];
  }
  std::array<Index, 2> triangles;
  std::array<Triangle, 2> turned;
  if (is_on_boundary(ring.corner[0], ring.corner[1]) || !keeps_surface(ring, geometry, triangles, turned))
    return false;
  for (int i = 0; i < 2; ++i) mesh_.set_triangle(triangles[i], turned[i], mesh_.triangle_face(triangles[i]));
  mesh_.replace({&tet, 1}, {});
  return true;
}

bool Flipper::improve_boundary(Index tet, const Geometry& geometry) {
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      if (!mesh_.interior(mesh_.tet(tet)[i]) && !mesh_.interior(mesh_.tet(tet)[j]) &&
          (flip_boundary_edge(tet, i, j, geometry) || peel(tet, i, j, geometry)))
        return true;
  return false;
}

}  // namespace dm
