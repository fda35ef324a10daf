// Delaunay triangulation of a growing point set in flat arrays (docs/kernel.md).
//
// Idea: Bowyer-Watson (1981) with a ghost vertex at infinity; cavity found by depth-first search from a
// tetrahedron in conflict; slots of the cavity are used again.  Cospherical ties are broken by symbolic
// perturbation on the vertex number, so the result is unique.
// Two ways to use it: insert a point set at once (build), or propose a site, look at its cavity, and commit
// or drop it (find_cavity / insert).  A dropped proposal writes nothing but stamps.
//
// A tetrahedron carries a 16-bit tag (the boundary stage: its solid) and four marks, one per face (the
// boundary stage: the face is a labelled boundary triangle).  insert() hands both on: the tetrahedron made on
// a border face inherits the tag of the cavity tetrahedron behind it and the mark of that face.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.h"

namespace dm {

// A face of the triangulation: 4 * tet + i, the face of tet opposite its corner i.
using Face = std::int32_t;

struct Cavity {
  std::vector<Index> tets;    // in conflict with the site
  std::vector<Face> border;   // faces of cavity tets whose neighbour is not in conflict
  std::vector<Index> created; // after insert(): created[k] stands on border[k], corner 3 = the new vertex
                              // (ghosts: the ghost is corner 3 and the new vertex corner 2)
};

class Triangulation {
 public:
  static constexpr Index ghost = -1;

  // Triangulates `points` (Hilbert/BRIO order inside; vertex numbers stay those of `points`).
  // Exact duplicates get no tetrahedron: vertex_tet() of the later one is -1.
  // Throws Failure("kernel", "degenerate_points") when all points are coplanar.
  explicit Triangulation(std::span<const Vec3> points, int threads = 1);

  Index vertex_count() const { return static_cast<Index>(points_.size()); }
  const Vec3& point(Index vertex) const { return points_[vertex]; }
  const std::vector<Vec3>& points() const { return points_; }
  // Slots, free ones included: 0 .. slot_count() - 1.
  Index slot_count() const { return static_cast<Index>(corners_.size()); }
  bool is_free(Index tet) const { return corners_[tet][0] == free_slot; }
  bool is_ghost(Index tet) const { return corners_[tet][3] == ghost; }
  const Tet& corners(Index tet) const { return corners_[tet]; }
  // Face of the neighbour that touches face i of tet; the neighbour itself is that / 4.
  Face neighbour(Index tet, int i) const { return neighbours_[tet][i]; }
  Index vertex_tet(Index vertex) const { return vertex_tet_[vertex]; }  // some tetrahedron at it

  std::uint16_t tag(Index tet) const { return tags_[tet]; }
  void set_tag(Index tet, std::uint16_t tag) { tags_[tet] = tag; }
  bool marked(Index tet, int i) const { return marks_[tet] >> i & 1; }
  unsigned marks(Index tet) const { return marks_[tet]; }
  void set_marked(Index tet, int i, bool on);  // one side only

  // Is p inside the (perturbed) circumsphere of tet?  A new vertex is perturbed as number vertex_count().
  bool in_conflict(Index tet, const Vec3& p) const;
  // Remembering walk; returns a tetrahedron in conflict with p (a ghost one if p is outside the hull), or -1
  // when p equals an existing vertex.
  Index locate(const Vec3& p, Index hint) const;

  // Fills the cavity of site p, starting from `start`, which must be in conflict with p.
  // stop_at_marks: gives up at the first marked face with both sides in conflict and returns it, else -1.
  Face find_cavity(const Vec3& p, Index start, bool stop_at_marks, Cavity& cavity) const;

  // Commits the site of the last find_cavity; returns the new vertex and fills cavity.created.
  Index insert(const Vec3& p, Cavity& cavity);

  // Every combinatorial and geometric invariant; throws Failure("kernel", ...) naming the first broken one.
  // `exact_delaunay`: also that no vertex opposite a face is inside the sphere (local test, which implies all).
  void check(bool exact_delaunay = true) const;

 private:
  static constexpr Index free_slot = -2;
  std::vector<Vec3> points_;
  std::vector<Tet> corners_;
  std::vector<std::array<Face, 4>> neighbours_;
  std::vector<std::uint16_t> tags_;
  std::vector<std::uint8_t> marks_;
  std::vector<Index> vertex_tet_;
};

}  // namespace dm
