#include "order/second_order.h"

#include <doctest/doctest.h>

#include <set>

#include "../optimisation/sample_meshes.h"
#include "order/jacobian.h"

using namespace dm;

namespace {

TenNodes ten_nodes(const VolumeMesh& mesh, const SecondOrder& order, std::size_t t) {
  TenNodes x;
  for (int i = 0; i < 4; ++i) x[i] = mesh.points[mesh.tets[t][i]];
  for (int i = 0; i < 6; ++i) x[4 + i] = order.points[order.tet_nodes[t][i] - mesh.points.size()];
  return x;
}

// det J at barycentric coordinates l, from the shape functions.
double jacobian_at(const TenNodes& x, const std::array<double, 4>& l) {
  Vec3 d[3];
  for (int m = 1; m < 4; ++m) {
    const auto gradient = [&](int i) { return i == m ? 1.0 : i == 0 ? -1.0 : 0.0; };
    for (int i = 0; i < 4; ++i) d[m - 1] += (4 * l[i] - 1) * gradient(i) * x[i];
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      d[m - 1] += 4 * (l[i] * gradient(j) + l[j] * gradient(i)) * x[4 + e];
    }
  }
  return dot(cross(d[0], d[1]), d[2]);
}

// Everything the order stage promises; returns the smallest ratio.
double check_promises(const sample::Sample& s, const SecondOrder& order, const Geometry& geometry) {
  const Index corners = static_cast<Index>(s.mesh.points.size());
  REQUIRE(order.points.size() == order.point_entity.size());
  REQUIRE(order.tet_nodes.size() == s.mesh.tets.size());
  std::map<Segment, Index> middle;  // one node per edge, whatever element is asked
  const auto same = [&](Index a, Index b, Index node) {
    CHECK(middle.emplace(Segment{std::min(a, b), std::max(a, b)}, node).first->second == node);
  };
  double worst = 1;
  for (std::size_t t = 0; t < s.mesh.tets.size(); ++t) {
    for (int i = 0; i < 6; ++i)
      same(s.mesh.tets[t][kTetEdges[i][0]], s.mesh.tets[t][kTetEdges[i][1]], order.tet_nodes[t][i]);
    worst = std::min(worst, jacobian_ratio(ten_nodes(s.mesh, order, t)));
  }
  CHECK(middle.size() == order.points.size());
  for (std::size_t k = 0; k < s.mesh.triangles.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const auto& t = s.mesh.triangles[k];
      static constexpr int kEdges[3][2] = {{0, 1}, {1, 2}, {0, 2}};
      same(t[kEdges[i][0]], t[kEdges[i][1]], order.triangle_nodes[k][i]);
      CHECK(order.point_entity[order.triangle_nodes[k][i] - corners].dimension <= 2);
    }
  for (std::size_t k = 0; k < s.mesh.segments.size(); ++k) {
    same(s.mesh.segments[k][0], s.mesh.segments[k][1], order.segment_nodes[k]);
    CHECK(order.point_entity[order.segment_nodes[k] - corners] == Entity{1, s.mesh.segment_edge[k]});
  }
  CHECK(middle.size() == order.points.size());
  if (order.straightened.empty())
    for (std::size_t k = 0; k < order.points.size(); ++k)
      CHECK(distance(order.points[k], geometry.project(order.point_entity[k], order.points[k])) < 1e-9);
  CHECK(worst > 0);
  return worst;
}

}  // namespace

