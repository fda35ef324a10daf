#include <doctest/doctest.h>

#include <string>

#include "plc/bspline.h"
#include "plc/spline_curve.h"
#include "plc/spline_surface.h"
#include "splines.h"

using namespace dm;
using namespace dm::test;

namespace {

struct Range {
  double u0, u1, v0, v1;
};

double uniform(Random& random, double a, double b) { return a + random.uniform() * (b - a); }

// Everything that must hold of any surface near it: on the surface, nearest, idempotent, normal across.
void check_projection(const SplineSurfaceRecord& record, double offset, double tolerance) {
  const BSplineSurface exact(record);
  const SplineSurface surface(record);
  const KnotVector &ku = exact.knots_u(), &kv = exact.knots_v();
  const auto at = [&](double u, double v) { return exact.origin() + exact.point(u, v); };
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const double u = uniform(random, ku.first(), ku.last()), v = uniform(random, kv.first(), kv.last());
    const Vec3 on = at(u, v), p = on + offset * random.in_ball();
    CHECK(distance(surface.project(on), on) < tolerance);
    const Vec3 q = surface.project(p);
    CHECK(distance(p, q) <= distance(p, on) * (1 + 1e-9));
    CHECK(distance(surface.project(q), q) < tolerance);
    CHECK(norm(surface.normal(p)) == doctest::Approx(1));
  }
}

void check_nearest(const SplineSurfaceRecord& record, double offset) {
  const BSplineSurface exact(record);
  const SplineSurface surface(record);
  constexpr int n = 150;
  std::vector<Vec3> dense;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double u = exact.knots_u().first() + exact.knots_u().length() * i / n;
      const double v = exact.knots_v().first() + exact.knots_v().length() * j / n;
      dense.push_back(exact.origin() +
                      exact.point(std::min(u, exact.knots_u().last()), std::min(v, exact.knots_v().last())));
    }
  }
  Random random(4);
  for (int i = 0; i < 60; ++i) {
    const Vec3 p = dense[random.next() % dense.size()] + offset * random.in_ball();
    double best = 1e300;
    for (const Vec3& d : dense) best = std::min(best, distance(p, d));
    CHECK(distance(p, surface.project(p)) <= best * (1 + 1e-9) + 1e-15);
  }
}

SplineSurfaceRecord moved(SplineSurfaceRecord s, double scale, const Vec3& shift) {
  for (Vec3& p : s.poles) p = scale * p + shift;
  return s;
}

// A sheet three quarters round the z axis and back inside of itself: two sheets, nearer to each other than a
// grid of either is to it.
constexpr double kHairpinGap = 0.005;
SplineSurfaceRecord hairpin() {
  constexpr int n = 28;
  SplineSurfaceRecord s;
  s.degree_u = 3, s.degree_v = 1;
  s.nu = 2 * n, s.nv = 2;
  for (int i = 0; i < 2 * n; ++i) {
    const double angle = 1.5 * pi * std::min(i, 2 * n - 1 - i) / (n - 1);
    const double radius = i < n ? 1 + kHairpinGap : 1;
    for (const double z : {0.0, 1.0})
      s.poles.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  s.knots_u = uneven_knots(3, 2 * n, 1.0);
  s.knots_v = {0, 0, 1, 1};
  return s;
}

}  // namespace

TEST_CASE("two sheets of one surface at next to no distance: the nearest point is on the nearer one") {
  check_projection(hairpin(), 0.4 * kHairpinGap, 1e-12);
  check_nearest(hairpin(), 0.2);
}

TEST_CASE("two sheets of one surface: the side says which one") {
  const BSplineSurface exact(hairpin());
  const SplineSurface surface(hairpin());
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const double u = uniform(random, 0.01, 0.45) + 0.54 * (i % 2), v = random.uniform();
    const Vec3 on = exact.origin() + exact.point(u, v);
    const SurfaceJet jet = exact.jet(u, v);
    const Vec3 normal = normalized(cross(jet.u, jet.v));
    for (const double height : {-5.0, -0.9, 0.9, 5.0})  // the other sheet is nearer on one side
      CHECK(distance(surface.project(on + height * kHairpinGap * normal, normal), on) < 1e-12);
  }
}

