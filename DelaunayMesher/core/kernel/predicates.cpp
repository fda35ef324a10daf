#include "kernel/predicates.h"

#include <array>
#include <bit>
#include <limits>

#include "kernel/exact_integer.h"

namespace dm {

PredicateCounters& predicate_counters() {
  thread_local PredicateCounters counters;
  return counters;
}

namespace {

// A double as mantissa * 2^exponent, the exponent counted from the smallest that doubles have.
struct Parts {
  std::uint64_t mantissa;
  int exponent;
  bool negative;

  explicit Parts(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int biased = static_cast<int>(bits >> 52 & 0x7ff);
    mantissa = (bits & 0xfffffffffffff) | static_cast<std::uint64_t>(biased != 0) << 52;
    exponent = biased - (biased != 0);
    negative = bits >> 63;
  }
};

// Coordinates relative to the last of the points, as integers on the common grid 2^lowest.
template <std::size_t Count>
struct Grid {
  std::array<const Vec3*, Count> points;
  int lowest = std::numeric_limits<int>::max();  // exponent of the last bit that any coordinate uses
  int bits = 0;                                  // of the largest difference

  explicit Grid(const std::array<const Vec3*, Count>& p) : points(p) {
    const Vec3& e = *points[Count - 1];
    double largest = 0;
    for (const Vec3* a : points)
      for (int i = 0; i < 3; ++i) {
        const Parts x((*a)[i]);
        if (x.mantissa != 0) lowest = std::min(lowest, x.exponent + std::countr_zero(x.mantissa));
        largest = std::max(largest, std::abs((*a)[i] - e[i]));
      }
    // A rounded difference with biased exponent k means |difference| <= 2^(k + 54) of the smallest unit.
    if (largest > 0) bits = Parts(largest).exponent + 54 - lowest;
  }

  // Modulo 2^(64 N): enough, for the differences fit.
  template <int N>
  ExactInteger<N> integer(double value) const {
    ExactInteger<N> r;
    const Parts x(value);
    if (x.mantissa == 0) return r;
    const int shift = x.exponent - lowest;
    if (shift < 0) {
      r.limb[0] = x.mantissa >> -shift;
    } else {
      const int first = shift / 64, rest = shift % 64;
      if (first < N) r.limb[first] = x.mantissa << rest;
      if (first + 1 < N && rest > 0) r.limb[first + 1] = x.mantissa >> (64 - rest);
    }
    return x.negative ? ExactInteger<N>() - r : r;
  }
};

template <int N>
struct Offset {
  ExactInteger<N> x, y, z;

  template <class Points>
  Offset(const Points& grid, const Offset& e, int i)
      : x(grid.template integer<N>(grid.points[i]->x) - e.x),
        y(grid.template integer<N>(grid.points[i]->y) - e.y),
        z(grid.template integer<N>(grid.points[i]->z) - e.z) {}
  template <class Points>
  explicit Offset(const Points& grid)
      : x(grid.template integer<N>(grid.points.back()->x)),
        y(grid.template integer<N>(grid.points.back()->y)),
        z(grid.template integer<N>(grid.points.back()->z)) {}
};

template <int N>
ExactInteger<2 * N> minor_xy(const Offset<N>& a, const Offset<N>& b) {
  return a.x * b.y - a.y * b.x;
}
template <int N>
ExactInteger<2 * N> square(const Offset<N>& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}
// With |difference| < 2^(64 N - 2): minor < 2^(128 N - 3), triple product < 2^(192 N - 3), square <
// 2^(128 N - 2), power < 2^(320 N - 3), so every sum below keeps its sign bit.
template <int N>
struct Orient3d {
  static int sign(const Grid<4>& grid) {
    const Offset<N> d(grid), a(grid, d, 0), b(grid, d, 1), c(grid, d, 2);
    return -(a.z * minor_xy(b, c) - b.z * minor_xy(a, c) + c.z * minor_xy(a, b)).sign();
  }
};
template <int N>
struct Insphere {
  static int sign(const Grid<5>& grid) {
    const Offset<N> e(grid), a(grid, e, 0), b(grid, e, 1), c(grid, e, 2), d(grid, e, 3);
    const auto ab = minor_xy(a, b), ac = minor_xy(a, c), ad = minor_xy(a, d);
    const auto bc = minor_xy(b, c), bd = minor_xy(b, d), cd = minor_xy(c, d);
    const auto va = b.z * cd - c.z * bd + d.z * bc, vb = c.z * ad - a.z * cd - d.z * ac;
    const auto vc = a.z * bd - b.z * ad + d.z * ab, vd = b.z * ac - a.z * bc - c.z * ab;
    return (square(a) * va + square(b) * vb + (square(c) * vc + square(d) * vd)).sign();
  }
};

// The fewest limbs that do; 34 hold any difference of two doubles.
template <template <int> class Predicate, class Points>
int sign(const Points& grid) {
  if (grid.bits <= 62) return Predicate<1>::sign(grid);
  if (grid.bits <= 126) return Predicate<2>::sign(grid);
  if (grid.bits <= 446) return Predicate<7>::sign(grid);
  return Predicate<34>::sign(grid);
}

template <int N>
struct Collinear {
  static int sign(const Grid<3>& grid) {
    const Offset<N> a(grid), b(grid, a, 0), c(grid, a, 1);
    return minor_xy(b, c).sign() == 0 && (b.y * c.z - b.z * c.y).sign() == 0 &&
           (b.z * c.x - b.x * c.z).sign() == 0;
  }
};

}  // namespace

int filter::orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  ++predicate_counters().orient_exact;
  return sign<Orient3d>(Grid<4>({&a, &b, &c, &d}));
}

int filter::insphere_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  ++predicate_counters().insphere_exact;
  return sign<Insphere>(Grid<5>({&a, &b, &c, &d, &e}));
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return sign<Collinear>(Grid<3>({&b, &c, &a})) != 0;
}

}  // namespace dm
