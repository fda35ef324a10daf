// The predicates against exact integer arithmetic (Boost.Multiprecision, tests only).
#include "kernel/predicates.h"

#include <doctest/doctest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>

#include "base/random.h"
#include "kernel/sphere_tests.h"

using namespace dm;

namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    4096, 4096, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;

// x * 2^kShift as an integer: exact for every |x| >= 2^(52 - kShift) and 0.
constexpr int kShift = 380;
Integer exact(double x) {
  if (x == 0) return 0;
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  Integer integer = static_cast<long long>(std::ldexp(mantissa, 53));
  const int shift = exponent - 53 + kShift;
  if (shift < 0) throw std::range_error("coordinate too small for this test");
  return integer << shift;
}

struct Exact {
  Integer x, y, z;
  Exact(const Vec3& a, const Vec3& e)
      : x(exact(a.x) - exact(e.x)), y(exact(a.y) - exact(e.y)), z(exact(a.z) - exact(e.z)) {}
  Integer square() const { return x * x + y * y + z * z; }
};
Integer triple(const Exact& a, const Exact& b, const Exact& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}
int exact_orient3d(const Vec3* p) {
  return triple(Exact(p[1], p[0]), Exact(p[2], p[0]), Exact(p[3], p[0])).sign();
}
int exact_insphere(const Vec3* p) {
  const Exact a(p[0], p[4]), b(p[1], p[4]), c(p[2], p[4]), d(p[3], p[4]);
  const Integer power = a.square() * triple(b, c, d) - b.square() * triple(a, c, d) +
                        c.square() * triple(a, b, d) - d.square() * triple(a, b, c);
  return power.sign();
}

Vec3 on_sphere(Random& random) { return normalized(random.in_ball()); }
void nudge(Vec3& p, Random& random) {  // by up to three ulps
  for (int i = 0; i < 3; ++i)
    for (int k = static_cast<int>(random.next() % 4); k > 0; --k)
      if (p[i] == 0)
        p[i] = random.symmetric() * 0x1.0p-52;
      else
        p[i] = std::nextafter(p[i], random.next() % 2 ? HUGE_VAL : -HUGE_VAL);
}

struct Kind {
  const char* name;
  void (*make)(Random&, Vec3*);
};
const Kind kKinds[] = {
    {"random",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = r.in_ball();
     }},
    {"small grid",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = {double(r.next() % 3), double(r.next() % 3), double(r.next() % 3)};
     }},
    {"decimal grid",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i)
         p[i] = {0.1 * double(r.next() % 4), 0.1 * double(r.next() % 4), 0.1 * double(r.next() % 4)};
     }},
    {"coplanar",
     [](Random& r, Vec3* p) {
       const Vec3 u = r.in_ball(), v = r.in_ball(), o = r.in_ball();
       for (int i = 0; i < 5; ++i) p[i] = o + r.symmetric() * u + r.symmetric() * v;
     }},
    {"axis plane",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = {r.symmetric(), 0.3, r.symmetric()};
     }},
    {"cospherical",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = on_sphere(r);
     }},
    {"sphere far away",
     [](Random& r, Vec3* p) {
       const Vec3 o = 1000 * r.in_ball();
       for (int i = 0; i < 5; ++i) p[i] = o + on_sphere(r);
     }},
    {"cylinder rectangles",
     [](Random& r, Vec3* p) {
       const double angle[2] = {6.3 * r.uniform(), 6.3 * r.uniform()}, z[2] = {r.symmetric(), r.symmetric()};
       for (int i = 0; i < 5; ++i)
         p[i] = {10 * std::cos(angle[i & 1]), 10 * std::sin(angle[i & 1]), z[i >> 1 & 1]};
       if (r.next() % 2) p[4] = r.in_ball();
     }},
    {"sphere nudged",
     [](Random& r, Vec3* p) {
       const Vec3 axis[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
       for (int i = 0; i < 5; ++i) p[i] = axis[(i + r.next()) % 6], nudge(p[i], r);
     }},
    {"plane nudged",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = {r.symmetric(), r.symmetric(), 0.7}, nudge(p[i], r);
     }},
    {"one line",
     [](Random& r, Vec3* p) {
       const Vec3 o = r.in_ball(), u = r.in_ball();
       for (int i = 0; i < 5; ++i) p[i] = o + r.symmetric() * u;
     }},
    {"mixed scales",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = std::pow(10.0, 9 * r.symmetric()) * r.in_ball();
     }},
    {"scales far apart",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = std::pow(10.0, 75 * r.symmetric()) * on_sphere(r);
       if (r.next() % 2) p[4] = p[0] + p[1];
     }},
    {"repeated",
     [](Random& r, Vec3* p) {
       for (int i = 0; i < 5; ++i) p[i] = i > 1 && r.next() % 2 ? p[r.next() % i] : r.in_ball();
     }},
};

