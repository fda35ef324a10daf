#include "boundary/labelled_triangulation.h"

#include <algorithm>
#include <bit>
#include <unordered_set>

namespace dm {

namespace {

// Breadth-first search of the star of vertex a for a tetrahedron with the given corners.
template <class Accept>
Face search_star(const Triangulation& tets, Index a, Accept accept) {
  const Index start = tets.vertex_tet(a);
  if (start < 0) return -1;
  std::vector<Index> star{start};
  const auto seen = [&](Index t) { return std::find(star.begin(), star.end(), t) != star.end(); };
  std::unordered_set<Index> large;  // past a few dozen tetrahedra it beats the linear search
  const auto visit = [&](Index t) {
    if (star.size() == 64 && large.empty()) large.insert(star.begin(), star.end());
    if (large.empty() ? seen(t) : !large.insert(t).second) return;
    star.push_back(t);
  };
  for (std::size_t k = 0; k < star.size(); ++k) {
    const Index tet = star[k];
    const Face found = accept(tet);
    if (found >= 0) return found;
    const Tet& v = tets.corners(tet);
    for (int i = 0; i < 4; ++i)
      if (v[i] != a) visit(tets.neighbour(tet, i) / 4);
  }
  return -1;
}

// Does the label of face i of tet say that the tetrahedron belongs to its solid?
bool label_agrees(const LabelledTriangulation& mesh, Index tet, int i) {
  const Index t = label_of(mesh, tet, i);
  const bool front = corner_in_front(mesh.tets.corners(tet), i, mesh.boundary.corners(t));
  return mesh.boundary.solids(t)[front ? 1 : 0] == mesh.tets.tag(tet);
}

}  // namespace

Face find_face(const Triangulation& tets, Index a, Index b, Index c) {
  return search_star(tets, a, [&](Index tet) -> Face {
    const Tet& v = tets.corners(tet);
    int others = 0, apex = -1;
    for (int i = 0; i < 4; ++i) {
      if (v[i] == b || v[i] == c)
        ++others;
      else if (v[i] != a)
        apex = i;
    }
    return others == 2 ? 4 * tet + apex : -1;
  });
}

bool has_edge(const Triangulation& tets, Index a, Index b) {
  return search_star(tets, a, [&](Index tet) {
           const Tet& v = tets.corners(tet);
           return std::find(v.begin(), v.end(), b) != v.end() ? 4 * tet : -1;
         }) >= 0;
}

Index label_of(const LabelledTriangulation& mesh, Index tet, int i) {
  const Tet& v = mesh.tets.corners(tet);
  return mesh.boundary.find(v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3]);
}

void set_marked_both(Triangulation& tets, Face f, bool on) {
  tets.set_marked(f / 4, f % 4, on);
  const Face g = tets.neighbour(f / 4, f % 4);
  tets.set_marked(g / 4, g % 4, on);
}

bool corner_in_front(const Tet& v, int i, const Triangle& t) {
  const Index a = v[kFaceCorners[i][0]], b = v[kFaceCorners[i][1]];
  for (int k = 0; k < 3; ++k)
    if (t[k] == a) return t[(k + 1) % 3] == b;
  return false;
}

bool tag_solids(LabelledTriangulation& mesh) {
  Triangulation& tets = mesh.tets;
  for (Index t = 0; t < tets.slot_count(); ++t)
    if (!tets.is_free(t)) tets.set_tag(t, tets.is_ghost(t) ? 0 : kUnknownSolid);
  std::vector<Index> queue;
  const auto flood = [&](Index start, std::uint16_t solid) {
    tets.set_tag(start, solid);
    queue.assign(1, start);
    while (!queue.empty()) {
      const Index t = queue.back();
      queue.pop_back();
      for (int i = 0; i < 4; ++i) {
        if (tets.marked(t, i)) continue;
        const Index n = tets.neighbour(t, i) / 4;
        if (tets.tag(n) != kUnknownSolid) continue;
        tets.set_tag(n, solid);
        queue.push_back(n);
      }
    }
  };
  for (Index t = 0; t < tets.slot_count(); ++t)
    if (!tets.is_free(t) && tets.is_ghost(t)) flood(t, 0);
  for (Index t = 0; t < tets.slot_count(); ++t) {
    if (tets.is_free(t) || tets.tag(t) != kUnknownSolid || !tets.marks(t)) continue;
    const int i = std::countr_zero(tets.marks(t));
    const Index label = label_of(mesh, t, i);
    const bool front = corner_in_front(tets.corners(t), i, mesh.boundary.corners(label));
    flood(t, static_cast<std::uint16_t>(mesh.boundary.solids(label)[front ? 1 : 0]));
  }
  for (Index t = 0; t < tets.slot_count(); ++t) {
    if (tets.is_free(t) || tets.is_ghost(t)) continue;
    for (int i = 0; i < 4; ++i)
      if (tets.marked(t, i) && !label_agrees(mesh, t, i)) return false;
  }
  return true;
}

void check_boundary(const LabelledTriangulation& mesh) {
  const Triangulation& tets = mesh.tets;
  Index marked = 0, alive = 0;
  for (Index t = 0; t < tets.slot_count(); ++t) {
    if (tets.is_free(t)) continue;
    for (int i = 0; i < 4; ++i) {
      const Face g = tets.neighbour(t, i);
      if (tets.marked(t, i) != tets.marked(g / 4, g % 4))
        throw Failure("boundary", "check", "a face is marked on one side only",
                      tets.point(tets.corners(t)[0]));
      if (!tets.marked(t, i)) {
        if (tets.tag(t) != tets.tag(g / 4))
          throw Failure("boundary", "check", "the solid changes without a boundary",
                        tets.point(tets.corners(t)[0]));
        continue;
      }
      ++marked;
      const Tet& v = tets.corners(t);
      if (label_of(mesh, t, i) < 0)
        throw Failure("boundary", "check", "a marked face carries no label", tets.point(v[(i + 1) & 3]));
      if (!tets.is_ghost(t) && !label_agrees(mesh, t, i))
        throw Failure("boundary", "check", "a tetrahedron lies in another solid than its label says",
                      tets.point(v[(i + 1) & 3]));
    }
  }
  for (Index t = 0; t < mesh.boundary.slot_count(); ++t) alive += mesh.boundary.alive(t);
  if (marked != 2 * alive)
    throw Failure("boundary", "check", "a labelled triangle is not a face of the triangulation");
}

}  // namespace dm
