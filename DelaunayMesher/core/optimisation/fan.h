// A fan: triangles that form tetrahedra with one common apex, stored by coordinate so that the badness of
// all of them for a trial apex is one vectorised loop.  Smoothing evaluates the star of a vertex with it and
// edge removal all candidate tetrahedra at one end of the edge: most of the time of the stage is spent here.
//
// The same IEEE operations are done whatever the vector width, so the result does not depend on the machine.
// Cost: about 5 ns per triangle and apex.
#pragma once

#include "optimisation/quality.h"

namespace dm {

struct Fan {
  static constexpr int kCapacity = 128;
  int count = 0;
  double corner[9][kCapacity];  // x, y, z of the three base corners

  void clear() { count = 0; }
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

struct FanScore {
  double sum = 0;  // of badness^p
  AngleCosines extremes;
};

// bad[k] = badness of (base k, apex); side -1: of (base k turned over, apex).
void fan_badness(const Fan& fan, const Vec3& apex, double side, double* bad);

// The same, and the sum of their powers p = 2 (soft) or 16 and the extreme angles.  A tetrahedron without
// positive volume counts as flat: {1, -1}.
FanScore fan_score(const Fan& fan, const Vec3& apex, bool soft, double* bad);

}  // namespace dm
