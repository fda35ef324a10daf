// Edge contraction: a point goes to the other end of one of its edges and leaves the mesh.
//
// The star of the point becomes the cone from the other end over the star's faces; it is valid exactly when
// every new tetrahedron is positively oriented.  A point on a CAD face goes to another point on that face,
// one on a CAD edge along the edge, each with its boundary triangles: they turn by less than 26 degrees and
// lie as close to the CAD as the old ones, and breaks_link() is false.  No interior triangle with all corners
// on one CAD face appears.  Cost: some microseconds.
#pragma once

#include "optimisation/edit_mesh.h"
#include "plc/geometry.h"

namespace dm {

// Is something beside both ends that is not beside the edge between them?  Two edges or faces would become
// one, or the solid touch itself (link condition: Dey, Edelsbrunner, Guha, Nekhayev 1999).
bool breaks_link(EditMesh& mesh, Index from, Index to);

class Contractor {
 public:
  Contractor(EditMesh& mesh, const Geometry& geometry) : mesh_(mesh), geometry_(geometry) {}

  // Contracts the edge of `tet` that leaves the best worst element, if the guard of flips allows any.  Only
  // interior points leave.
  bool collapse_best(Index tet);
  // The point `from` goes to `to`, whatever the angles are.
  bool contract(Index from, Index to);

 private:
  struct Plan {
    double worst = kInverted;
    std::vector<Index> before, solids;
    std::vector<Tet> after;
    AngleCosines old_angles, new_angles;
  };
  bool plan(Index from, Index to, double worst, Plan& plan);
  bool makes_forbidden_face(const Plan& plan, Index to) const;
  bool plan_boundary(Index from, Index to);
  bool list_triangles(Index from);
  bool keeps_surface(Index from, Index to);
  bool stays_close(Index face, Index from, Index to) const;
  void apply(const Plan& plan);

  EditMesh& mesh_;
  const Geometry& geometry_;
  std::vector<Index> triangles_;    // of the boundary at the point
  std::vector<Triangle> turned_;    // what they become; corners -1: nothing
  std::vector<Triangle> boundary_;  // those that stay
  std::vector<Index> segments_;     // at the point: the one that vanishes, the one that follows it
};

}  // namespace dm
