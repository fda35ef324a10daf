// Delaunay triangulation of a growing point set in flat arrays (docs/kernel.md).
//
// Idea: Bowyer-Watson (1981) with a ghost vertex at infinity; cavity found by breadth-first search from a
// tetrahedron in conflict; slots of the cavity are used again.  Cospherical ties are broken by symbolic
// perturbation on the vertex number, so the result is unique.
// Two ways to use it: insert a point set at once (build), or propose a site, look at its cavity, and commit
// or drop it (find_cavity / insert).  A dropped proposal writes nothing but stamps.
//
// A tetrahedron carries a 16-bit tag (the boundary stage: its solid) and four marks, one per face (the
// boundary stage: the face is a labelled boundary triangle).  insert() hands both on: the tetrahedron made on
// a border face inherits the tag of the cavity tetrahedron behind it and the mark of that face.
//
// Corners are positively oriented (orient3d > 0); the ghost is always corner 3, and a ghost tetrahedron
// (a, b, c, ghost) is in conflict with the points on the positive side of (a, b, c), i.e. outside the hull.
// Cost: about 20 sphere tests and 27 new tetrahedra per point; memory: docs/kernel.md.
// Limits: finite coordinates; at most 5e8 tetrahedra (a Face is 32 bits).
// find_cavity is const but stamps: it may run in two threads at once only where no tetrahedron is seen by
// both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/context.h"
#include "base/tet_geometry.h"
#include "base/vec3.h"
#include "kernel/array.h"
#include "kernel/part.h"
#include "kernel/sphere_tests.h"

namespace dm {

// A face of the triangulation: 4 * tet + i, the face of tet opposite its corner i.
using Face = std::int32_t;

struct Cavity {
  std::vector<Index> tets;     // in conflict with the site
  std::vector<Face> border;    // faces of cavity tets whose neighbour is not in conflict
  std::vector<Face> outside;   // outside[k]: the neighbour's face that touches border[k]
  std::vector<Index> created;  // after insert(): created[k] stands on border[k], corner 3 = the new vertex
                               // (ghosts: the ghost is corner 3 and the new vertex corner 2)

  // Scratch of insert(): what stands on a border face, and its corners' numbers within the cavity.
  struct Made {
    Tet corners;
    std::array<std::uint16_t, 3> local;
    std::uint16_t tag;
    std::uint8_t marks;
  };
  std::vector<Made> made;
  std::vector<Face> edge_faces;
  std::vector<Index> seen;  // scratch of find_cavity(): the tetrahedra tested
  std::vector<std::int8_t> sign;
};

// The slots that a thread may fill: first the free ones (last in, first out), then next .. end - 1.
struct Slots {
  std::vector<Index> free;
  Index next = 0, end = 0;

  Index take() {
    if (free.empty()) return next++;
    const Index slot = free.back();
    free.pop_back();
    return slot;
  }
  bool enough(std::size_t wanted) const {
    return wanted <= free.size() + static_cast<std::size_t>(end - next);
  }
};

class Triangulation {
 public:
  static constexpr Index ghost = -1, free_slot = -2;         // in place of a corner
  static constexpr std::size_t kMostSlots = 0x7fffffff / 4;  // a Face is four times its tetrahedron

  // Triangulates `points` (Hilbert/BRIO order inside; vertex numbers stay those of `points`).
  // Exact duplicates get no tetrahedron: vertex_tet() of the later one is -1.
  // Throws Failure("kernel", "degenerate_points") when all points are coplanar, Failure("kernel",
  // "not_finite") when a coordinate is NaN or infinite, "too_many_points" above some 75 million.
  // When the last round has `parallel_from` points or more, it is inserted in parts, which several threads
  // can share, and so are the rounds before it down to an eighth of that; the numbers of the tetrahedra
  // depend on this limit, but never on the number of threads (tests lower it).
  Triangulation(std::span<const Vec3> points, Context& context, Index parallel_from = 1500000);
  explicit Triangulation(std::span<const Vec3> points);  // on one thread, to the end

  Index vertex_count() const { return static_cast<Index>(points_.size()); }
  const Vec3& point(Index vertex) const { return points_[vertex]; }
  const std::vector<Vec3>& points() const { return points_; }
  // Slots, free ones included: 0 .. slot_count() - 1.
  Index slot_count() const { return slots_.next; }
  // Tetrahedra, ghosts included.
  Index tet_count() const { return slots_.next - static_cast<Index>(slots_.free.size()); }
  bool is_free(Index tet) const { return corners_[tet][0] == free_slot; }
  bool is_ghost(Index tet) const { return corners_[tet][3] == ghost; }
  const Tet& corners(Index tet) const { return corners_[tet]; }
  // Face of the neighbour that touches face i of tet; the neighbour itself is that / 4.
  Face neighbour(Index tet, int i) const { return neighbours_[tet][i]; }
  // Some tetrahedron (perhaps a ghost) at the vertex.
  Index vertex_tet(Index vertex) const { return vertex_tet_[vertex]; }

