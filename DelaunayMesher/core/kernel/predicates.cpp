#include "kernel/predicates.h"

#include <array>
#include <memory>

#include "kernel/double_double.h"
#include "kernel/expansion.h"

namespace dm {

PredicateCounters& predicate_counters() {
  thread_local PredicateCounters counters;
  return counters;
}

namespace {

// The coordinates of a - e in any of the number types below.
template <class Number>
struct Offset {
  Number x, y, z;
};

Offset<DoubleDouble> double_double_offset(const Vec3& a, const Vec3& e) {
  return {exact_difference(a.x, e.x), exact_difference(a.y, e.y), exact_difference(a.z, e.z)};
}
// N = 1 when the differences are doubles, 2 in general.
template <int N>
Offset<Expansion<N>> expansion_offset(const Vec3& a, const Vec3& e) {
  return {difference<N>(a.x, e.x), difference<N>(a.y, e.y), difference<N>(a.z, e.z)};
}
bool short_differences(std::initializer_list<const Vec3*> points, const Vec3& e) {
  for (const Vec3* a : points)
    if (two_diff(a->x, e.x).low != 0 || two_diff(a->y, e.y).low != 0 || two_diff(a->z, e.z).low != 0)
      return false;
  return true;
}

template <class Number>
auto minor_xy(const Offset<Number>& a, const Offset<Number>& b) {
  return a.x * b.y - a.y * b.x;
}
template <class Number>
auto square(const Offset<Number>& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}
// det of the rows a, b, c.
template <class Number>
auto triple(const Offset<Number>& a, const Offset<Number>& b, const Offset<Number>& c) {
  return a.z * minor_xy(b, c) - b.z * minor_xy(a, c) + c.z * minor_xy(a, b);
}

// Largest squared distance, for the error bounds.
double largest_square(std::initializer_list<const Vec3*> points, const Vec3& e) {
  double largest = 0;
  for (const Vec3* a : points) largest = std::max(largest, norm2(*a - e));
  return largest;
}

// docs/kernel.md: 23 u^2 * 1.155 r^3 and 49 u^2 * 4 * 1.155 r^5, rounded up.
constexpr double kUnit2 = filter::kUnit * filter::kUnit;
constexpr double kTriple2 = 28 * kUnit2, kInsphere2 = 240 * kUnit2;

template <int N>
int orient3d_expansion(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return -triple(expansion_offset<N>(a, d), expansion_offset<N>(b, d), expansion_offset<N>(c, d)).sign();
}

template <int N>
int insphere_expansion(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  const auto A = expansion_offset<N>(a, e), B = expansion_offset<N>(b, e);
  const auto C = expansion_offset<N>(c, e), D = expansion_offset<N>(d, e);
  using Term = decltype(square(A) * triple(B, C, D));
  struct Work {  // on the heap: near a megabyte for N = 2
    Term term[4];
    decltype(term[0] + term[1]) half[2];
    decltype(half[0] + half[1]) sum;
  };
  const std::unique_ptr<Work> w(new Work);
  multiply(square(A), triple(B, C, D), w->term[0]);
  multiply(square(B), triple(A, C, D), w->term[1]);
  multiply(square(C), triple(A, B, D), w->term[2]);
  multiply(square(D), triple(A, B, C), w->term[3]);
  w->term[1].negate();
  w->term[3].negate();
  add(w->term[0], w->term[1], w->half[0]);
  add(w->term[2], w->term[3], w->half[1]);
  add(w->half[0], w->half[1], w->sum);
  return w->sum.sign();
}

}  // namespace

int filter::orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  ++predicate_counters().orient_exact;
  const double volume =
      triple(double_double_offset(a, d), double_double_offset(b, d), double_double_offset(c, d)).high;
  const double largest = largest_square({&a, &b, &c}, d);
  if (volume * volume > kTriple2 * kTriple2 * (largest * largest * largest) + kTiny)
    return volume > 0 ? -1 : 1;
  if (short_differences({&a, &b, &c}, d)) return orient3d_expansion<1>(a, b, c, d);
  return orient3d_expansion<2>(a, b, c, d);
}

int filter::insphere_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  ++predicate_counters().insphere_exact;
  const auto A = double_double_offset(a, e), B = double_double_offset(b, e);
  const auto C = double_double_offset(c, e), D = double_double_offset(d, e);
  const double power = ((square(A) * triple(B, C, D) - square(B) * triple(A, C, D)) +
                        (square(C) * triple(A, B, D) - square(D) * triple(A, B, C)))
                           .high;
  const double largest = largest_square({&a, &b, &c, &d}, e), l2 = largest * largest;
  if (power * power > kInsphere2 * kInsphere2 * (l2 * l2 * largest) + kTiny) return power > 0 ? 1 : -1;
  if (short_differences({&a, &b, &c, &d}, e)) return insphere_expansion<1>(a, b, c, d, e);
  return insphere_expansion<2>(a, b, c, d, e);
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto B = expansion_offset<2>(b, a), C = expansion_offset<2>(c, a);
  return minor_xy(B, C).sign() == 0 && (B.y * C.z - B.z * C.y).sign() == 0 &&
         (B.z * C.x - B.x * C.z).sign() == 0;
}

}  // namespace dm