TEST_CASE("derivatives agree with finite differences for every degree") {
  for (int degree : {1, 2, 3, 5, 9, 14, 25}) {
    for (bool rational : {false, true}) {
      CAPTURE(degree);
      const BSplineSurface s(bumpy(degree, degree + 4, rational, 1.0, 0.3, degree));
      Random random(8, degree);
      for (int i = 0; i < 20; ++i) {
        const double u = uniform(random, 0.01, 0.99), v = uniform(random, 0.01, 0.99), e = 1e-5;
        const int su = s.knots_u().span(u), sv = s.knots_v().span(v);
        if (s.knots_u().span(u - e) != su || s.knots_u().span(u + e) != su) continue;
        if (s.knots_v().span(v - e) != sv || s.knots_v().span(v + e) != sv) continue;
        const SurfaceJet jet = s.jet(u, v), a = s.jet(u - e, v), b = s.jet(u + e, v), c = s.jet(u, v - e),
                         d = s.jet(u, v + e);
        CHECK(distance(jet.point, s.point(u, v)) < 1e-15);
        CHECK(distance(jet.u, 1 / (2 * e) * (b.point - a.point)) < 1e-6);
        CHECK(distance(jet.v, 1 / (2 * e) * (d.point - c.point)) < 1e-6);
        CHECK(distance(jet.uu, 1 / (2 * e) * (b.u - a.u)) < 1e-4);
        CHECK(distance(jet.uv, 1 / (2 * e) * (d.u - c.u)) < 1e-4);
        CHECK(distance(jet.vv, 1 / (2 * e) * (d.v - c.v)) < 1e-4);
      }
    }
  }
}

TEST_CASE("ends and knots belong to the range, also of unclamped knots") {
  SplineCurveRecord c{3, {}, {}, {}, 3, 7};
  for (int i = 0; i < 7; ++i) c.poles.push_back({static_cast<double>(i), i % 2 ? 1.0 : 0.0, 0});
  for (int i = 0; i < 11; ++i) c.knots.push_back(i);
  const BSplineCurve curve(c);
  CHECK(curve.knots().breaks() == std::vector<double>{3, 4, 5, 6, 7});
  const Vec3 start = curve.origin() + curve.point(3), end = curve.origin() + curve.point(7);
  CHECK(distance(start, {1, 2 / 3.0, 0}) < 1e-15);
  CHECK(distance(end, {5, 2 / 3.0, 0}) < 1e-15);
  const SplineCurve projected(c);
  CHECK(distance(projected.project({-1, 0.5, 0}), start) < 1e-14);
  CHECK(distance(projected.project({9, 0.5, 0}), end) < 1e-14);
}

TEST_CASE("a rational arc is a circle") {
  for (double s : {1e-3, 1.0, 1e6}) {
    for (int quarters : {1, 2, 4}) {
      const SplineCurve curve(arc(2 * s, quarters));
      Random random(1);
      for (int i = 0; i < 200; ++i) {
        const double angle = uniform(random, 0, pi / 2 * quarters), r = uniform(random, 1.2, 2.8) * s;
        const Vec3 direction{std::cos(angle), std::sin(angle), 0};
        const Vec3 p = r * direction + Vec3{0, 0, s * random.symmetric()};
        CHECK(distance(curve.project(p), 2 * s * direction) < 1e-11 * s);
        CHECK(curve.curvature(p) * s == doctest::Approx(0.5));
      }
    }
    const SplineCurve open(arc(2 * s, 1));
    CHECK(distance(open.project({2.1 * s, -0.3 * s, 0}), {2 * s, 0, 0}) < 1e-14 * s);
    // Only a part of it belongs to the edge.
    SplineCurveRecord part = arc(2 * s, 4);
    part.u0 = 1, part.u1 = 2;
    CHECK(distance(SplineCurve(part).project({2 * s, 0.1 * s, 0}), {0, 2 * s, 0}) < 1e-14 * s);
    // A periodic range that was moved by a period stands for the whole.
    part.u0 = 3.5, part.u1 = 4.5;
    CHECK(distance(SplineCurve(part).project({0, -2.1 * s, 0}), {0, -2 * s, 0}) < 1e-12 * s);
  }
}

