#include "kernel/spatial_sort.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/hilbert_curve.h"
#include "base/random.h"

namespace dm {
namespace {

constexpr Index kSmallestRound = 1000;   // below this a finer split into rounds gains nothing
constexpr std::size_t kSmallGroup = 16;  // points in one cell of the curve that may stay in any order

struct Keyed {
  std::uint32_t code;
  Index point;
};

// Stable radix sort by code.
void sort_by_code(std::span<Keyed> keyed, std::vector<Keyed>& scratch) {
  constexpr int digit_bits = 10;
  constexpr std::uint32_t buckets = 1u << digit_bits;
  if (keyed.size() < buckets) {
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const Keyed& a, const Keyed& b) { return a.code < b.code; });
    return;
  }
  for (int shift = 0; shift < 3 * HilbertCurve::kBits; shift += digit_bits) {
    std::array<Index, buckets> at{};
    for (const Keyed& k : keyed) ++at[k.code >> shift & (buckets - 1)];
    Index sum = 0;
    for (Index& a : at) sum += std::exchange(a, sum);
    scratch.resize(keyed.size());
    for (const Keyed& k : keyed) scratch[at[k.code >> shift & (buckets - 1)]++] = k;
    std::copy(scratch.begin(), scratch.end(), keyed.begin());
  }
}

void sort_along_curve(std::span<const Vec3> points, std::span<Keyed> keyed, const HilbertCurve& curve,
                      std::vector<Keyed>& scratch) {
  for (Keyed& k : keyed) k.code = curve.code(points[k.point]);
  sort_by_code(keyed, scratch);
  for (std::size_t i = 0, j; i < keyed.size(); i = j) {  // tight clusters: again at their own scale
    const std::uint32_t code = keyed[i].code;
    for (j = i + 1; j < keyed.size() && keyed[j].code == code;) ++j;
    if (j - i <= kSmallGroup) continue;
    const auto group = keyed.subspan(i, j - i);
    const auto own = HilbertCurve::through(
        group.size(), [&](std::size_t k) -> const Vec3& { return points[group[k].point]; });
    if (own.side() > 0 && own.side() < curve.side()) sort_along_curve(points, group, own, scratch);
    for (Keyed& k : group) k.code = code;
  }
}

}  // namespace

InsertionOrder insertion_order(std::span<const Vec3> points) {
  const Index n = static_cast<Index>(points.size());
  // Every point draws its round: the last one with probability 7/8, the one before with 7/64, ...
  int rounds = 1;
  for (Index left = n; left > kSmallestRound; left /= 8) ++rounds;
  std::vector<std::vector<Keyed>> round(rounds);
  round.back().reserve(n - n / 9);
  for (Index i = 0; i < n; ++i) {
    std::uint64_t draw = Random(0x4252494f, i).next();
    int r = rounds - 1;
    while (r > 0 && (draw & 7) == 0) draw >>= 3, --r;
    round[r].push_back({0, i});
  }
  InsertionOrder result;
  result.rounds.push_back(0);
  if (n == 0) return result;
  result.order.reserve(n);
  result.codes.reserve(n);
  std::vector<Keyed> scratch;
  const auto curve =
      HilbertCurve::through(points.size(), [&](std::size_t k) -> const Vec3& { return points[k]; });
  for (auto& points_of_round : round) {
    sort_along_curve(points, points_of_round, curve, scratch);
    for (const Keyed& k : points_of_round) result.order.push_back(k.point), result.codes.push_back(k.code);
    result.rounds.push_back(static_cast<Index>(result.order.size()));
    points_of_round = {};
  }
  return result;
}

}  // namespace dm
