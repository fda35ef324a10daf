// A fan: triangles that form tetrahedra with one common apex, stored by coordinate so that the badness of
// all of them for a trial apex is one vectorised loop.  Smoothing evaluates the star of a vertex with it and
// edge removal all candidate tetrahedra at one end of the edge: most of the time of the stage is spent here.
//
// Single precision, relative to an origin close by: twice as fast, and angles need no more.  A tetrahedron
// within a quarter of a degree of flat counts as flat, so rounding cannot hide an inversion. The same IEEE
// operations are done whatever the vector width, so the result does not depend on the machine. Cost: about 3
// ns per triangle and apex.
#pragma once

#include "optimisation/quality.h"

namespace dm {

struct Fan {
  static constexpr int kCapacity = 128;
  int count = 0;
  Vec3 origin;
  float corner[9][kCapacity];  // x, y, z of the three base corners, from the origin

  void start(const Vec3& at) {
    origin = at;
    count = 0;
  }
  // With the apex x, (a, b, c, x) is to be positively oriented.
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int i = 0; i < 3; ++i) {
      corner[i][count] = static_cast<float>(a[i] - origin[i]);
      corner[3 + i][count] = static_cast<float>(b[i] - origin[i]);
      corner[6 + i][count] = static_cast<float>(c[i] - origin[i]);
    }
    ++count;
  }
  // To be called when all are in: fills the last group of eight with copies.
  void close() {
    for (int k = count; k < padded(); ++k)
      for (auto& row : corner) row[k] = row[0];
  }
  int padded() const { return (count + 7) & ~7; }
};

struct FanScore {
  double sum = 0;  // of badness^p
  AngleCosines extremes;
};

// Precondition of both: the fan is closed.  `bad` has room for kCapacity values.
// bad[k] = badness of (base k, apex); side -1: of (base k turned over, apex).
void fan_badness(const Fan& fan, const Vec3& apex, float side, float* bad);

// The same, and the sum of their powers p = 2 (soft, large angles counting less) or 16 and the extreme
// angles.  A tetrahedron without positive volume counts as flat: {1, -1}.
FanScore fan_score(const Fan& fan, const Vec3& apex, bool soft, float* bad);

}  // namespace dm
