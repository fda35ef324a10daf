// The refinement stage: Chew's algorithm (1997) with graded density and a dihedral-angle test.
//
// Idea: a tetrahedron is bad when its circumradius exceeds rho(x) = 0.72 h(x) at its circumcentre; one with
// good angles may exceed it by 15 %.  Its site is a random point in the ball of radius f_k R round the
// circumcentre, f_k growing with the try k; the site is taken when every new tetrahedron that is small enough
// to stay has all dihedral angles above the target.  A site whose cavity would swallow a labelled boundary
// triangle is refused; when that goes on, the triangle is split at a random point near its circumcentre on
// the exact CAD surface.  Slivers that are left over are bad tetrahedra of later rounds.  The first round
// runs in the order of a space-filling curve.  Rules R1 to R3 (docs/refinement.md): tetrahedra on labelled
// faces are tested whatever their radius; a tetrahedron with two labelled faces of one CAD face belongs to
// the side where its circumcentre lies. Source: Chew, Guaranteed-Quality Delaunay Meshing in 3D (1997).
// Precondition: check_boundary holds. Postcondition: it still holds and the triangulation is Delaunay but for
// the constrained sites; the tetrahedra that are bad still are those that no site was found for. Cost: 1.5 to
// 3 proposals per site at 20 degrees.  Termination: docs/guarantees.md.
#pragma once

#include "base/context.h"
#include "boundary/recovery.h"
#include "refinement/element_limit.h"

namespace dm {

struct RefineOptions {
  double target_angle = 20;  // degrees
  int sliver_rounds = 8;
  ElementLimit limit;
};

struct RefineReport {
  std::int64_t sites = 0, tries = 0, relaxed = 0;
  std::int64_t constrained = 0;  // sites whose cavity stopped at the boundary: not Delaunay across it
  std::int64_t encroached = 0, triangle_splits = 0, segment_splits = 0, flips = 0, slivers = 0;
};

// Throws Failure("refinement", "too_many_elements").
void refine(LabelledTriangulation& mesh, const Geometry& geometry, const SizeField& size,
            const RefineOptions& options, Context& context, RefineReport& report);

// Marks the segments at which the solids' own dihedral angle is below `angle` degrees: no mesh can do better
// there.
void mark_acute_segments(LabelledTriangulation& mesh, double angle);

}  // namespace dm