  // The arrays, handed over; the triangulation is used up.
  struct Arrays {
    std::vector<Vec3> points;
    Array<Tet> corners;
    Array<std::array<Face, 4>> neighbours;
    Array<std::uint16_t> tags;
    Index slot_count;  // the arrays may be longer
  };
  Arrays release() &&;

  // Hints that the tetrahedron, and its points if its corners have come already, will be read soon.
  void prefetch(Index tet) const { dm::prefetch(&corners_[tet]); }
  void prefetch_points(Index tet) const {
    for (const Index v : corners_[tet])
      if (v >= 0) dm::prefetch(&points_[v]);
  }

  // Room for this many vertices: growing step by step would hold some of them twice.
  void reserve_vertices(std::size_t count);

  // Memory held by all arrays.
  std::size_t bytes() const;

  std::uint16_t tag(Index tet) const { return tags_[tet]; }
  void set_tag(Index tet, std::uint16_t tag) { tags_[tet] = tag; }
  bool marked(Index tet, int i) const { return flags_[tet] >> i & 1; }
  unsigned marks(Index tet) const { return flags_[tet] & 15u; }
  void set_marked(Index tet, int i, bool on);  // one side only

  // Is p inside the (perturbed) circumsphere of tet?  A new vertex is perturbed as number vertex_count().
  bool in_conflict(Index tet, const Vec3& p) const;
  // Remembering walk; returns a tetrahedron in conflict with p (a ghost one if p is outside the hull), or -1
  // when p equals an existing vertex.
  Index locate(const Vec3& p, Index hint) const;

  // Fills the cavity of site p, starting from `start`, which must be in conflict with p (else, and so at
  // an existing vertex, the cavity is empty and nothing can be inserted).
  // stop_at_marks: gives up at the first marked face with both sides in conflict and returns it, else -1.
  Face find_cavity(const Vec3& p, Index start, bool stop_at_marks, Cavity& cavity) const;

  // Commits the site of the last find_cavity; returns the new vertex and fills cavity.created.
  Index insert(const Vec3& p, Cavity& cavity);

  // Every combinatorial and geometric invariant; throws Failure("kernel", ...) naming the first broken one.
  // `exact_delaunay`: also that no vertex opposite a face is inside the sphere (local test, which implies
  // all).
  void check(bool exact_delaunay = true) const;

 private:
  friend class TriangulationBuilder;
  friend class PartInsertion;
  static constexpr Index kLeft = -2;  // walk, search: a tetrahedron outside the region was met
  // flags_: bits 0-3 the marks, bits 4 and 5 the stamps of find_cavity, which leaves none behind.
  static constexpr std::uint8_t kMarks = 15, kInside = 16, kSeen = 32;
  static constexpr int kLocalCorners = 64;  // corners of a cavity that link() can number in its table

  bool conflict(Index tet, const Vec3& p, Index number) const;
  bool ghost_conflict(Index tet, const Vec3& p, Index number) const;
  bool finite_conflict(const Tet& tet, const Vec3& p, Index number) const;
  bool close_conflict(const Tet& tet, const Vec3& p, Index number) const;
  bool tie_conflict(const Tet& tet, const Vec3& p, Index number) const;
  template <class Region>
  Index walk(const Vec3& p, Index hint, const Region& region) const;
  template <bool kStopAtMarks, class Region>
  Face search(const Vec3& p, Index number, Index start, Cavity& cavity, const Region& region) const;
  void move_slot(Index from, Index to);
  void compact();
  std::size_t test(const Vec3& p, Index number, Cavity& cavity, std::size_t first, std::size_t end,
                   std::size_t inside) const;
  Face marked_inside(std::span<const Index> tets) const;
  void collect_border(Cavity& cavity) const;
  void reserve_slots(std::size_t wanted);
  void resize_slots(std::size_t size);
  void fill(Index vertex, Cavity& cavity, Slots& slots);
  int collect(Index vertex, Cavity& cavity);
  void link(Cavity& cavity);
  std::array<Face, 4>& place(const Cavity& cavity, std::size_t k);
  static std::array<std::uint8_t, 4> opposite_corners(const Tet& corners);
  void link_many(Cavity& cavity);
  void check_tetrahedron(Index tet) const;
  void check_vertices() const;
  void check_delaunay() const;
  Index number_of(Index vertex) const { return numbers_.empty() ? vertex : numbers_[vertex]; }

  std::vector<Vec3> points_;
  Array<Tet> corners_;
  Array<std::array<Face, 4>> neighbours_;
  Array<std::uint16_t> tags_;
  mutable Array<std::uint8_t> flags_;
  std::vector<Index> vertex_tet_;
  Slots slots_;
  SphereTests sphere_tests_ = sphere_tests();
  std::vector<Index> numbers_;  // while building: the caller's number of a vertex; afterwards empty
};

}  // namespace dm