TEST_CASE("curves: wild poles, high degree, bad pace") {
  for (int degree : {1, 3, 14}) {
    for (double power : {0.4, 1.0, 4.0}) {
      SplineCurveRecord c;
      c.degree = degree;
      Random random(2, degree);
      for (int i = 0; i < degree + 8; ++i) {
        c.poles.push_back({std::pow(i / (degree + 7.0), 3), 0.2 * random.uniform(), 0.2 * random.uniform()});
      }
      c.knots = uneven_knots(degree, degree + 8, power);
      const BSplineCurve exact(c);
      const SplineCurve curve(c);
      for (int i = 0; i < 100; ++i) {
        const Vec3 on = exact.origin() + exact.point(random.uniform()), p = on + 0.02 * random.in_ball();
        double best = 1e300;
        for (int k = 0; k <= 3000; ++k)
          best = std::min(best, distance(p, exact.origin() + exact.point(k / 3000.0)));
        const Vec3 q = curve.project(p);
        CHECK(distance(p, q) <= best * (1 + 1e-9));
        CHECK(distance(curve.project(q), q) < 1e-11);
        CHECK(distance(curve.project(on), on) < 1e-11);
      }
    }
  }
}

TEST_CASE("a rational cylinder is the cylinder, quarter and closed") {
  for (double s : {1e-3, 1.0, 1e6}) {
    for (int quarters : {1, 2, 4}) {
      const Vec3 shift = s * Vec3{10, 20, 30};
      const SplineSurface spline(moved(revolve(line({2, -1, 0}, {2, 3, 0}), quarters), s, shift));
      Random random(1);
      for (int i = 0; i < 200; ++i) {
        const double angle = uniform(random, 0, pi / 2 * quarters), r = uniform(random, 1.5, 2.5);
        const Vec3 direction{std::cos(angle), std::sin(angle), 0}, up{0, 0, uniform(random, -1, 3)};
        const Vec3 p = s * (r * direction + up) + shift;
        CHECK(distance(spline.project(p), s * (2 * direction + up) + shift) < 2e-13 * s * 50);
        CHECK(std::abs(dot(spline.normal(p), direction)) > 1 - 1e-12);
        CHECK(spline.curvature(p) * s == doctest::Approx(0.5));
      }
    }
  }
}

TEST_CASE("a rational sphere and torus: degenerate poles, seams") {
  SplineCurveRecord half = arc(2, 2);
  for (Vec3& p : half.poles) p = {p.y, -p.x, 0};  // from the south pole to the north pole
  half.poles.front().x = half.poles.back().x = 0;
  const SplineSurface sphere(revolve(half, 4));
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 direction = normalized(random.in_ball());
    const Vec3 p = uniform(random, 1.6, 2.4) * direction;
    CHECK(distance(sphere.project(p), 2.0 * direction) < 1e-10);
    CHECK(std::abs(dot(sphere.normal(p), direction)) > 1 - 1e-9);
    CHECK(sphere.curvature(p) == doctest::Approx(0.5).epsilon(1e-4));
  }
  for (double z : {-1.0, 1.0}) {
    for (double e : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
      const Vec3 direction = normalized({e, 0.7 * e, z});
      // Squared distances of 0.1 tell points up to some 1e-9 apart from the pole no better.
      CHECK(distance(sphere.project(2.1 * direction), 2.0 * direction) < 2e-9);
      CHECK(std::abs(dot(sphere.normal(2.1 * direction), direction)) > 1 - 1e-8);
      CHECK(sphere.curvature(2.1 * direction) == doctest::Approx(0.5).epsilon(1e-3));
    }
  }
  SplineCurveRecord ring = arc(1, 4);
  for (Vec3& p : ring.poles) p.x += 3;
  const SplineSurface torus(revolve(ring, 4));
  for (int i = 0; i < 500; ++i) {
    const double u = i < 100 ? 0 : uniform(random, 0, 7), v = i % 100 < 50 ? 0 : uniform(random, 0, 7);
    const auto at = [&](double r) {
      return Vec3{(3 + r * std::cos(v)) * std::cos(u), (3 + r * std::cos(v)) * std::sin(u), r * std::sin(v)};
    };
    CHECK(distance(torus.project(at(uniform(random, 0.7, 1.3))), at(1)) < 1e-11);
  }
}

