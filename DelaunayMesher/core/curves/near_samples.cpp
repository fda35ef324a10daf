#include "curves/near_samples.h"

#include <cmath>

#include "base/random.h"

namespace dm {

int NearSamples::octave(double reach) { return static_cast<int>(std::ceil(std::log2(reach))); }

std::uint64_t NearSamples::key(const Vec3& p, int level, int dx, int dy, int dz) {
  const double cube = std::exp2(level + 1);  // at least twice the reach: a ball meets at most eight
  const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cube)); };
  return Random(0, level, cell(p.x) + dx, cell(p.y) + dy, cell(p.z) + dz).next();
}

void NearSamples::add(const Vec3& point, double reach) {
  const int level = octave(reach);
  const double cube = std::exp2(level + 1);
  const auto side = [&](double x) { return x / cube - std::floor(x / cube) < 0.5 ? -1 : 1; };
  const Index number = static_cast<Index>(samples_.size());
  samples_.push_back({point, reach});
  for (int i = 0; i < 8; ++i)
    cubes_.emplace(
        key(point, level, i & 1 ? side(point.x) : 0, i & 2 ? side(point.y) : 0, i & 4 ? side(point.z) : 0),
        number);
}

}  // namespace dm
