// The limit of elements, looked at where more becomes known: the sizes, the boundary, the tetrahedra.
//
// Idea: what the sizes ask for is a forecast; narrow faces and short edges need more.  A boundary of B
// triangles (those between two solids counted twice) cannot have fewer than B / 2 tetrahedra inside, less one
// for each solid (Euler), nor does a mesh of good elements come near: thin plates have 1.7 B.  Between that
// and the truth only counting helps.  All throw Failure(..., "too_many_elements").
#pragma once

#include <cstdint>

#include "kernel/triangulation.h"
#include "sizing/size_field.h"
#include "surfaces/surface_mesh.h"

namespace dm {

struct ElementLimit {
  std::int64_t most = 0;    // 0 = no limit
  std::int64_t before = 0;  // elements made of other pieces of the part: they count, too
};

void refuse_sizes(const ElementLimit& limit, const SizeField& size);
void refuse_boundary(const ElementLimit& limit, const SurfaceMesh& surface, const Plc& plc);

// Counts the tagged tetrahedra of a triangulation that grows, seldom: they cannot be more than it has in all.
class ElementCount {
 public:
  ElementCount(const Triangulation& tets, const ElementLimit& limit);
  // To be called after every few insertions.
  void check() {
    if (limit_.most > 0 && tets_.tet_count() >= next_) count();
  }

 private:
  void count();

  const Triangulation& tets_;
  const ElementLimit limit_;
  const std::int64_t most_;
  std::int64_t next_;  // size of the triangulation from which on it is worth counting
};

}  // namespace dm
