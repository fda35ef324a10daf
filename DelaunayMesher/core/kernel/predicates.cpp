#include "kernel/predicates.h"

#include <memory>

#include "kernel/expansion.h"

namespace dm {

PredicateCounters& predicate_counters() {
  thread_local PredicateCounters counters;
  return counters;
}

namespace {

// The coordinates of a - e: N = 1 when they are doubles, 2 in general.
template <int N>
struct Offset {
  Expansion<N> x, y, z;
  Offset(const Vec3& a, const Vec3& e)
      : x(difference<N>(a.x, e.x)), y(difference<N>(a.y, e.y)), z(difference<N>(a.z, e.z)) {}
};

bool exact_difference(const Vec3& a, const Vec3& e) {
  return two_diff(a.x, e.x).low == 0 && two_diff(a.y, e.y).low == 0 && two_diff(a.z, e.z).low == 0;
}

template <int N>
auto minor_xy(const Offset<N>& a, const Offset<N>& b) {
  return a.x * b.y - a.y * b.x;
}
template <int N>
auto square(const Offset<N>& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}

// det of the rows a, b, c.
template <int N>
int triple_sign(const Offset<N>& a, const Offset<N>& b, const Offset<N>& c) {
  return (a.z * minor_xy(b, c) - b.z * minor_xy(a, c) + c.z * minor_xy(a, b)).sign();
}

template <int N>
int orient3d_expansion(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return -triple_sign<N>({a, d}, {b, d}, {c, d});
}

// Sum of square[i] * volume[i]; on the heap, for the worst case of N = 2 is near a megabyte.
template <int N>
int insphere_expansion(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  const Offset<N> A(a, e), B(b, e), C(c, e), D(d, e);
  const auto ab = minor_xy(A, B), ac = minor_xy(A, C), ad = minor_xy(A, D);
  const auto bc = minor_xy(B, C), bd = minor_xy(B, D), cd = minor_xy(C, D);
  struct Work {
    decltype(square(A) * (B.z * cd + B.z * cd + B.z * cd)) term[4];
    decltype(term[0] + term[1]) half[2];
    decltype(half[0] + half[1]) sum;
  };
  const std::unique_ptr<Work> w(new Work);
  w->term[0] = square(A) * (B.z * cd - C.z * bd + D.z * bc);
  w->term[1] = square(B) * (C.z * ad - A.z * cd - D.z * ac);
  w->term[2] = square(C) * (A.z * bd - B.z * ad + D.z * ab);
  w->term[3] = square(D) * (B.z * ac - A.z * bc - C.z * ab);
  w->half[0] = w->term[0] + w->term[1];
  w->half[1] = w->term[2] + w->term[3];
  w->sum = w->half[0] + w->half[1];
  return w->sum.sign();
}

template <int N>
bool collinear_expansion(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Offset<N> B(b, a), C(c, a);
  return minor_xy(B, C).sign() == 0 && (B.y * C.z - B.z * C.y).sign() == 0 &&
         (B.z * C.x - B.x * C.z).sign() == 0;
}

}  // namespace

int filter::orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  ++predicate_counters().orient_exact;
  if (exact_difference(a, d) && exact_difference(b, d) && exact_difference(c, d))
    return orient3d_expansion<1>(a, b, c, d);
  return orient3d_expansion<2>(a, b, c, d);
}

int filter::insphere_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  ++predicate_counters().insphere_exact;
  if (exact_difference(a, e) && exact_difference(b, e) && exact_difference(c, e) && exact_difference(d, e))
    return insphere_expansion<1>(a, b, c, d, e);
  return insphere_expansion<2>(a, b, c, d, e);
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) { return collinear_expansion<2>(a, b, c); }

}  // namespace dm
