// The triangulation with the labelled boundary in it: what boundary recovery makes and refinement works on.
//
// A label stands on a face of the triangulation, marked on both sides; a tetrahedron's tag is its solid (0 =
// outside).  Looking for a face or an edge is a search of the star of one of its corners.
#pragma once

#include "boundary/complex.h"
#include "kernel/triangulation.h"

namespace dm {

// A Delaunay triangulation with the labelled boundary in it; vertex numbers are common to both.
struct LabelledTriangulation {
  Triangulation tets;
  BoundaryComplex boundary;
};

// Face of the triangulation with corners a, b, c, or -1.
Face find_face(const Triangulation& tets, Index a, Index b, Index c);

// Is (a, b) an edge of the triangulation?
bool has_edge(const Triangulation& tets, Index a, Index b);

// The label of face i of tet, which must be a face between boundary points; -1 when it has none.
Index label_of(const LabelledTriangulation& mesh, Index tet, int i);

// Marks or unmarks the face `f` on both of its sides.
void set_marked_both(Triangulation& tets, Face f, bool on);

// Does corner i of tet lie in front of (right-hand normal) its opposite face as `t` orders the corners?
bool corner_in_front(const Tet& tet, int i, const Triangle& t);

// Gives every tetrahedron the solid it lies in, by flooding from labelled faces.  False when the two sides of
// the boundary are not separated.
bool tag_solids(LabelledTriangulation& mesh);

// Every invariant of the postcondition; throws Failure("boundary", ...).
void check_boundary(const LabelledTriangulation& mesh);

}  // namespace dm
