#include "base/hilbert_curve.h"

#include <array>
#include <bit>

namespace dm {
namespace {

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

}  // namespace

std::uint32_t HilbertCurve::code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
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

}  // namespace dm
