// Pairs of doubles as numbers of about 106 bits: the second stage of the predicates.
//
// Source: Joldes, Muller, Popescu 2017, "Tight and rigorous error bounds for basic building blocks of
// double-word arithmetic": with u = 2^-53 the sum is good to 3 u^2 + 13 u^3, the product to 7 u^2, relative
// to the result.
#pragma once

#include "kernel/expansion.h"

namespace dm {

struct DoubleDouble {
  double high = 0, low = 0;
};

inline DoubleDouble exact_difference(double a, double b) {
  const auto [high, low] = two_diff(a, b);
  return {high, low};
}
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const auto [sh, sl] = two_sum(a.high, b.high);
  const auto [th, tl] = two_sum(a.low, b.low);
  const auto [vh, vl] = fast_two_sum(sh, sl + th);
  const auto [high, low] = fast_two_sum(vh, tl + vl);
  return {high, low};
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + DoubleDouble{-b.high, -b.low};
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const auto [ph, pl] = two_product(a.high, b.high);
  const auto [high, low] = fast_two_sum(ph, pl + (a.high * b.low + a.low * b.high));
  return {high, low};
}

}  // namespace dm
