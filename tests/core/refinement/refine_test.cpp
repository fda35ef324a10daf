// The refinement stage: no sliver, the size asked for, still Delaunay, the boundary kept.
#include "refinement/refine.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "../surfaces/shapes.h"
#include "base/random.h"
#include "refinement/angle_test.h"
#include "refinement/certificate.h"
#include "refinement/constrained_cavity.h"
#include "refinement/extract.h"
#include "surfaces/remesh.h"

using namespace dm;

namespace {

struct Refined {
  Plc plc;
  Geometry geometry;
  Context context;
  SizeField size;
  SurfaceMesh surface;
  RecoveryReport recovery;
  LabelledTriangulation mesh;
  RefineReport report;

  Refined(const shapes::Shape& s, double h, double target = 20, std::uint64_t seed = 1, int threads = 1,
          const ElementLimit& limit = {})
      : plc(s.plc),
        geometry(plc, s.records),
        context(keyed(seed, threads)),
        size(s.plc, geometry, options(h), context),
        surface(mesh_surfaces(s.plc, geometry, size, {}, context)),
        mesh(recover_boundary(surface, s.plc, geometry, size, context, recovery)) {
    mark_acute_segments(mesh, kAcuteAngle);
    RefineOptions o;
    o.target_angle = target;
    o.limit = limit;
    refine(mesh, geometry, size, o, context, report);
  }
  static SizeOptions options(double h) {
    SizeOptions o;
    o.max_size = h;
    return o;
  }
  static Context keyed(std::uint64_t seed, int threads) {
    Context c;
    c.seed = seed;
    c.threads = threads;
    return c;
  }
};

AngleRange angles(const VolumeMesh& m, const Tet& t) {
  return dihedral_range(m.points[t[0]], m.points[t[1]], m.points[t[2]], m.points[t[3]]);
}

double smallest_angle(const VolumeMesh& m) {
  double least = 180;
  for (const Tet& t : m.tets) least = std::min(least, angles(m, t).min);
  return least;
}

std::vector<double> relative_edges(const VolumeMesh& m, const SizeField& size) {
  std::vector<double> out;
  for (const Tet& t : m.tets)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) {
        const Vec3 a = m.points[t[i]], b = m.points[t[j]];
        out.push_back(distance(a, b) / size.at(0.5 * (a + b)));
      }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("refine: target angle, size and exact Delaunay property on every shape") {
  const std::vector<std::pair<shapes::Shape, double>> cases = {{shapes::box(6, 4, 3), 0.5},
                                                               {shapes::two_boxes(), 0.25},
                                                               {shapes::turned(5, 5, 8, 3, 24), 0.9},
                                                               {shapes::turned(5, 3, 8, 0, 24), 0.9},
                                                               {shapes::sphere(5, 16), 1},
                                                               {shapes::torus(8, 2, 24, 12), 0.9}};
  for (const auto& [shape, h] : cases) {
    Refined r(shape, h);
    CAPTURE(h);
    check_boundary(r.mesh);
    check_complex(r.mesh.boundary);
    r.mesh.tets.check(r.report.constrained == 0);
    CHECK(r.report.constrained == 0);
    const VolumeMesh m = extract_volume_mesh(r.mesh);
    CHECK(smallest_angle(m) >= 20);
    CHECK(certify(m, r.plc.face_solids, r.size, 20, r.context).empty());
    Context cancelled([](const char*, double) { return false; });
    CHECK_THROWS_AS(certify(m, r.plc.face_solids, r.size, 20, cancelled), Cancelled);
    const auto edges = relative_edges(m, r.size);
    CHECK(edges[edges.size() / 2] > 0.85);
    CHECK(edges[edges.size() / 2] < 1.1);
    CHECK(edges[edges.size() * 99 / 100] < 1.5);
    CHECK(static_cast<double>(r.report.tries) < 5 * static_cast<double>(r.report.sites));
  }
}

TEST_CASE("refine: a finished mesh has nothing left to do") {
  Refined r(shapes::box(6, 4, 3), 0.6);
  RefineReport again;
  refine(r.mesh, r.geometry, r.size, {}, r.context, again);
  CHECK(again.sites == 0);
}

TEST_CASE("refine: the target can be raised to 22 degrees") {
  for (const std::uint64_t seed : {1, 2, 3})
    CHECK(smallest_angle(extract_volume_mesh(Refined(shapes::box(6, 4, 3), 0.5, 22, seed).mesh)) >= 22);
}

TEST_CASE("refine: the same seed gives the same mesh on any number of threads, another seed another") {
  const auto shape = shapes::turned(5, 5, 8, 3, 24);
  const VolumeMesh a = extract_volume_mesh(Refined(shape, 1).mesh);
  const VolumeMesh b = extract_volume_mesh(Refined(shape, 1, 20, 1, 2).mesh);
  const VolumeMesh c = extract_volume_mesh(Refined(shape, 1, 20, 2).mesh);
  CHECK(a.tets == b.tets);
  CHECK(std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end()));
  CHECK(a.tets != c.tets);
}

