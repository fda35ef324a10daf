// Which tetrahedra a thread may touch while several of them insert points.
//
// Idea (Marot, Pellerin, Remacle 2019): every vertex belongs to one part; a thread inserts the points of its
// part, and only where all tetrahedra in conflict have all their corners in it.  What it reads beyond those
// are neighbours that share a face with them, and such a tetrahedron of mixed corners is changed by nobody,
// so threads need no locks and every part's result is the same whoever runs first.
#pragma once

#include <cstdint>

#include "base/vec3.h"

namespace dm {

struct Part {
  const std::uint8_t* part_of;  // by vertex
  std::uint8_t part;

  bool operator()(const Tet& c) const {
    return part_of[c[0]] == part && part_of[c[1]] == part && part_of[c[2]] == part &&
           (c[3] < 0 || part_of[c[3]] == part);
  }
};

struct Everywhere {
  constexpr bool operator()(const Tet&) const { return true; }
};

}  // namespace dm
