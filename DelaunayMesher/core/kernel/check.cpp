// Invariants of a triangulation, checked exactly.
#include <algorithm>
#include <string>

#include "base/failure.h"
#include "kernel/predicates.h"
#include "kernel/triangulation.h"

namespace dm {
namespace {

[[noreturn]] void broken(const char* code, const std::string& what, const Vec3& place = {}) {
  throw Failure("kernel", code, "The triangulation is broken: " + what + ".", place);
}

}  // namespace

void Triangulation::check(bool exact_delaunay) const {
  for (Index t = 0; t < slot_count(); ++t)
    if (!is_free(t)) check_tetrahedron(t);
  check_vertices();
  if (exact_delaunay) check_delaunay();
}

void Triangulation::check_tetrahedron(Index t) const {
  const Tet& c = corners_[t];
  const std::string name = "tetrahedron " + std::to_string(t);
  if (flags_[t] & (kInside | kSeen)) broken("stamp", name + " has a stamp left behind");
  for (int i = 0; i < 4; ++i) {
    if (c[i] >= vertex_count() || c[i] < (i == 3 ? ghost : 0)) broken("corner", name + " has no such corner");
    for (int j = 0; j < i; ++j)
      if (c[i] == c[j]) broken("corner", name + " has a corner twice");
    if (c[i] >= 0 && vertex_tet(c[i]) < 0) broken("vertex", "a corner of " + name + " has no tetrahedron");
    const Face face = neighbours_[t][i];
    const Index n = face >> 2;
    if (face < 0 || n >= slot_count() || is_free(n)) broken("neighbour", name + " has no such neighbour");
    if (neighbours_[n][face & 3] != 4 * t + i)
      broken("neighbour", name + " is not its neighbour's neighbour");
    if (is_ghost(t) && i == 3 && is_ghost(n)) broken("ghost", name + " is a ghost behind a ghost");
    const Tet& d = corners_[n];
    const auto *f = kFaceCorners[i], *g = kFaceCorners[face & 3];
    Triangle mine = {c[f[0]], c[f[1]], c[f[2]]}, other = {d[g[2]], d[g[1]], d[g[0]]};
    std::rotate(mine.begin(), std::min_element(mine.begin(), mine.end()), mine.end());
    std::rotate(other.begin(), std::min_element(other.begin(), other.end()), other.end());
    if (mine != other) broken("neighbour", name + " and its neighbour do not share a face");
  }
  if (!is_ghost(t) && orient3d(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]]) <= 0)
    broken("orientation", name + " is not positively oriented", points_[c[0]]);
}

void Triangulation::check_vertices() const {
  if (vertex_tet_.size() != points_.size()) broken("vertex", "the list of vertices has a wrong length");
  for (Index v = 0; v < vertex_count(); ++v) {
    const Index t = vertex_tet(v);
    if (t < 0) continue;
    if (t >= slot_count() || is_free(t) ||
        std::find(corners_[t].begin(), corners_[t].end(), v) == corners_[t].end())
      broken("vertex", "vertex " + std::to_string(v) + " is no corner of its tetrahedron", points_[v]);
  }
}

// Local Delaunay property of every face, ties perturbed; also that the hull is convex.
void Triangulation::check_delaunay() const {
  for (Index t = 0; t < slot_count(); ++t) {
    if (is_free(t)) continue;
    for (int i = 0; i < 4; ++i) {
      const Face face = neighbours_[t][i];
      const Index v = corners_[face >> 2][face & 3];
      if (v == ghost || (is_ghost(t) && i == 3)) continue;
      if (conflict(t, points_[v], number_of(v)))
        broken("delaunay",
               "vertex " + std::to_string(v) + " is inside the sphere of tetrahedron " + std::to_string(t),
               points_[v]);
    }
  }
}

}  // namespace dm