TEST_CASE("bumpy sheets of every degree, pace and scale") {
  for (int degree : {1, 2, 3, 7, 14}) {
    for (double power : {0.5, 1.0, 3.0}) {
      CAPTURE(degree);
      CAPTURE(power);
      const SplineSurfaceRecord record = bumpy(degree, degree + 4, true, power, 0.1, degree);
      check_projection(record, 0.01, 1e-11);
      check_nearest(record, 0.02);
    }
  }
  const SplineSurfaceRecord record = bumpy(3, 9, false, 1, 0.1, 7);
  check_projection(moved(record, 1e-3, {0.1, 0, 0.05}), 1e-5, 1e-13);
  check_projection(moved(record, 1e6, {1e6, 0, -2e6}), 1e4, 1e-5);
  // A small face far from the origin.
  check_projection(moved(record, 1e-2, {1e4, 2e4, 0}), 1e-4, 2e-11);
}

TEST_CASE("collapsed edges and pinched corners") {
  SplineSurfaceRecord fan = bumpy(3, 7, false, 1, 0.05, 11);
  for (Index j = 0; j < fan.nv; ++j) fan.poles[j] = fan.poles[0];
  check_projection(fan, 0.005, 1e-10);
  check_nearest(fan, 0.01);
  SplineSurfaceRecord lens = fan;
  for (Index j = 0; j < lens.nv; ++j) lens.poles[6 * 7 + j] = {1, 0.5, 0};
  check_projection(lens, 0.005, 1e-10);
  // Two rows of poles the same: the surface stands still there.
  SplineSurfaceRecord slow = bumpy(3, 7, false, 1, 0.05, 12);
  for (Index j = 0; j < slow.nv; ++j) slow.poles[7 + j] = slow.poles[j];
  check_projection(slow, 0.005, 1e-7);
}

TEST_CASE("beside the bounds of the range") {
  const SplineSurfaceRecord record = bumpy(3, 8, true, 1, 0.1, 21);
  const SplineSurface surface(record);
  const BSplineSurface exact(record);
  Random random(9);
  for (int i = 0; i < 400; ++i) {
    const double t = random.uniform(), e = 1e-4 * random.symmetric();
    const Vec3 on =
        exact.origin() + (i % 2 ? exact.point(t, i % 4 < 2 ? 0 : 1) : exact.point(i % 4 < 2 ? 0 : 1, t));
    const Vec3 p = on + Vec3{e, e * random.symmetric(), 0.01 * random.symmetric()};
    const Vec3 q = surface.project(p);
    CHECK(distance(surface.project(q), q) < 1e-11);
    CHECK(distance(p, q) <= distance(p, on));
  }
}

TEST_CASE("two sheets of one surface close together: the nearer one") {
  // A hairpin: there and back at distance 0.02.
  SplineSurfaceRecord pin;
  pin.degree_u = 3, pin.degree_v = 1;
  const std::array<std::array<double, 2>, 8> profile{
      {{0, 0}, {0.5, 0}, {0.9, 0}, {1, 0}, {1, 0.02}, {0.9, 0.02}, {0.5, 0.02}, {0, 0.02}}};
  pin.nu = 8, pin.nv = 2;
  for (const auto& [x, z] : profile) {
    for (double y : {0.0, 1.0}) pin.poles.push_back({x, y, z});
  }
  pin.knots_u = uneven_knots(3, 8, 1), pin.knots_v = {0, 0, 1, 1};
  check_nearest(pin, 0.008);
  const SplineSurface surface(pin);
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const double x = uniform(random, 0, 0.8), y = random.uniform(), z = uniform(random, -0.008, 0.008);
    CHECK(distance(surface.project({x, y, z}), {x, y, 0}) < 1e-12);
    CHECK(distance(surface.project({x, y, 0.02 + z}), {x, y, 0.02}) < 1e-12);
  }
}