TEST_CASE("refine: ends when there are one and a half times as many elements as the limit") {
  const auto shape = shapes::turned(5, 5, 8, 3, 24);
  const VolumeMesh all = extract_volume_mesh(Refined(shape, 1).mesh);
  const auto count = static_cast<std::int64_t>(all.tets.size());
  const auto limited = [&](std::int64_t most, std::int64_t before) {
    return extract_volume_mesh(Refined(shape, 1, 20, 1, 1, {most, before}).mesh);
  };
  CHECK(limited(count * 7 / 10, 0).tets == all.tets);
  CHECK(limited(count * 17 / 10, count * 3 / 2).tets == all.tets);
  CHECK_THROWS_AS(limited(count * 3 / 5, 0), Failure);
  CHECK_THROWS_AS(limited(count * 8 / 5, count * 3 / 2), Failure);
}

TEST_CASE("refine: boundary points lie on their CAD element") {
  Refined r(shapes::turned(5, 5, 8, 3, 24), 0.9);
  const VolumeMesh m = extract_volume_mesh(r.mesh);
  for (std::size_t v = 0; v < m.points.size(); ++v)
    if (m.point_entity[v].dimension < 3)
      CHECK(distance(m.points[v], r.geometry.project(m.point_entity[v], m.points[v])) < 1e-9);
}

TEST_CASE("refine: cancel ends it at once") {
  const auto shape = shapes::box(6, 4, 3);
  Geometry geometry(shape.plc, shape.records);
  Context quiet;
  SizeField size(shape.plc, geometry, Refined::options(0.12), quiet);
  const SurfaceMesh surface = mesh_surfaces(shape.plc, geometry, size, {}, quiet);
  RecoveryReport recovery;
  auto mesh = recover_boundary(surface, shape.plc, geometry, size, quiet, recovery);
  int calls = 0;
  Context context([&](const char*, double) { return ++calls < 3; });
  RefineReport report;
  CHECK_THROWS_AS(refine(mesh, geometry, size, {}, context, report), Cancelled);
  CHECK(calls == 3);
  check_boundary(mesh);
}

TEST_CASE("sharpness agrees with the dihedral angles and leaves out exempt ones") {
  Random random(5);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 p[4] = {random.in_ball(), random.in_ball(), random.in_ball(), random.in_ball()};
    const auto cosines = dihedral_cosines(p[0], p[1], p[2], p[3]);
    const double orientation = dot(area_vector(p[0], p[1], p[2]), p[3] - p[0]);
    if (std::abs(orientation) < 1e-3) continue;
    double worst = -1, without_first = -1;
    for (int i = 0; i < 6; ++i) {
      worst = std::max(worst, cosines[i] * std::abs(cosines[i]));
      if (i > 0) without_first = std::max(without_first, cosines[i] * std::abs(cosines[i]));
    }
    CHECK(sharpness(p[0], p[1], p[2], p[3]) == doctest::Approx(worst));
    CHECK(sharpness(p[0], p[1], p[2], p[3], 1) == doctest::Approx(without_first));
  }
}

TEST_CASE("a tetrahedron between points of a plane face is flat, as near to it as CAD puts them") {
  for (const double height : {1e-10, 1e-8, 1e-5, 0.1}) {
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, height}};
    const Triangulation tets(points);
    for (Index t = 0; t < tets.slot_count(); ++t)
      if (!tets.is_free(t) && !tets.is_ghost(t)) CHECK(is_flat(tets, t) == (height < 1e-6));
  }
}

TEST_CASE("constrained cavities are balls that stop at the boundary") {
  Refined r(shapes::two_boxes(), 0.3);
  ConstrainedSearch search(r.mesh.tets);
  Cavity cavity;
  int found = 0;
  for (Index t = 0; t < r.mesh.tets.slot_count(); t += 3) {
    if (r.mesh.tets.is_free(t) || r.mesh.tets.tag(t) == 0) continue;
    const auto [a, b, c, d] = r.mesh.tets.corners(t);
    const auto& p = r.mesh.tets.points();
    const Vec3 site = circumsphere(p[a], p[b], p[c], p[d]).centre;
    if (!search.find_cavity(site, t, cavity)) continue;
    ++found;
    CHECK(is_ball(r.mesh.tets, cavity));
    for (const Index s : cavity.tets) CHECK(r.mesh.tets.tag(s) == r.mesh.tets.tag(t));
  }
  CHECK(found > 50);
}
