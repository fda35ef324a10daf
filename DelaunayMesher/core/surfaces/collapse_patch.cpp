// PatchRemesher: removal of old boundary points and of edges shorter than wanted.
#include <algorithm>
#include <cmath>

#include "surfaces/remesh_patch.h"
#include "surfaces/triangle_shape.h"

namespace dm {
namespace {

constexpr double kAligned = 0.5;      // of triangles of the wanted size
constexpr double kSlack = 0.1;        // of alignment, where the triangles are poorly aligned already
constexpr double kWorstShape = 1e-4;  // of a triangle that a collapse may leave (flips improve it afterwards)
constexpr double kLongest = 1.45;     // edge made by a collapse, over the wanted length
// Longer edges do no harm where the new triangles follow a smooth surface closely; without them the short
// edges that a tessellation has round the pole of a sphere stay.
constexpr double kLongestFlat = 2.0;
constexpr double kFlat = 0.95;
// An edge so short, over the wanted length, goes whatever the length of the others: OCC puts points of a face
// within the tolerance of its edges.
constexpr double kNothing = 0.01;

}  // namespace

// Smallest shape of the triangles that collapsing `gone` along e leaves; negative when one of them turns away
// from the surface (more than some did before), is degenerate, or has an edge longer than max_ratio.
double PatchRemesher::collapse_quality(Index e, Index gone, double max_ratio, double aligned) const {
  const Index keep = patch_.origin(e) == gone ? patch_.target(e) : patch_.origin(e);
  double least = aligned;  // what new triangles must reach: no worse than what is there
  patch_.for_each_corner(gone, [&](Index c) {
    const double now = alignment(gone, patch_.vertex[FacePatch::next(c)], patch_.vertex[FacePatch::prev(c)]);
    least = std::min(least, now);
  });
  if (least < aligned) least = std::max(least - kSlack, least > 0 ? 0.05 : -0.9);
  double worst = 1;
  patch_.for_each_corner(gone, [&](Index c) {
    if (worst < 0) return;
    const Index x = patch_.vertex[FacePatch::next(c)], y = patch_.vertex[FacePatch::prev(c)];
    if (x == keep || y == keep) return;
    const double q = triangle_shape(points()[keep], points()[x], points()[y]);
    if (q < kWorstShape || alignment(keep, x, y) < least) worst = -1;
    if (edge_ratio(keep, x) > max_ratio || edge_ratio(keep, y) > max_ratio) worst = -1;
    if (worst >= 0) worst = std::min(worst, q);
  });
  return worst;
}

// ---- old boundary points

// Flips edges at v away until only one triangle is left there, as far as nothing folds.
bool PatchRemesher::flip_towards_ear(Index v, double aligned) {
  bool any = false;
  for (bool again = true; again;) {
    again = false;
    Index found = -1;
    patch_.for_each_corner(v, [&](Index c) {
      const Index e = FacePatch::prev(c);  // v -> next vertex
      if (found >= 0 || patch_.twin[e] < 0) return;
      const Index m = patch_.twin[e];
      const Index a = patch_.apex(e), d = patch_.apex(m), b = patch_.target(e);
      if (a == d || alignment(a, v, d) < aligned || alignment(d, b, a) < aligned) return;
      if (triangle_shape(points()[d], points()[b], points()[a]) < kWorstShape) return;
      if (patch_.find_edge(a, d) < 0) found = e;
    });
    if (found >= 0) {
      patch_.flip(found);
      any = again = true;
    }
  }
  return any;
}

bool PatchRemesher::remove_boundary_vertex(Index v, double aligned) {
  for (const bool flipped : {false, true}) {
    if (flipped && !flip_towards_ear(v, aligned)) break;
    Index sides[2] = {-1, -1};
    patch_.for_each_corner(v, [&](Index c) {
      if (patch_.twin[FacePatch::prev(c)] < 0) sides[0] = FacePatch::prev(c);
      if (patch_.twin[FacePatch::next(c)] < 0) sides[1] = FacePatch::next(c);
    });
    double best = -1;
    Index side = -1;
    for (const Index e : sides) {
      if (e < 0 || !patch_.can_collapse(e, v)) continue;
      const double q = collapse_quality(e, v, HUGE_VAL, aligned);
      if (q > best) {
        best = q;
        side = e;
      }
    }
    if (side < 0) continue;
    const Index keep = patch_.origin(side) == v ? patch_.target(side) : patch_.origin(side);
    patch_.collapse(side, v);
    push_star(keep);
    lawson();
    return true;
  }
  push_star(v);
  lawson();
  return false;
}

void PatchRemesher::remove_dropped(double aligned) {
  std::vector<Index> work;
  for (Index v = 0; v < patch_.vertex_count(); ++v)
    if (patch_.kinds[v] == VertexKind::dropped) work.push_back(v);
  while (!work.empty()) {
    std::vector<Index> left;
    for (Index v : work)
      if (!remove_boundary_vertex(v, aligned)) left.push_back(v);
    poll_();
    if (left.size() == work.size()) return;
    work = std::move(left);
  }
}

// ---- short edges

// Facets are not, nor is a face with a place where no normal is known, such as a cone with its apex.
bool PatchRemesher::is_smooth() const {
  if (geometry_.is_facets(face_)) return false;
  for (Index v = 0; v < patch_.vertex_count(); ++v)
    if (patch_.corner_of(v) >= 0 && norm2(patch_.normals[v]) == 0) return false;
  return true;
}

void PatchRemesher::collapse_short(double ratio) {
  const bool smooth = is_smooth();
  for (int round = 0; round < 30; ++round) {
    Index removed = 0;
    for (Index v = 0; v < patch_.vertex_count(); ++v) {
      if ((v & 255) == 0) poll_();
      if (patch_.kinds[v] != VertexKind::interior || patch_.corner_of(v) < 0) continue;
      Index e = -1;
      double shortest = ratio;
      patch_.for_each_corner(v, [&](Index c) {
        const double r = edge_ratio(v, patch_.vertex[FacePatch::next(c)]);
        if (r < shortest) {
          shortest = r;
          e = FacePatch::prev(c);
        }
      });
      if (e < 0 || !patch_.can_collapse(e, v)) continue;
      if (collapse_quality(e, v, shortest < kNothing ? HUGE_VAL : kLongest, kAligned) < 0 &&
          (!smooth || collapse_quality(e, v, kLongestFlat, kFlat) < 0))
        continue;
      const Index keep = patch_.target(e);
      patch_.collapse(e, v);
      push_star(keep);
      ++removed;
    }
    if (removed == 0) return;
    lawson();
  }
}

}  // namespace dm
