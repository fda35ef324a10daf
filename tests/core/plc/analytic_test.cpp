#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "base/random.h"
#include "plc/geometry.h"
#include "shapes.h"

using namespace dm;
using namespace dm::test;

namespace {

// An orthonormal frame in general position.
struct Frame {
  Vec3 origin, x, y, z;
  explicit Frame(double scale) : origin{3.1 * scale, -2.2 * scale, 7.3 * scale} {
    z = normalized({0.3, -0.5, 0.8});
    x = normalized(cross(z, {0, 1, 0}));
    y = cross(z, x);
  }
  Vec3 at(double a, double b, double c) const { return origin + a * x + b * y + c * z; }
};

struct Case {
  const char* name;
  SurfaceRecord record;
  std::function<Vec3(double, double)> f;
  std::array<double, 4> range;
  double curvature;  // at range[0], range[2]
};

std::vector<Case> cases(double s) {
  const Frame q(s);
  const auto record = [&](SurfaceKind kind, double a, double b) {
    return SurfaceRecord{kind, q.origin, q.z, a, b, -1};
  };
  const auto torus = [q, s](double major, double minor) {
    return [=](double u, double v) {
      const double r = s * (major + minor * std::cos(v));
      return q.at(r * std::cos(u), r * std::sin(u), s * minor * std::sin(v));
    };
  };
  const auto cone = [q, s](double u, double v) {
    const double r = s * v * std::sin(0.4);
    return q.at(r * std::cos(u), r * std::sin(u), s * v * std::cos(0.4));
  };
  const double inner = std::acos(-2.0 / 3);  // of the spindle torus 2, 3
  return {
      {"plane",
       record(SurfaceKind::plane, 0, 0),
       [=](double u, double v) { return q.at(s * u, s * v, 0); },
       {0, 2, 0, 3},
       0},
      {"cylinder",
       record(SurfaceKind::cylinder, 2 * s, 0),
       [=](double u, double v) { return q.at(2 * s * std::cos(u), 2 * s * std::sin(u), s * v); },
       {0, 6, -3, 3},
       0.5},
      {"sphere",
       record(SurfaceKind::sphere, 2 * s, 0),
       [=](double u, double v) {
         return q.at(2 * s * std::cos(u) * std::cos(v), 2 * s * std::sin(u) * std::cos(v),
                     2 * s * std::sin(v));
       },
       {0, 6, -1.5, 1.5},
       0.5},
      {"cone", record(SurfaceKind::cone, 0.4, 0), cone, {0, 6, 1, 3}, std::cos(0.4) / std::sin(0.4)},
      {"far nappe",
       record(SurfaceKind::cone, 0.4, 0),
       cone,
       {0, 6, -3, -1},
       std::cos(0.4) / std::sin(0.4) / 3},
      {"both nappes",
       record(SurfaceKind::cone, 0.4, 0),
       cone,
       {0, 6, -3, 3},
       std::cos(0.4) / std::sin(0.4) / 3},
      {"torus", record(SurfaceKind::torus, 3 * s, s), torus(3, 1), {0, 6, 0, 6}, 1},
      {"apple", record(SurfaceKind::torus, 2 * s, 3 * s), torus(2, 3), {0, 6, -inner + 0.1, inner - 0.1}, -1},
      {"lemon",
       record(SurfaceKind::torus, 2 * s, 3 * s),
       torus(2, 3),
       {0, 6, inner + 0.2, 2 * pi - inner - 0.2},
       0},
  };
}

std::unique_ptr<Geometry> geometry_of(const Case& c, const Plc& plc) {
  GeometryRecords records;
  records.faces = {c.record};
  records.edges.resize(plc.edge_count);
  return std::make_unique<Geometry>(plc, std::move(records));
}

}  // namespace

TEST_CASE("analytic surfaces: on the surface, nearest, idempotent, normals as the triangles") {
  for (double s : {1e-3, 1.0, 1e6}) {
    for (const Case& c : cases(s)) {
      for (bool reversed : {false, true}) {
        CAPTURE(c.name);
        CAPTURE(s);
        Plc plc = patch(c.f, c.range, 24, 24);
        if (reversed) {
          for (Triangle& t : plc.triangles) std::swap(t[0], t[1]);
        }
        const auto geometry = geometry_of(c, plc);
        Random random(5, static_cast<int>(c.record.kind));
        for (int i = 0; i < 200; ++i) {
          const double u = c.range[0] + random.uniform() * (c.range[1] - c.range[0]);
          const double v = c.range[2] + random.uniform() * (c.range[3] - c.range[2]);
          const Vec3 on = c.f(u, v), p = on + 0.05 * s * random.in_ball();
          CHECK(distance(geometry->project_to_face(0, on), on) < 3e-14 * s);
          const Vec3 q = geometry->project_to_face(0, p);
          CHECK(distance(geometry->project_to_face(0, q), q) < 3e-14 * s);
          CHECK(distance(p, q) <= distance(p, on) * (1 + 1e-12));
          const Vec3 n = geometry->normal(0, p);
          CHECK(norm(n) == doctest::Approx(1));
          if (distance(p, q) > 1e-3 * s) CHECK(std::abs(dot(n, normalized(p - q))) > 1 - 1e-9);
          const double e = 1e-5;
          const Vec3 du = c.f(u + e, v) - c.f(u - e, v), dv = c.f(u, v + e) - c.f(u, v - e);
          const Vec3 m = (reversed ? -1.0 : 1.0) * normalized(cross(du, dv));
          if (norm(cross(du, dv)) > 1e-2 * e * e * s * s) CHECK(dot(geometry->normal(0, on), m) > 1 - 1e-6);
        }
        if (c.curvature > 0) {
          CHECK(geometry->curvature(0, c.f(c.range[0], c.range[2])) * s == doctest::Approx(c.curvature));
        }
        CHECK(geometry->is_plane(0) == (c.record.kind == SurfaceKind::plane));
      }
    }
  }
}

