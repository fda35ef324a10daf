// Necks between edges: material that is narrow only from one reflex edge to another, as where a cylinder is
// let a little into a plane.  Walls are measured from face to face (proximity.h); no ray along a normal sees
// these.
//
// From places along every CAD edge round which the material takes more than half of the turn, the nearest
// place of another such edge is looked for, to which the way goes through the material.  Edges that share a
// vertex make no neck: there the width goes to zero.  Postcondition: the necks of an edge do not overlap, and
// are no longer than two of their widths, or the shortest.  Cost: a search in a tree for each place; places
// are two widths apart, or a local size.  Known limits: an edge that comes near to itself, and edges with
// more than two faces, are not seen.
#pragma once

#include "plc/plc.h"

namespace dm {

struct EdgeNeck {
  Vec3 a, b;                 // part of an edge
  Index face;                // one of the two at the edge
  double width, local_size;  // mm
};

// Necks not wider than the local size.  triangle_size: size on each triangle by other sources, mm.  shortest:
// parts of edges are not cut below this length, mm.
std::vector<EdgeNeck> find_edge_necks(const Plc& plc, const std::vector<double>& triangle_size,
                                      double shortest, Context& context);

}  // namespace dm
