#include "kernel/spatial_sort.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/random.h"

namespace dm {
namespace {

constexpr int kBits = 21;
constexpr Index kSmallestRound = 1000;  // below this a finer split into rounds gains nothing
constexpr Index kSmallGroup = 16;       // points in one cell of the curve that may stay in any order

struct Keyed {
  std::uint64_t code;
  Index point;
};

// The next 3 bits of the position for every state and octant, by following Skilling's transform one level.
// Bit 0..2 of an octant are x, y, z.
std::uint64_t skilling(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1u << (kBits - 1); q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (auto& xi : x) {
      if (xi & q) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ xi) & p;
        x[0] ^= t, xi ^= t;
      }
    }
  }
  x[1] ^= x[0], x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1u << (kBits - 1); q > 1; q >>= 1)
    if (x[2] & q) t ^= q - 1;
  std::uint64_t code = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (const auto xi : x) code = code << 1 | ((xi ^ t) >> bit & 1);
  return code;
}

// Codes within the bounding cube of these points.
void set_codes(std::span<const Vec3> points, std::span<Keyed> keyed) {
  Vec3 low = points[keyed[0].point], high = low;
  for (const Keyed& k : keyed)
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], points[k.point][i]);
      high[i] = std::max(high[i], points[k.point][i]);
    }
  const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  const double scale = side > 0 ? ((1 << kBits) - 1) / side : 0;
  for (Keyed& k : keyed) {
    const Vec3 q = scale * (points[k.point] - low);
    k.code = hilbert_code(static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y),
                          static_cast<std::uint32_t>(q.z));
  }
}

void sort_along_curve(std::span<const Vec3> points, std::span<Keyed> keyed) {
  if (keyed.size() < 2) return;
  set_codes(points, keyed);
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return std::pair(a.code, a.point) < std::pair(b.code, b.point);
  });
  if (keyed.front().code == keyed.back().code) return;
  for (std::size_t i = 0, j; i < keyed.size(); i = j) {  // tight clusters: again at their own scale
    for (j = i + 1; j < keyed.size() && keyed[j].code == keyed[i].code;) ++j;
    if (j - i > kSmallGroup) sort_along_curve(points, keyed.subspan(i, j - i));
  }
}

}  // namespace

std::uint64_t hilbert_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) { return skilling({x, y, z}); }

InsertionOrder insertion_order(std::span<const Vec3> points) {
  const Index n = static_cast<Index>(points.size());
  // Every point draws its round: the last one with probability 7/8, the one before with 7/64, ...
  int rounds = 1;
  for (Index left = n; left > kSmallestRound; left /= 8) ++rounds;
  std::vector<std::vector<Keyed>> round(rounds);
  for (Index i = 0; i < n; ++i) {
    std::uint64_t draw = Random(0x42524930, i).next();
    int r = rounds - 1;
    while (r > 0 && (draw & 7) == 0) draw >>= 3, --r;
    round[r].push_back({0, i});
  }
  InsertionOrder result;
  result.order.reserve(n);
  for (auto& points_of_round : round) {
    result.rounds.push_back(static_cast<Index>(result.order.size()));
    sort_along_curve(points, points_of_round);
    for (const Keyed& k : points_of_round) result.order.push_back(k.point);
  }
  result.rounds.push_back(n);
  return result;
}

}  // namespace dm
