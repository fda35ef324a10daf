// The triangulation of one CAD face while it is remeshed: a manifold with boundary in flat half-edge arrays.
//
// Corner (= half-edge) 3 * t + i belongs to triangle t; as a half-edge it is the edge opposite to that
// corner, running from its `next` corner's vertex to its `prev` corner's.  twin = the same edge in the
// neighbour triangle, -1 on the boundary.  Where the face touches itself (a pinch, a cut along a segment
// inside) each fan of triangles has its own copy of the vertex, so the patch is always a manifold.
//
// Operations come in pairs: the question whether one may is geometry and lies in remesh_patch; what is here
// is pure topology, cannot fail when its precondition holds, and costs O(degree).
#pragma once

#include <vector>

#include "base/vec3.h"

namespace dm {

enum class VertexKind : std::int8_t {
  interior,  // free on the face
  fixed,     // point of a sampled curve, or a CAD vertex inside the face
  dropped,   // old point of a boundary curve, to be removed
  removed,   // no longer in use
};

class FacePatch {
 public:
  std::vector<Vec3> points;
  std::vector<Vec3> normals;    // unit normal of the surface; zero where it has none (an apex)
  std::vector<double> lengths;  // edge length wanted
  std::vector<VertexKind> kinds;
  std::vector<Index> global;  // point of the curve sampling, or -1: born on this face
  std::vector<Index> vertex;  // of each corner; -1 in a removed triangle
  std::vector<Index> twin;    // of each half-edge
  // Vertices first, ..., last - 1 wait to be inserted in the boundary edge that starts at `origin`.
  struct Pending {
    Index origin, first, last;
  };
  std::vector<Pending> pending;

  static Index next(Index c) { return c % 3 == 2 ? c - 2 : c + 1; }
  static Index prev(Index c) { return c % 3 == 0 ? c + 2 : c - 1; }
  Index origin(Index e) const { return vertex[next(e)]; }
  Index target(Index e) const { return vertex[prev(e)]; }
  Index apex(Index e) const { return vertex[e]; }
  Index triangle_slots() const { return static_cast<Index>(vertex.size() / 3); }
  Index vertex_count() const { return static_cast<Index>(points.size()); }
  bool alive(Index t) const { return vertex[3 * t] >= 0; }
  Index corner_of(Index v) const { return vertex_corner_[v]; }
  // Counts the changes of a triangle: an entry in a work queue is stale when it differs.
  Index stamp(Index t) const { return stamp_[t]; }

  Index add_vertex(const Vec3& p, VertexKind kind, Index global_point);
  // Takes back add_vertex while no triangle uses the vertex.
  void pop_vertex();
  // From a triangle list with twins already set; fills the corner of each vertex.
  void start(std::vector<Index> corner_vertices, std::vector<Index> twins);

  // Calls f(corner) for every corner at v.
  template <class F>
  void for_each_corner(Index v, F f) const {
    const Index start_corner = vertex_corner_[v];
    if (start_corner < 0) return;
    Index c = start_corner;
    do {
      f(c);
      const Index m = twin[next(c)];
      if (m < 0) {
        for (Index k = twin[prev(start_corner)]; k >= 0; k = twin[prev(k)]) {
          k = prev(k);
          f(k);
        }
        return;
      }
      c = next(m);
    } while (c != start_corner);
  }
  // Calls f(w) for every vertex joined to v by an edge.
  template <class F>
  void for_each_neighbour(Index v, F f) const {
    for_each_corner(v, [&](Index c) {
      f(vertex[next(c)]);
      if (twin[next(c)] < 0) f(vertex[prev(c)]);
    });
  }
  // The half-edge from a to b, or the one from b to a where only that exists; -1 if they are not joined.
  Index find_edge(Index a, Index b) const;

  // The boundary half-edge that starts at v.  Precondition: v is on the boundary.
  Index boundary_edge(Index v) const;

  // t (a, b, c) becomes (a, b, v), (b, c, v), (c, a, v).
  void split_triangle(Index t, Index v);
  // e = a -> b keeps its id as a -> v; returns the half-edge v -> b of the same side.
  Index split_edge(Index e, Index v);
  // Replaces e = (a, b) by the other diagonal (c, d).  Precondition: e has a twin, no edge (c, d).
  // Afterwards e runs from d, the old apex of the twin, to c, or the other way round.
  void flip(Index e);
  // Moves all triangles of `gone`, one end of e, to the other end; the one or two triangles at e vanish.
  // Precondition: can_collapse.
  void collapse(Index e, Index gone);
  // Link condition: no edge or triangle would double, the boundary would not be pinched.
  bool can_collapse(Index e, Index gone) const;

  // Throws Failure("surfaces", "patch", ...) when an invariant is broken.
  void check() const;

 private:
  Index new_triangle();
  void set_triangle(Index t, Index a, Index b, Index c);
  void link(Index e, Index f) {
    twin[e] = f;
    if (f >= 0) twin[f] = e;
  }
  void remove_triangle(Index t);

  std::vector<Index> vertex_corner_;
  std::vector<Index> stamp_;
  std::vector<Index> free_;
  mutable std::vector<Index> mark_;  // scratch of can_collapse
  mutable Index mark_value_ = 0;
};

}  // namespace dm