TEST_CASE("points as far from one part of a surface as from another go towards the face") {
  SurfaceRecord record{SurfaceKind::cylinder, {0, 0, 0}, {0, 0, 2}, 1, 0, -1};
  const auto f = [](double u, double v) { return Vec3{std::cos(u), std::sin(u), v}; };
  const Plc plc = patch(f, {1, 2, 0, 1}, 4, 4);
  Geometry cylinder(plc, {{record}, {}, {}, {}});
  CHECK(dot(cylinder.project_to_face(0, {0, 0, 0.5}), f(1.5, 0)) > 0.99);
  record.kind = SurfaceKind::sphere;
  Geometry sphere(plc, {{record}, {}, {}, {}});
  CHECK(norm(sphere.project_to_face(0, {0, 0, 0})) == doctest::Approx(1));
}

TEST_CASE("a point beyond the apex stays on the nappe of its face") {
  const SurfaceRecord record{SurfaceKind::cone, {0, 0, 0}, {0, 0, 1}, 0.5, 0, -1};
  const Plc plc = patch(
      [](double u, double v) {
        return Vec3{v * std::sin(0.5) * std::cos(u), v * std::sin(0.5) * std::sin(u), v * std::cos(0.5)};
      },
      {0, 6, 0, 1}, 12, 4);
  Geometry geometry(plc, {{record}, {}, {}, {}});
  CHECK(norm(geometry.project_to_face(0, {0.01, 0, -0.1})) < 1e-15);
  CHECK(norm(geometry.normal(0, {0, 0, 0})) == 0);  // none at the apex itself
}

TEST_CASE("a ring of an almost flat cone has one nappe, with normals all to one side") {
  const double angle = 0.5 * pi - 7e-7;
  const SurfaceRecord record{SurfaceKind::cone, {0, 0, 0}, {0, 0, 1}, angle, 0, -1};
  const auto ring = [&](double u, double v) {
    return Vec3{v * std::sin(angle) * std::cos(u), v * std::sin(angle) * std::sin(u), v * std::cos(angle)};
  };
  const Plc plc = test::patch(ring, {0, 3, 1, 25}, 12, 4);
  const Geometry geometry(plc, {{record}, {}, {}, {}});
  for (double noise : {-1e-4, -1e-7, 0.0, 1e-7, 1e-4}) {
    const Vec3 p = ring(1, 10) + Vec3{0, 0, noise};
    CHECK(distance(geometry.project_to_face(0, p), ring(1, 10)) < 1e-9);
    CHECK(geometry.normal(0, p).z * geometry.normal(0, ring(2, 20)).z > 0.99);
  }
}

TEST_CASE("facets and polylines") {
  const Plc plc = box();
  Geometry geometry(plc, {});
  CHECK(distance(geometry.project_to_face(1, {0.3, 0.4, 1.2}), Vec3{0.3, 0.4, 1}) < 1e-15);
  CHECK(geometry.project_to_face(1, {2, 0.5, 1.2}) == Vec3{1, 0.5, 1});
  CHECK(geometry.project_to_face(1, {2, 2, 2}) == Vec3{1, 1, 1});
  CHECK(geometry.normal(0, {0.2, 0.3, 0.1}) == Vec3{0, 0, -1});
  CHECK(geometry.curvature(0, {0.2, 0.3, 0.1}) == 0);
  CHECK(geometry.project_to_edge(0, {0.25, 0.5, 0.5}) == Vec3{0.25, 0, 0});
  CHECK(geometry.project_to_edge(0, {1.5, 0.5, 0.5}) == Vec3{1, 0, 0});
  CHECK(geometry.project({0, 0}, {5, 6, 7}) == Vec3{5, 6, 7});
  CHECK_FALSE(geometry.is_plane(0));

  // Against brute force on a bumpy face.
  const Plc bumpy = patch(
      [](double u, double v) {
        return Vec3{u, v, std::sin(5 * u) * std::cos(4 * v)};
      },
      {0, 2, 0, 2}, 30, 30);
  Geometry bumps(bumpy, {});
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = Vec3{1, 1, 0} + 2 * random.in_ball();
    double best = 1e300;
    for (const Triangle& t : bumpy.triangles) {
      const Vec3 &a = bumpy.points[t[0]], &b = bumpy.points[t[1]], &c = bumpy.points[t[2]];
      constexpr int n = 8;
      for (int j = 0; j <= n; ++j) {
        for (int k = 0; j + k <= n; ++k)
          best = std::min(best, distance(p, a + (1.0 * j / n) * (b - a) + (1.0 * k / n) * (c - a)));
      }
    }
    const double found = distance(p, bumps.project_to_face(0, p));
    CHECK(found <= best + 1e-14);
    CHECK(found > best - 0.02);
  }
}

