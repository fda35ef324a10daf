// Exact arithmetic on sums of non-overlapping doubles, smallest first (Shewchuk 1997, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates").
//
// Precondition: plain IEEE double arithmetic, round to nearest, no contraction; no overflow (products below
// 2^996) and no underflow of the last bits.  Capacities are template arguments, so nothing is allocated.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

namespace dm {

struct TwoDoubles {
  double high, low;  // the exact value is high + low, |low| <= ulp(high) / 2
};

inline TwoDoubles two_sum(double a, double b) {
  const double s = a + b, bv = s - a;
  return {s, (a - (s - bv)) + (b - bv)};
}
// Needs |a| >= |b| or a == 0.
inline TwoDoubles fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
inline TwoDoubles two_diff(double a, double b) { return two_sum(a, -b); }
inline TwoDoubles split(double a) {
  const double c = 134217729.0 * a, high = c - (c - a);  // 2^27 + 1: two halves of 26 bits
  return {high, a - high};
}
inline TwoDoubles two_product(double a, double b) {
  const double p = a * b;
  const auto [ah, al] = split(a);
  const auto [bh, bl] = split(b);
  return {p, al * bl - (((p - ah * bh) - al * bh) - ah * bl)};
}

// h = e + f without zero components; h must not alias.  Returns the length, at least 0.
inline int sum_expansions(const double* e, int en, const double* f, int fn, double* h) {
  int i = 0, j = 0, n = 0;
  if (en + fn == 0) return 0;
  // Merge by magnitude; q carries the running sum, every round-off that is not zero is a component.
  const auto next = [&] {
    return j >= fn || (i < en && std::fabs(e[i]) < std::fabs(f[j])) ? e[i++] : f[j++];
  };
  double q = next();
  while (i < en || j < fn) {
    const auto [s, r] = two_sum(q, next());
    if (r != 0) h[n++] = r;
    q = s;
  }
  if (q != 0) h[n++] = q;
  return n;
}

// h = b * e without zero components; h must not alias.
inline int scale_expansion(const double* e, int en, double b, double* h) {
  int n = 0;
  double q = 0;
  for (int i = 0; i < en; ++i) {
    const auto [p, tail] = two_product(e[i], b);
    const auto [s, r] = two_sum(q, tail);
    if (r != 0) h[n++] = r;
    const auto [t, u] = fast_two_sum(p, s);
    if (u != 0) h[n++] = u;
    q = t;
  }
  if (q != 0) h[n++] = q;
  return n;
}

template <int N>
struct Expansion {
  int size;
  double term[N];  // deliberately not initialised: only the first `size` are used

  Expansion() : size(0) {}
  Expansion(const Expansion& other) { *this = other; }
  Expansion& operator=(const Expansion& other) {
    size = other.size;
    std::copy_n(other.term, size, term);
    return *this;
  }
  void negate() {
    for (int i = 0; i < size; ++i) term[i] = -term[i];
  }
  int sign() const { return size == 0 ? 0 : term[size - 1] > 0 ? 1 : -1; }
};

// r = a + b and r = a * b, for results that are too large to hand over by value.
template <int N, int M>
void add(const Expansion<N>& a, const Expansion<M>& b, Expansion<N + M>& r) {
  r.size = sum_expansions(a.term, a.size, b.term, b.size, r.term);
}
template <int N, int M>
void multiply(const Expansion<N>& a, const Expansion<M>& b, Expansion<2 * N * M>& r) {
  const auto old = std::make_unique_for_overwrite<double[]>(2 * N * (M - 1) + 1);
  double row[2 * N];
  r.size = 0;
  for (int j = 0; j < b.size; ++j) {
    const int n = scale_expansion(a.term, a.size, b.term[j], row);
    std::copy_n(r.term, r.size, old.get());
    r.size = sum_expansions(old.get(), r.size, row, n, r.term);
  }
}
template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<N + M> r;
  add(a, b, r);
  return r;
}
template <int N, int M>
Expansion<N + M> operator-(const Expansion<N>& a, Expansion<M> b) {
  b.negate();
  return a + b;
}
// For short results; the longer factor should come second.
template <int N, int M>
Expansion<2 * N * M> operator*(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> r, old;
  double row[2 * M];
  for (int i = 0; i < a.size; ++i) {
    const int n = scale_expansion(b.term, b.size, a.term[i], row);
    old = r;
    r.size = sum_expansions(old.term, old.size, row, n, r.term);
  }
  return r;
}

// a - b exactly; N = 1 is for callers that know the difference to be a double.
template <int N>
Expansion<N> difference(double a, double b) {
  Expansion<N> r;
  const auto [high, low] = two_diff(a, b);
  if constexpr (N == 2)
    if (low != 0) r.term[r.size++] = low;
  if (high != 0) r.term[r.size++] = high;
  return r;
}

}  // namespace dm
