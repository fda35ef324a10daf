// Flips: other tetrahedra on the same points.
//
// Edge removal (Freitag, Ollivier-Gooch 1997; Shewchuk 2002): the ring of tetrahedra round an interior edge
// gives way to two tetrahedra per triangle of the best triangulation of the ring's polygon, found by dynamic
// programming (Klincsek 1980); 3-2 and 4-4 flips are its small cases.  Face removal: the 2-3 flip.
// Guard: the worst badness of the region falls and keeps_angles() (quality.h) holds.  Boundary triangles and
// solids stay; no interior triangle with all corners on one CAD face appears. Cost per tetrahedron tried:
// improve 2 us, improve_blunt 0.3 us.
#pragma once

#include "optimisation/edit_mesh.h"
#include "optimisation/fan.h"

namespace dm {

class Flipper {
 public:
  static constexpr int kMaxRing = 7;
  explicit Flipper(EditMesh& mesh) : mesh_(mesh) {}

  // The best flip that takes `tet` away, if any is allowed.  Returns the new tetrahedra, empty if none.
  std::span<const Index> improve(Index tet);
  // The same among the few candidates that succeed most: removal of one of the two edges with the largest
  // angles, three or four tetrahedra round it.  On refined Delaunay meshes nineteen flips of twenty.
  std::span<const Index> improve_blunt(Index tet);

 private:
  struct Ring {
    Index a, b;  // the edge; the ring turns round a -> b by the right-hand rule
    int count = 0;
    std::array<Index, kMaxRing> corner, tet;  // tet[i] = (a, b, corner[i], corner[i + 1])
  };
  struct Plan {
    double worst = kInverted;
    int before_count = 0, after_count = 0;
    std::array<Index, kMaxRing> before;
    std::array<Tet, 2 * (kMaxRing - 2)> after;
  };
  bool find_ring(Index tet, int ia, int ib, int longest, Ring& ring) const;
  void plan_edge_removal(Index tet, int ia, int ib, int longest, Plan& best);
  void plan_face_removal(Index tet, int face, Plan& best) const;
  bool triangulate(const Ring& ring, double bound, Plan& plan);
  void add_triangles(const Ring& ring, int i, int j, Plan& plan) const;
  bool is_allowed(const Plan& plan) const;
  std::span<const Index> apply(const Plan& plan);

  EditMesh& mesh_;
  Fan fan_;
  std::array<std::array<std::int8_t, kMaxRing>, kMaxRing> middle_{};
};

}  // namespace dm
