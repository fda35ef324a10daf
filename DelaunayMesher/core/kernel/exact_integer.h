// Signed integers of a fixed number of 64-bit limbs, for the exact stage of the predicates.
//
// Idea: all coordinates of one test are integers on a common grid, the power of two that divides them all.
// CAD coordinates need one limb (spread of about 2^9 between the smallest and the largest) or two, and
// a product of limbs is a single instruction: several times cheaper than expansions of doubles, and nothing
// can overflow or underflow.  Two's complement; every result has room for its value by construction.
#pragma once

#include <array>
#include <cstdint>

namespace dm {

template <int N>
struct ExactInteger {
  std::array<std::uint64_t, N> limb{};  // least significant first

  bool negative() const { return limb[N - 1] >> 63; }
  int sign() const {
    if (negative()) return -1;
    for (const std::uint64_t part : limb)
      if (part != 0) return 1;
    return 0;
  }
};

struct WideProduct {
  std::uint64_t low, high;
};

// a * b + c + d, which never overflows 128 bits.
inline WideProduct multiply_add(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
#ifdef __SIZEOF_INT128__
  __extension__ using Wide = unsigned __int128;
  const Wide wide = static_cast<Wide>(a) * b + c + d;
  return {static_cast<std::uint64_t>(wide), static_cast<std::uint64_t>(wide >> 64)};
#else
  constexpr std::uint64_t half = 0xffffffff;
  const std::uint64_t a0 = a & half, a1 = a >> 32, b0 = b & half, b1 = b >> 32;
  const std::uint64_t low = a0 * b0, mid = a1 * b0 + (low >> 32), mid2 = a0 * b1 + (mid & half);
  WideProduct r = {mid2 << 32 | (low & half), a1 * b1 + (mid >> 32) + (mid2 >> 32)};
  r.low += c;
  r.high += r.low < c;
  r.low += d;
  r.high += r.low < d;
  return r;
#endif
}

template <int N>
ExactInteger<N> operator+(const ExactInteger<N>& a, const ExactInteger<N>& b) {
  ExactInteger<N> r;
  std::uint64_t carry = 0;
  for (int i = 0; i < N; ++i) {
    const std::uint64_t sum = a.limb[i] + carry;
    r.limb[i] = sum + b.limb[i];
    carry = static_cast<std::uint64_t>(sum < carry) | static_cast<std::uint64_t>(r.limb[i] < sum);
  }
  return r;
}

// a - b * 2^(64 shift) in the limbs of a.
template <int N, int M>
void subtract(ExactInteger<N>& a, const ExactInteger<M>& b, int shift, std::uint64_t mask) {
  std::uint64_t borrow = 0;
  for (int i = 0; i < M; ++i) {
    const std::uint64_t x = a.limb[i + shift], y = b.limb[i] & mask, difference = x - y;
    a.limb[i + shift] = difference - borrow;
    borrow = static_cast<std::uint64_t>(x < y) | static_cast<std::uint64_t>(difference < borrow);
  }
}
template <int N>
ExactInteger<N> operator-(ExactInteger<N> a, const ExactInteger<N>& b) {
  subtract(a, b, 0, ~std::uint64_t{0});
  return a;
}

// As of unsigned numbers, then what the two's complement of a negative factor has added is taken away.
template <int N, int M>
ExactInteger<N + M> operator*(const ExactInteger<N>& a, const ExactInteger<M>& b) {
  ExactInteger<N + M> r;
  for (int i = 0; i < N; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < M; ++j) {
      const WideProduct p = multiply_add(a.limb[i], b.limb[j], r.limb[i + j], carry);
      r.limb[i + j] = p.low;
      carry = p.high;
    }
    r.limb[i + M] = carry;
  }
  subtract(r, b, N, -(a.limb[N - 1] >> 63));
  subtract(r, a, M, -(b.limb[M - 1] >> 63));
  return r;
}

}  // namespace dm
