// Flips: other tetrahedra on the same points.
//
// Edge removal (Freitag, Ollivier-Gooch 1997; Shewchuk 2002): the ring of tetrahedra round an interior edge
// gives way to two tetrahedra per triangle of the best triangulation of the ring's polygon, found by dynamic
// programming (Klincsek 1980); 3-2 and 4-4 flips are its small cases.  Face removal: the 2-3 flip.
// Goal: the worst badness of the region falls, or its sum relative to an average element (the mean of the
// whole mesh rises, whatever the number of tetrahedra).
// Guard: keeps_angles() (quality.h).  Boundary triangles and solids stay; no interior triangle with all
// corners on one CAD face appears. Cost per tetrahedron tried: improve 2 us, improve_blunt 0.4 us.
#pragma once

#include "optimisation/edit_mesh.h"
#include "optimisation/fan.h"
#include "plc/geometry.h"

namespace dm {

enum class FlipGoal { worst, mean };

class Flipper {
 public:
  static constexpr int kMaxRing = 7;
  // A flip: the tetrahedra `before` give way to `after`.  None if before_count is 0.
  struct Plan {
    Index tet = -1;   // that it was made for
    double cost = 0;  // worst: the new worst badness; mean: the change of the sum
    int before_count = 0, after_count = 0;
    std::array<Index, kMaxRing> before;
    std::array<Tet, 2 * (kMaxRing - 2)> after;
  };
  explicit Flipper(EditMesh& mesh) : mesh_(mesh) {}

  // The best flip for the worst element that takes `tet` away, if any is allowed; false when there is none.
  bool improve(Index tet);
  // The same among the few candidates that succeed most: removal of one of the two edges with the largest
  // angles, up to five tetrahedra round it.  On refined Delaunay meshes nineteen flips of twenty.
  bool improve_blunt(Index tet, FlipGoal goal) { return !apply(plan_blunt(tet, goal)).empty(); }
  // Its two parts.  The first changes nothing, so several threads may plan with a Flipper each.
  Plan plan_blunt(Index tet, FlipGoal goal);
  std::span<const Index> apply(const Plan& plan);  // the new tetrahedra
  // Flip of a boundary edge inside one CAD face together with the tetrahedra round it, for the worst element.
  // The two triangles become the other two of their quadrilateral; on a curved face only if the new edge lies
  // as close to the face and the normals turn by less than 26 degrees.  A tetrahedron with both triangles,
  // between the two diagonals, leaves the mesh.
  bool improve_boundary(Index tet, const Geometry& geometry);

 private:
  struct Ring {
    Index a = -1, b = -1;  // the edge; the ring turns round a -> b by the right-hand rule
    int count = 0;
    std::array<Index, kMaxRing> corner,
        tet;  // tet[i] = (a, b, corner[i], corner[i + 1]); an open ring has one less
  };
  bool find_ring(Index tet, int ia, int ib, int longest, Ring& ring) const;
  bool find_open_ring(Index tet, int ia, int ib, Ring& ring) const;
  bool keeps_surface(const Ring& ring, const Geometry& geometry, std::array<Index, 2>& triangles,
                     std::array<Triangle, 2>& turned);
  bool flip_boundary_edge(Index tet, int ia, int ib, const Geometry& geometry);
  bool is_on_boundary(Index a, Index b);
  bool peel(Index tet, int ia, int ib, const Geometry& geometry);
  void start(FlipGoal goal, Plan& plan);
  void plan_edge_removal(Index tet, int ia, int ib, int longest, Plan& best);
  void plan_face_removal(Index tet, int face, Plan& best) const;
  double triangulate(const Ring& ring);
  void add_triangles(const Ring& ring, int i, int j, Plan& plan) const;
  // `boundary`: triangles that become part of the boundary.
  bool is_allowed(const Plan& plan, std::span<const Triangle> boundary = {}) const;

  EditMesh& mesh_;
  FlipGoal goal_ = FlipGoal::worst;
  Fan fan_;
  std::array<std::array<std::int8_t, kMaxRing>, kMaxRing> middle_{};
};

}  // namespace dm
