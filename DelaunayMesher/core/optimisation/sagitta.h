// How new boundary triangles lie beside those that they replace: their edges no farther from the CAD face,
// their normals in nearly the same direction.
//
// Of a sagitta, the distance of an edge's middle from the face, only whether it is large enough matters: the
// longest old edge nearly always answers for all of them.  A projection on a spline takes some microseconds,
// most of what a change of the boundary costs.
#pragma once

#include <span>

#include "optimisation/edit_mesh.h"
#include "plc/geometry.h"

namespace dm {

// Is none of the middles of new edges more than 1.2 times as far from the face as the farthest old edge?
bool lies_as_close(const EditMesh& mesh, const Geometry& geometry, Index face, std::span<const Vec3> middles,
                   std::span<Segment> old_edges);

// Is the second normal, whatever its length, within 26 degrees of the first one?
inline bool turns_little(const Vec3& before, const Vec3& after) {
  constexpr double kNormalTurn = 0.9;
  return !(dot(normalized(before), normalized(after)) < kNormalTurn);
}

}  // namespace dm
