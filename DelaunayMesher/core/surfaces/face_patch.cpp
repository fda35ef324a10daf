#include "surfaces/face_patch.h"

#include <algorithm>
#include <string>

#include "base/failure.h"

namespace dm {

Index FacePatch::add_vertex(const Vec3& p, VertexKind kind, Index global_point) {
  points.push_back(p);
  normals.push_back({});
  lengths.push_back(0);
  kinds.push_back(kind);
  global.push_back(global_point);
  vertex_corner_.push_back(-1);
  mark_.push_back(0);
  return vertex_count() - 1;
}

void FacePatch::pop_vertex() {
  points.pop_back();
  normals.pop_back();
  lengths.pop_back();
  kinds.pop_back();
  global.pop_back();
  vertex_corner_.pop_back();
  mark_.pop_back();
}

void FacePatch::start(std::vector<Index> corner_vertices, std::vector<Index> twins) {
  vertex = std::move(corner_vertices);
  twin = std::move(twins);
  stamp_.assign(vertex.size() / 3, 0);
  for (std::size_t c = 0; c < vertex.size(); ++c) vertex_corner_[vertex[c]] = static_cast<Index>(c);
}

Index FacePatch::new_triangle() {
  if (!free_.empty()) {
    const Index t = free_.back();
    free_.pop_back();
    return t;
  }
  vertex.resize(vertex.size() + 3, -1);
  twin.resize(twin.size() + 3, -1);
  stamp_.push_back(0);
  return triangle_slots() - 1;
}

void FacePatch::set_triangle(Index t, Index a, Index b, Index c) {
  const Index v[3] = {a, b, c};
  for (int i = 0; i < 3; ++i) {
    vertex[3 * t + i] = v[i];
    vertex_corner_[v[i]] = 3 * t + i;
  }
  ++stamp_[t];
}

void FacePatch::remove_triangle(Index t) {
  for (int i = 0; i < 3; ++i) vertex[3 * t + i] = twin[3 * t + i] = -1;
  ++stamp_[t];
  free_.push_back(t);
}

Index FacePatch::find_edge(Index a, Index b) const {
  Index found = -1;
  for_each_corner(a, [&](Index c) {
    if (vertex[next(c)] == b) found = prev(c);
    if (twin[next(c)] < 0 && vertex[prev(c)] == b) found = next(c);
  });
  return found;
}

Index FacePatch::boundary_edge(Index v) const {
  Index found = -1;
  for_each_corner(v, [&](Index c) {
    if (twin[prev(c)] < 0) found = prev(c);
  });
  return found;
}

void FacePatch::split_triangle(Index t, Index v) {
  const Index a = vertex[3 * t], b = vertex[3 * t + 1], c = vertex[3 * t + 2];
  const Index bc = twin[3 * t], ca = twin[3 * t + 1];
  const Index u = new_triangle(), w = new_triangle();
  const Index ab = twin[3 * t + 2];
  set_triangle(t, a, b, v);
  set_triangle(u, b, c, v);
  set_triangle(w, c, a, v);
  link(3 * t + 2, ab);
  link(3 * u + 2, bc);
  link(3 * w + 2, ca);
  link(3 * t, 3 * u + 1);
  link(3 * u, 3 * w + 1);
  link(3 * w, 3 * t + 1);
}

Index FacePatch::split_edge(Index e, Index v) {
  // Triangle (c, a, b) with e opposite to c; on the other side (d, b, a).
  const Index m = twin[e];
  const Index c = apex(e), a = origin(e), b = target(e);
  const Index bc = twin[next(e)];
  const Index u = new_triangle();
  set_triangle(u, c, v, b);
  vertex[prev(e)] = v;
  ++stamp_[e / 3];
  vertex_corner_[c] = e;
  vertex_corner_[a] = next(e);
  link(3 * u + 1, bc);
  link(3 * u + 2, next(e));
  if (m < 0) {
    twin[e] = twin[3 * u] = -1;
    return 3 * u;
  }
  // In triangle (d, b, a) next(m) is the corner of b, opposite to (a, d).
  const Index d = apex(m), ad = twin[next(m)];
  const Index w = new_triangle();
  set_triangle(w, d, v, a);
  vertex[prev(m)] = v;
  ++stamp_[m / 3];
  vertex_corner_[d] = m;
  vertex_corner_[b] = next(m);
  vertex_corner_[v] = prev(m);
  link(3 * w + 1, ad);
  link(3 * w + 2, next(m));
  link(e, 3 * w);
  link(3 * u, m);
  return 3 * u;
}

void FacePatch::flip(Index e) {
  const Index m = twin[e];
  const Index t = e / 3, s = m / 3;
  const Index c = apex(e), a = origin(e), b = target(e), d = apex(m);
  const Index bc = twin[next(e)], ca = twin[prev(e)], ad = twin[next(m)], db = twin[prev(m)];
  set_triangle(t, c, a, d);  // half-edges: a -> d, d -> c, c -> a
  set_triangle(s, d, b, c);  // b -> c, c -> d, d -> b
  link(3 * t, ad);
  link(3 * t + 1, 3 * s + 1);
  link(3 * t + 2, ca);
  link(3 * s, bc);
  link(3 * s + 2, db);
}

void FacePatch::collapse(Index e, Index gone) {
  const Index a = gone, b = origin(e) == gone ? target(e) : origin(e), m = twin[e];
  for_each_corner(a, [&](Index c) {
    vertex[c] = b;
    ++stamp_[c / 3];
  });
  for (const Index h : {e, m}) {
    if (h < 0) continue;
    const Index left = twin[next(h)], right = twin[prev(h)];
    if (left >= 0) twin[left] = right;
    if (right >= 0) twin[right] = left;
    remove_triangle(h / 3);
    const Index keep = left >= 0 ? left : right;  // the edge between b and the apex, in a triangle that stays
    for (const Index c : {next(keep), prev(keep)}) vertex_corner_[vertex[c]] = c;
  }
  vertex_corner_[a] = -1;
  kinds[a] = VertexKind::removed;
}

bool FacePatch::can_collapse(Index e, Index gone) const {
  const Index a = gone, b = origin(e) == gone ? target(e) : origin(e), m = twin[e];
  const Index c = apex(e), d = m >= 0 ? apex(m) : -1;
  // A triangle at e whose two other edges are both boundary would leave the patch disconnected.
  for (const Index h : {e, m})
    if (h >= 0 && twin[next(h)] < 0 && twin[prev(h)] < 0) return false;
  bool ok = true;
  ++mark_value_;
  for_each_corner(a, [&](Index k) {
    mark_[vertex[next(k)]] = mark_[vertex[prev(k)]] = mark_value_;
    if (m >= 0 && (twin[next(k)] < 0 || twin[prev(k)] < 0)) ok = false;  // would pinch the boundary
  });
  for_each_corner(b, [&](Index k) {
    const Index x = vertex[next(k)], y = vertex[prev(k)];
    for (const Index v : {x, y})
      if (mark_[v] == mark_value_ && v != c && v != d && v != a) ok = false;
    if (m >= 0 && ((x == c && y == d) || (x == d && y == c))) ok = false;  // would repeat a triangle
  });
  return ok;
}

void FacePatch::check() const {
  auto fail = [](const char* what, Index at) {
    throw Failure("surfaces", "patch", std::string(what) + " at " + std::to_string(at));
  };
  std::vector<std::array<Index, 2>> edges;
  for (Index e = 0; e < static_cast<Index>(vertex.size()); ++e) {
    if (!alive(e / 3)) continue;
    const Index m = twin[e];
    if (vertex[e] < 0 || vertex[e] >= vertex_count()) fail("vertex out of range", e);
    if (kinds[vertex[e]] == VertexKind::removed) fail("removed vertex in use", e);
    if (origin(e) == target(e)) fail("degenerate triangle", e);
    if (vertex_corner_[vertex[e]] < 0) fail("vertex without corner", vertex[e]);
    if (m >= 0 && (twin[m] != e || !alive(m / 3))) fail("twins disagree", e);
    if (m >= 0 && (origin(m) != target(e) || target(m) != origin(e))) fail("twins of different edges", e);
    if (m >= 0 && apex(m) == apex(e)) fail("two triangles on the same three vertices", e);
    if (m < 0 || m > e) edges.push_back({std::min(origin(e), target(e)), std::max(origin(e), target(e))});
  }
  std::sort(edges.begin(), edges.end());
  const auto twice = std::adjacent_find(edges.begin(), edges.end());
  if (twice != edges.end()) fail("edge repeated", (*twice)[0]);
  std::vector<Index> fan(points.size(), 0), total(points.size(), 0);
  for (Index v : vertex)
    if (v >= 0) ++total[v];
  for (Index v = 0; v < vertex_count(); ++v) {
    if (total[v] == 0) continue;
    if (vertex[vertex_corner_[v]] != v) fail("corner of another vertex", v);
    Index n = 0;
    for_each_corner(v, [&](Index) { ++n; });
    if (n != total[v]) fail("vertex with more than one fan", v);
  }
}

}  // namespace dm
