// Samples of other curves near a curve: where two curves run closer together than their parts are long, the
// samples of one stand opposite those of the other.  Unmatched, the strip between them would have triangles
// so obtuse that their circumcircles reach far beyond it, and no Delaunay triangulation contains them.
//
// A hash of cubes, one size per octave of reach.  Cost: eight entries per sample, three look-ups per query.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/vec3.h"

namespace dm {

class NearSamples {
 public:
  struct Sample {
    Vec3 point;
    double reach;
  };

  // `reach`: mm round `point` within which queries find the sample.
  void add(const Vec3& point, double reach);
  const Sample& sample(Index i) const { return samples_[i]; }
  // Calls f(number) for the samples that may have p in their reach; reaches less than half or more than twice
  // `reach` can be missed.
  template <class F>
  void for_each_near(const Vec3& p, double reach, F f) const {
    const int middle = octave(reach);
    for (int level = middle - 1; level <= middle + 1; ++level) {
      const auto [low, high] = cubes_.equal_range(key(p, level, 0, 0, 0));
      for (auto it = low; it != high; ++it) f(it->second);
    }
  }

 private:
  static int octave(double reach);
  // The cube of p, or the one (dx, dy, dz) next to it.
  static std::uint64_t key(const Vec3& p, int level, int dx, int dy, int dz);

  std::vector<Sample> samples_;
  std::unordered_multimap<std::uint64_t, Index> cubes_;
};

}  // namespace dm