// Fewer under slow tools: DM_TEST_CASES.
int cases() {
  const char* wanted = std::getenv("DM_TEST_CASES");
  return wanted ? std::atoi(wanted) : 1000000;
}

bool odd(const int* permutation, int n) {
  int inversions = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) inversions += permutation[j] > permutation[i];
  return inversions % 2 != 0;
}

}  // namespace

TEST_CASE("predicates have the exact sign, in every order of their arguments") {
  const int kinds = static_cast<int>(std::size(kKinds)), per_kind = cases() / kinds + 1;
  for (int kind = 0; kind < kinds; ++kind) {
    Random random(11, kind);
    int orient_errors = 0, sphere_errors = 0, filter_errors = 0, order_errors = 0;
    for (int n = 0; n < per_kind; ++n) {
      Vec3 p[5], q[5];
      kKinds[kind].make(random, p);
      const double scale = n % 3 == 0 ? 1 : std::pow(10.0, std::round(9 * random.symmetric()));
      for (Vec3& v : p) v = scale * v;
      const int orient = exact_orient3d(p), sphere = exact_insphere(p);
      orient_errors += orient3d(p[0], p[1], p[2], p[3]) != orient;
      sphere_errors += insphere(p[0], p[1], p[2], p[3], p[4]) != sphere;
      filter_errors += filter::orient3d_exact(p[0], p[1], p[2], p[3]) != orient;
      filter_errors += filter::insphere_exact(p[0], p[1], p[2], p[3], p[4]) != sphere;
      int order[5] = {0, 1, 2, 3, 4};
      for (int i = 3; i > 0; --i) std::swap(order[i], order[random.next() % (i + 1)]);
      for (int i = 0; i < 5; ++i) q[i] = p[order[i]];
      const int swap = odd(order, 4) ? -1 : 1;
      order_errors += orient3d(q[0], q[1], q[2], q[3]) != swap * orient;
      order_errors += insphere(q[0], q[1], q[2], q[3], q[4]) != swap * sphere;
    }
    CAPTURE(std::string(kKinds[kind].name));
    CHECK(orient_errors == 0);
    CHECK(sphere_errors == 0);
    CHECK(filter_errors == 0);
    CHECK(order_errors == 0);
  }
}

TEST_CASE("four sphere tests at a time give the signs of one at a time") {
  Random random(12);
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.push_back(i % 3 == 0 ? on_sphere(random) : random.in_ball());
  for (std::size_t count = 1; count < 200; ++count) {
    std::vector<Tet> corners;
    std::vector<Index> tets(count + 4, 0), same(count + 4, 0);
    for (std::size_t k = 0; k < count; ++k) {
      Tet tet;
      for (Index& v : tet) v = static_cast<Index>(random.next() % points.size());
      if (k % 7 == 3) tet[3] = -1;
      corners.push_back(tet);
      tets[k] = same[k] = static_cast<Index>(count - 1 - k);
    }
    std::vector<std::int8_t> fast(count + 4, 9), plain(count + 4, 9);
    const Vec3 p = random.in_ball();
    sphere_tests()(points.data(), corners.data(), tets.data(), count, p, fast.data());
    sphere_tests_plain(points.data(), corners.data(), same.data(), count, p, plain.data());
    fast.resize(count), plain.resize(count);
    CHECK(fast == plain);
  }
}

TEST_CASE("collinear is exact") {
  CHECK(collinear({0, 0, 0}, {1, 2, 3}, {2, 4, 6}));
  CHECK(collinear({1, 1, 1}, {1, 1, 1}, {5, 0, 0}));
  CHECK_FALSE(collinear({0, 0, 0}, {1, 2, 3}, {2, 4, std::nextafter(6.0, 7.0)}));
  CHECK_FALSE(collinear({0, 0, 0}, {0.1, 0.1, 0.1}, {0.3, 0.3, std::nextafter(0.3, 1.0)}));
}

TEST_CASE("the counters count the fall-backs") {
  predicate_counters() = {};
  CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}) == 1);
  CHECK(predicate_counters().orient_exact == 0);
  CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}) == 0);
  CHECK(predicate_counters().orient_exact == 1);
  CHECK(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0.5}) == 1);
  CHECK(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}) == 0);
  CHECK(predicate_counters().insphere_exact == 1);
}