TEST_CASE("the coefficients of a straight element are six volumes") {
  TenNodes x{Vec3{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
  for (int e = 0; e < 6; ++e) x[4 + e] = 0.5 * (x[kTetEdges[e][0]] + x[kTetEdges[e][1]]);
  for (const double c : jacobian_coefficients(x)) CHECK(c == doctest::Approx(24));
  CHECK(jacobian_ratio(x) == doctest::Approx(1));
}

TEST_CASE("the coefficients bound the Jacobian and equal it at the corners") {
  for (int trial = 0; trial < 50; ++trial) {
    Random random(17, trial);
    TenNodes x{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int e = 0; e < 6; ++e)
      x[4 + e] = 0.5 * (x[kTetEdges[e][0]] + x[kTetEdges[e][1]]) + 0.2 * random.in_ball();
    const auto c = jacobian_coefficients(x);
    const auto [low, high] = std::minmax_element(c.begin(), c.end());
    for (int k = 0; k < 50; ++k) {
      std::array<double, 4> l{random.uniform(), random.uniform(), random.uniform(), random.uniform()};
      const double sum = l[0] + l[1] + l[2] + l[3];
      for (double& v : l) v /= sum;
      const double j = jacobian_at(x, l);
      CHECK(j >= *low - 1e-12);
      CHECK(j <= *high + 1e-12);
    }
    CHECK(c[0] == doctest::Approx(jacobian_at(x, {1, 0, 0, 0})));
    CHECK(c[19] == doctest::Approx(jacobian_at(x, {0, 0, 0, 1})));
  }
}

TEST_CASE("planar boundaries stay straight") {
  auto s = sample::box(3, 0.2);
  const Geometry geometry(s.plc, s.records);
  Context context;
  const auto order = make_second_order(s.mesh, geometry, context);
  CHECK(check_promises(s, order, geometry) == doctest::Approx(1));
  CHECK(order.straightened.empty());
}

TEST_CASE("coarse balls have their middles on the sphere and no inverted element") {
  for (int levels = 0; levels < 3; ++levels) {
    auto s = sample::ball(10, levels);
    const Geometry geometry(s.plc, s.records);
    Context context;
    const auto order = make_second_order(s.mesh, geometry, context);
    CHECK(order.straightened.empty());
    check_promises(s, order, geometry);
    for (Index node : order.triangle_nodes[0])
      CHECK(norm(order.points[node - s.mesh.points.size()]) == doctest::Approx(10).epsilon(1e-12));
  }
}

TEST_CASE("coarse cylinders are valid") {
  for (const int sectors : {5, 6, 8, 16}) {
    auto s = sample::cylinder(10, 30, sectors, 3);
    const Geometry geometry(s.plc, s.records);
    Context context;
    const auto order = make_second_order(s.mesh, geometry, context);
    check_promises(s, order, geometry);
    CHECK(order.straightened.empty());
  }
}

TEST_CASE("interior nodes give way to a surface that bends into the elements") {
  const std::vector<std::pair<int, double>> cases = {{0, 0.5}, {0, 0.4}, {1, 0.2}, {1, 0.15}};
  for (const auto& [levels, gap] : cases) {
    CAPTURE(gap);
    auto s = sample::shell({1, 1 + gap, 2.5}, levels);
    const Geometry geometry(s.plc, s.records);
    Context context;
    const auto order = make_second_order(s.mesh, geometry, context);
    check_promises(s, order, geometry);
    CHECK(order.straightened.empty());
  }
}

TEST_CASE("what cannot be bent is straightened and listed") {
  // The base lies on a sphere that bulges above the apex; the other faces are planes.
  sample::Sample s;
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * std::numbers::pi * i / 3;
    s.mesh.points.push_back({0.8 * std::cos(a), 0.8 * std::sin(a), 0.6});
  }
  s.mesh.points.push_back({0, 0, 0.75});
  s.mesh.point_entity.assign(4, {0, 0});
  s.mesh.tets = {{0, 1, 2, 3}};
  sample::link(s.mesh);
  Index plane = 0;
  sample::add_boundary(s.mesh, [&](const Triangle& t) { return t[0] + t[1] + t[2] == 3 ? 0 : ++plane; });
  for (std::size_t k = 0; k < s.mesh.triangles.size(); ++k)
    if (s.mesh.triangle_face[k] == 0)
      std::swap(s.mesh.triangles[k], s.mesh.triangles[3]),
          std::swap(s.mesh.triangle_face[k], s.mesh.triangle_face[3]);
  s.records.faces.resize(4);
  s.records.faces[0] = sample::sphere(1);
  s.plc = sample::boundary_plc(s.mesh, 4, 0);
  const Geometry geometry(s.plc, s.records);
  Context context;
  const auto order = make_second_order(s.mesh, geometry, context);
  CHECK(order.straightened == std::vector<Index>{0});
  check_promises(s, order, geometry);
}

TEST_CASE("elements without volume end the repair of the second order, too") {
  sample::Sample s;
  for (int i = 0; i < 5; ++i)  // on a great circle: bent or straight, they have no volume
    s.mesh.points.push_back({std::cos(1.2 * i), std::sin(1.2 * i), 0});
  s.mesh.point_entity.assign(5, {0, 0});
  s.mesh.tets = {{0, 1, 2, 3}, {4, 1, 2, 3}};
  sample::link(s.mesh);
  Index plane = -1;
  sample::add_boundary(s.mesh, [&](const Triangle&) { return ++plane; });
  s.records.faces.assign(s.mesh.triangles.size(), sample::sphere(1));
  s.plc = sample::boundary_plc(s.mesh, static_cast<Index>(s.mesh.triangles.size()), 0);
  const Geometry geometry(s.plc, s.records);
  Context context;
  const auto order = make_second_order(s.mesh, geometry, context);
  CHECK(order.straightened.size() == 2);
}

// A prism between two triangles at heights `floor` and `roof`; all elements share an interior point at height
// `apex`.  The floor stands for a piece of the unit sphere, which can bulge above that point; the other faces
// are planes.
sample::Sample prism_over_sphere(double floor, double apex, double roof) {
  sample::Sample s;
  const double radius = std::sqrt(1 - floor * floor);
  for (const double z : {floor, roof})
    for (int i = 0; i < 3; ++i) {
      const double a = 2 * std::numbers::pi * i / 3;
      s.mesh.points.push_back({radius * std::cos(a), radius * std::sin(a), z});
    }
  s.mesh.points.push_back({0, 0, apex});
  s.mesh.point_entity.assign(6, {0, 0});
  s.mesh.point_entity.push_back({3, 1});
  s.mesh.tets = {{0, 1, 2, 6}, {3, 5, 4, 6}};
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3;
    s.mesh.tets.push_back({i, 3 + i, j, 6});
    s.mesh.tets.push_back({j, 3 + i, 3 + j, 6});
  }
  sample::link(s.mesh);
  Index plane = 0;
  sample::add_boundary(s.mesh, [&](const Triangle& t) { return t[0] + t[1] + t[2] == 3 ? 0 : ++plane; });
  for (std::size_t k = 0; k < s.mesh.triangles.size(); ++k)
    if (s.mesh.triangle_face[k] == 0) {
      std::swap(s.mesh.triangles[k], s.mesh.triangles.back());
      std::swap(s.mesh.triangle_face[k], s.mesh.triangle_face.back());
    }
  s.records.faces.resize(8);
  s.records.faces[0] = sample::sphere(1);
  s.plc = sample::boundary_plc(s.mesh, 8, 0);
  return s;
}

