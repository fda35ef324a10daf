// Counter-based random numbers: the stream is a pure function of its key, so a result never depends on the
// order of work or on the number of threads.  Mixing: SplitMix64 (Steele, Lea, Flood 2014).
#pragma once

#include <cstdint>

#include "base/vec3.h"

namespace dm {

class Random {
 public:
  template <class... Key>
  explicit Random(std::uint64_t seed, Key... key) : state_(mix(seed)) {
    ((state_ = mix(state_ ^ static_cast<std::uint64_t>(key))), ...);
  }
  std::uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15ULL); }
  // Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  // Uniform in [-1, 1).
  double symmetric() { return 2 * uniform() - 1; }
  // Uniform in the unit ball.
  Vec3 in_ball() {
    for (;;) {
      const Vec3 p{symmetric(), symmetric(), symmetric()};
      if (norm2(p) <= 1) return p;
    }
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace dm
