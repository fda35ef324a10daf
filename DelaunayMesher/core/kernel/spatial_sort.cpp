#include "kernel/spatial_sort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "base/random.h"

namespace dm {
namespace {

constexpr int kBits = kHilbertBits;
constexpr Index kSmallestRound = 1000;   // below this a finer split into rounds gains nothing
constexpr std::size_t kSmallGroup = 16;  // points in one cell of the curve that may stay in any order

struct Keyed {
  std::uint32_t code;
  Index point;
};

// Hamilton's form of the curve: a cell is entered at its corner `e` and crossed along axis `d`, 24 states.
struct Step {
  std::uint8_t next, digit;
};
constexpr unsigned rotate_left3(unsigned b, unsigned k) { return ((b << k % 3) | (b >> (3 - k % 3))) & 7; }
constexpr std::array<Step, 24 * 8> make_steps() {
  std::array<Step, 24 * 8> steps{};
  for (unsigned e = 0; e < 8; ++e)
    for (unsigned d = 0; d < 3; ++d)
      for (unsigned octant = 0; octant < 8; ++octant) {
        const unsigned gray = rotate_left3(octant ^ e, 3 - (d + 1) % 3);
        const unsigned digit = gray ^ (gray >> 1) ^ (gray >> 2);
        const unsigned even = digit == 0 ? 0 : (digit - 1) / 2 * 2;
        const unsigned entry = even ^ (even >> 1);
        const unsigned ones = digit == 0 ? 0 : std::countr_one(digit % 2 == 0 ? digit - 1 : digit);
        const unsigned next_e = e ^ rotate_left3(entry, d + 1), next_d = (d + ones + 1) % 3;
        steps[8 * (3 * e + d) + octant] = {static_cast<std::uint8_t>(3 * next_e + next_d),
                                           static_cast<std::uint8_t>(digit)};
      }
  return steps;
}
constexpr std::array<Step, 24 * 8> kSteps = make_steps();

struct Cube {
  Vec3 low;
  double side = 0;
};
// Of count > 0 points, the k-th of them at(k).
template <class At>
Cube bounding_cube(std::size_t count, const At& at) {
  Vec3 low = at(0), high = low;
  for (std::size_t k = 1; k < count; ++k) {
    const Vec3& p = at(k);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return {low, std::max({high.x - low.x, high.y - low.y, high.z - low.z})};
}

void set_codes(std::span<const Vec3> points, std::span<Keyed> keyed, const Cube& cube) {
  const double scale = cube.side > 1e-280 ? (1 << kBits) * (1 - 0x1.0p-40) / cube.side : 0;
  for (Keyed& k : keyed) {
    const Vec3 q = scale * (points[k.point] - cube.low);
    k.code = hilbert_code(static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y),
                          static_cast<std::uint32_t>(q.z));
  }
}

// Stable radix sort by code.
void sort_by_code(std::span<Keyed> keyed, std::vector<Keyed>& scratch) {
  constexpr int digit_bits = 10;
  constexpr std::uint32_t buckets = 1u << digit_bits;
  if (keyed.size() < buckets) {
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const Keyed& a, const Keyed& b) { return a.code < b.code; });
    return;
  }
  for (int shift = 0; shift < 3 * kBits; shift += digit_bits) {
    std::array<Index, buckets> at{};
    for (const Keyed& k : keyed) ++at[k.code >> shift & (buckets - 1)];
    Index sum = 0;
    for (Index& a : at) sum += std::exchange(a, sum);
    scratch.resize(keyed.size());
    for (const Keyed& k : keyed) scratch[at[k.code >> shift & (buckets - 1)]++] = k;
    std::copy(scratch.begin(), scratch.end(), keyed.begin());
  }
}

void sort_along_curve(std::span<const Vec3> points, std::span<Keyed> keyed, const Cube& cube,
                      std::vector<Keyed>& scratch) {
  set_codes(points, keyed, cube);
  sort_by_code(keyed, scratch);
  for (std::size_t i = 0, j; i < keyed.size(); i = j) {  // tight clusters: again at their own scale
    const std::uint32_t code = keyed[i].code;
    for (j = i + 1; j < keyed.size() && keyed[j].code == code;) ++j;
    if (j - i <= kSmallGroup) continue;
    const auto group = keyed.subspan(i, j - i);
    const Cube own =
        bounding_cube(group.size(), [&](std::size_t k) -> const Vec3& { return points[group[k].point]; });
    if (own.side > 0 && own.side < cube.side) sort_along_curve(points, group, own, scratch);
    for (Keyed& k : group) k.code = code;
  }
}

}  // namespace

std::uint32_t hilbert_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t code = 0;
  unsigned state = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    const unsigned octant = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2;
    const Step step = kSteps[8 * state + octant];
    code = code << 3 | step.digit;
    state = step.next;
  }
  return code;
}

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
  const Cube cube = bounding_cube(points.size(), [&](std::size_t k) -> const Vec3& { return points[k]; });
  for (auto& points_of_round : round) {
    sort_along_curve(points, points_of_round, cube, scratch);
    for (const Keyed& k : points_of_round) result.order.push_back(k.point), result.codes.push_back(k.code);
    result.rounds.push_back(static_cast<Index>(result.order.size()));
    points_of_round = {};
  }
  return result;
}

}  // namespace dm