TEST_CASE("a corner that moves out of the way of a bulge inverts no straight element") {
  Random random(7);
  for (int trial = 0; trial < 300; ++trial) {
    const double floor = 0.05 + 0.6 * random.uniform(), roof = floor + 0.1 + random.uniform();
    const double apex = floor + (roof - floor) * (0.1 + 0.8 * random.uniform());
    auto s = prism_over_sphere(floor, apex, roof);
    const Geometry geometry(s.plc, s.records);
    Context context;
    const auto order = make_second_order(s.mesh, geometry, context);
    for (const Tet& t : s.mesh.tets) {
      const Vec3& a = s.mesh.points[t[0]];
      CHECK(dot(area_vector(a, s.mesh.points[t[1]], s.mesh.points[t[2]]), s.mesh.points[t[3]] - a) > 0);
    }
    check_promises(s, order, geometry);
  }
}

TEST_CASE("same mesh, same bytes, for the second order too") {
  auto a = sample::cylinder(10, 30, 5, 3), b = a;
  const Geometry geometry(a.plc, a.records);
  Context context;
  const auto first = make_second_order(a.mesh, geometry, context),
             second = make_second_order(b.mesh, geometry, context);
  CHECK(first.points == second.points);
  CHECK(first.tet_nodes == second.tet_nodes);
}

TEST_CASE("the order stage can be cancelled") {
  auto s = sample::ball(10, 1);
  const Geometry geometry(s.plc, s.records);
  Context context([](const char*, double) { return false; });
  CHECK_THROWS_AS(make_second_order(s.mesh, geometry, context), Cancelled);
}
