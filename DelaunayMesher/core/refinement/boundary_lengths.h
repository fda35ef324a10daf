// The edge length wanted inside, where the surface mesh is finer than the size field.
//
// Idea: the surface stage makes elements smaller than asked for where the CAD is narrow: at tips, between
// curves that nearly touch, at short CAD edges.  The size field knows nothing of that, and tetrahedra of its
// size would stand flat on small triangles: no site between them keeps its distance from the vertices.  So
// vertices whose edges are much shorter become caps of a length field, which grows from there.
// Cost: linear in the surface mesh.
#pragma once

#include "boundary/recovery.h"
#include "curves/length_field.h"

namespace dm {

// In terms of the size field's h, not of the edges of the surface mesh (kBoundaryEdge).
LengthField lengths_inside(const LabelledTriangulation& mesh, const SizeField& size);

}  // namespace dm