TEST_CASE("geometry: splines that are planes or lines, and the side of normals") {
  const SplineSurfaceRecord flat = bumpy(3, 6, true, 2, 0, 5), bumps = bumpy(3, 6, true, 2, 0.1, 5);
  const BSplineSurface exact(bumps);
  Plc plc =
      patch([&](double u, double v) { return exact.origin() + exact.point(u, v); }, {0, 1, 0, 1}, 20, 20);
  for (bool reversed : {false, true}) {
    if (reversed) {
      for (Triangle& t : plc.triangles) std::swap(t[0], t[1]);
    }
    const SurfaceRecord spline{SurfaceKind::spline, {}, {}, 0, 0, 0};
    Geometry plane(plc, {{spline}, {}, {flat}, {}}), bumped(plc, {{spline}, {}, {bumps}, {}});
    CHECK(plane.is_plane(0));
    CHECK_FALSE(bumped.is_plane(0));
    CHECK(bumped.curvature(0, plc.points[30]) > 0.1);
    for (const Triangle& t : plc.triangles) {
      const Vec3 n = area_vector(plc.points[t[0]], plc.points[t[1]], plc.points[t[2]]);
      CHECK(dot(n, bumped.normal(0, plc.points[t[0]])) > 0);
      CHECK(bumped.normal(0, plc.points[t[0]]).z * plane.normal(0, plc.points[t[0]]).z > 0);
    }
  }
  const Plc edge = path([](double t) { return Vec3{t, 0, 0}; }, 0.2, 0.7, 3, false);
  const SplineCurveRecord straight{2, {{0, 0, 0}, {0.3, 0, 0}, {1, 0, 0}}, {}, {0, 0, 0, 1, 1, 1}, 0, 1};
  Geometry curve(edge, {{}, {{CurveKind::spline, {}, {}, 0, 0}}, {}, {straight}});
  CHECK(curve.is_line(0));
  CHECK(distance(curve.project_to_edge(0, {0.9, 1, 0}), {0.7, 0, 0}) < 1e-15);
}

TEST_CASE("impossible splines are refused") {
  const SplineSurfaceRecord good = bumpy(2, 5, true, 1, 0.1, 1);
  CHECK(defect(good).empty());
  const auto broken = [&](const std::function<void(SplineSurfaceRecord&)>& change) {
    SplineSurfaceRecord s = good;
    change(s);
    return !defect(s).empty();
  };
  CHECK(broken([](auto& s) { s.poles.pop_back(); }));
  CHECK(broken([](auto& s) { s.degree_u = 0; }));
  CHECK(broken([](auto& s) { s.degree_v = 26; }));
  CHECK(broken([](auto& s) { s.knots_u.pop_back(); }));
  CHECK(broken([](auto& s) { std::swap(s.knots_v[1], s.knots_v[5]); }));
  CHECK(broken([](auto& s) { s.knots_v.assign(s.knots_v.size(), 1); }));
  CHECK(broken([](auto& s) { s.weights[3] = 0; }));
  CHECK(broken([](auto& s) { s.weights.pop_back(); }));
  CHECK_FALSE(broken([](auto& s) { s.weights.assign(s.weights.size(), 0); }));
  CHECK(broken([](auto& s) { s.poles[3].x = std::nan(""); }));
  CHECK(broken([](auto& s) { s.u1 = s.u0; }));
  Plc plc = box();
  GeometryRecords records;
  records.faces.resize(6);
  records.edges.resize(12);
  records.edges[3] = {CurveKind::spline, {}, {}, 0, 0};
  records.spline_curves = {arc(1, 1)};
  records.spline_curves[0].weights[1] = -1;
  CHECK_THROWS_WITH_AS(Geometry(plc, records),
                       "Edge4: its spline has a weight that is not a positive number.", Failure);
}
