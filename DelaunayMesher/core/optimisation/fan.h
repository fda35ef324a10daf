// A fan: triangles that form tetrahedra with one common apex, stored by coordinate so that the badness of
// all of them for a trial apex is one vectorised loop.  Smoothing evaluates the star of a vertex with it and
// edge removal all candidate tetrahedra at one end of the edge: nearly all the time of the stage is spent
// here.
//
// The same IEEE operations are done whatever the vector width, so the result does not depend on the machine.
#pragma once

#include "optimisation/quality.h"

namespace dm {

struct Fan {
  static constexpr int kCapacity = 128;
  int count = 0;
  double corner[9][kCapacity];  // x, y, z of the three base corners

  void clear() { count = 0; }
  bool full() const { return count == kCapacity; }
  // With the apex x, (a, b, c, x) is to be positively oriented.
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int i = 0; i < 3; ++i) {
      corner[i][count] = a[i];
      corner[3 + i][count] = b[i];
      corner[6 + i][count] = c[i];
    }
    ++count;
  }
};

// bad[k] = badness of (base k, apex); side -1: of (base k turned over, apex).  Cost: about 8 ns per triangle.
void fan_badness(const Fan& fan, const Vec3& apex, double side, double* bad);

}  // namespace dm