TEST_CASE("lines and circles end where their edge ends") {
  for (double s : {1e-3, 1.0, 1e6}) {
    const Frame q(s);
    const Plc straight = path([&](double t) { return q.at(0, 0, s * t); }, 1, 3, 5, false);
    Geometry line(straight, {{}, {{CurveKind::line, q.origin, q.z, 0, -1}}, {}, {}});
    CHECK(line.is_line(0));
    CHECK(distance(line.project_to_edge(0, q.at(s, s, 2 * s)), q.at(0, 0, 2 * s)) < 1e-14 * s * 10);
    CHECK(distance(line.project_to_edge(0, q.at(0, s, 9 * s)), q.at(0, 0, 3 * s)) < 1e-14 * s * 10);
    CHECK(distance(line.project_to_edge(0, q.at(0, s, -s)), q.at(0, 0, s)) < 1e-14 * s * 10);

    const auto f = [&](double t) { return q.at(2 * s * std::cos(t), 2 * s * std::sin(t), 0); };
    const CurveRecord record{CurveKind::circle, q.origin, q.z, 2 * s, -1};
    for (double sweep : {0.5, 2.0, 3.5, 6.0}) {
      for (double start : {-2.0, 0.3, 3.0}) {
        for (int n : {3, 8}) {
          CAPTURE(sweep);
          CAPTURE(start);
          Geometry arc(path(f, start, start + sweep, n, false), {{}, {record}, {}, {}});
          CHECK_FALSE(arc.is_line(0));
          CHECK(arc.edge_curvature(0, q.origin) * s == doctest::Approx(0.5));
          for (double t : {0.001, 0.3, 0.9, 0.999}) {
            const Vec3 on = f(start + t * sweep);
            CHECK(distance(arc.project_to_edge(0, on + 0.1 * s * q.z), on) < 1e-13 * s);
          }
          CHECK(distance(arc.project_to_edge(0, f(start + sweep + 0.1)), f(start + sweep)) < 1e-13 * s);
          CHECK(distance(arc.project_to_edge(0, f(start - 0.1)), f(start)) < 1e-13 * s);
        }
      }
    }
    Geometry closed(path(f, 0, 2 * pi, 12, true), {{}, {record}, {}, {}});
    for (double t = 0; t < 7; t += 0.3)
      CHECK(distance(closed.project_to_edge(0, 1.0 * f(t)), f(t)) < 1e-13 * s);
  }
}

TEST_CASE("impossible records are refused with the name of the face") {
  const Plc plc = box();
  const auto code = [&](SurfaceRecord record) -> std::string {
    GeometryRecords records;
    records.faces.resize(6);
    records.edges.resize(12);
    records.faces[4] = record;
    try {
      Geometry geometry(plc, records);
    } catch (const Failure& failure) {
      CHECK(failure.entity == Entity{2, 4});
      CHECK(std::string(failure.what()).find("Face5") != std::string::npos);
      return failure.code;
    }
    return "none";
  };
  CHECK(code({SurfaceKind::plane, {}, {0, 0, 1}, 0, 0, -1}) == "none");
  CHECK(code({SurfaceKind::plane, {}, {0, 0, 0}, 0, 0, -1}) == "bad_geometry");
  CHECK(code({SurfaceKind::cylinder, {}, {0, 0, 1}, -1, 0, -1}) == "bad_geometry");
  CHECK(code({SurfaceKind::sphere, {}, {0, 0, 1}, 0, 0, -1}) == "bad_geometry");
  CHECK(code({SurfaceKind::cone, {}, {0, 0, 1}, 1.6, 0, -1}) == "bad_geometry");
  CHECK(code({SurfaceKind::torus, {}, {0, 0, 1}, 2, std::nan(""), -1}) == "bad_geometry");
  CHECK(code({SurfaceKind::spline, {}, {0, 0, 1}, 0, 0, 0}) == "bad_geometry");
  CHECK(code({static_cast<SurfaceKind>(9), {}, {0, 0, 1}, 0, 0, -1}) == "bad_geometry");
  CHECK_THROWS_AS(Geometry(plc, GeometryRecords{std::vector<SurfaceRecord>(2), {}, {}, {}}), Failure);
}
