#include "curves/sample_curves.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/random.h"
#include "curves/chains.h"
#include "curves/curve_changes.h"
#include "curves/length_field.h"

using namespace dm;

namespace {

// A wedge of a disc, thickened: what matters here are its edges.  One full circle (edge 0, n segments, a
// corner at its start), a loop without corner (edge 1) and a straight edge (edge 2) between two corners.
struct Curves {
  Plc plc;
  GeometryRecords records;
  explicit Curves(int n, double length) {
    const double turn = 2 * std::numbers::pi;
    for (int loop = 0; loop < 2; ++loop) {
      const Index base = static_cast<Index>(plc.points.size());
      for (int i = 0; i < n; ++i) {
        plc.points.push_back({10 * std::cos(turn * i / n), 10 * std::sin(turn * i / n), 5.0 * loop});
        plc.segments.push_back({base + i, base + (i + 1) % n});
        plc.segment_edge.push_back(loop);
      }
      records.edges.push_back({CurveKind::circle, {0, 0, 5.0 * loop}, {0, 0, 1}, 10, -1});
    }
    const Index a = static_cast<Index>(plc.points.size());
    plc.points.push_back({20, 0, 0});
    plc.points.push_back({20 + length, 0, 0});
    plc.segments.push_back({a + 1, a});  // against the chain's direction
    plc.segment_edge.push_back(2);
    records.edges.push_back({CurveKind::line, {20, 0, 0}, {1, 0, 0}, 0, -1});
    plc.corners = {0, a, a + 1};
    plc.corner_vertex = {0, 1, 2};
    plc.edge_count = plc.vertex_count = 3;
    plc.triangles.push_back({0, a, a + 1});
    plc.triangle_face.push_back(0);
    plc.face_solids.push_back({1, 0});
    plc.solid_count = 1;
    records.faces.push_back({});
  }
};

CurveSampling sample(const Curves& c, double size, CurveOptions options = {}) {
  const Geometry geometry(c.plc, c.records);
  Context context;
  SizeOptions sizes;
  sizes.max_size = size;
  sizes.elements_per_circle = sizes.elements_across = 0;
  const SizeField field(c.plc, geometry, sizes, context);
  return sample_curves(c.plc, geometry, LengthField(field, 0.8), options, context);
}

Index count_segments(const CurveSampling& s, Index edge) {
  return static_cast<Index>(std::count(s.segment_edge.begin(), s.segment_edge.end(), edge));
}

}  // namespace

TEST_CASE("chains: from corner to corner, and loops without one") {
  const Curves c(12, 4);
  const auto chains = find_chains(c.plc, {});
  REQUIRE(chains.size() == 3);
  for (const Chain& chain : chains) {
    CHECK(chain.points.size() == chain.segments.size() + 1);
    CHECK(chain.closed() == (chain.edge != 2));
  }
  std::vector<char> keep(c.plc.points.size(), 0);
  keep[3] = keep[6] = 1;
  CHECK(find_chains(c.plc, keep).size() == 5);
}

TEST_CASE("samples lie on the exact curve, evenly, and follow the wanted length") {
  const Curves c(10, 33);
  const CurveSampling s = sample(c, 2.5, {0, {}});
  const Geometry geometry(c.plc, c.records);
  CHECK(count_segments(s, 0) == 31);  // 20 pi / 2 = 31.4
  CHECK(count_segments(s, 1) == 31);
  CHECK(count_segments(s, 2) == 17);  // 16.5: nearer to 17 parts by ratio
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    const auto [a, b] = s.segments[i];
    const Index edge = s.segment_edge[i];
    CHECK(s.role[a] == CurvePointRole::fixed);
    CHECK(distance(geometry.project_to_edge(edge, s.points[a]), s.points[a]) < 1e-9);
    CHECK(distance(s.points[a], s.points[b]) == doctest::Approx(2).epsilon(0.06));
  }
}

TEST_CASE("samples are listed along their segments") {
  const Curves c(7, 33);
  const CurveSampling s = sample(c, 1);
  REQUIRE(s.first.size() == c.plc.segments.size() + 1);
  for (std::size_t k = 0; k < c.plc.segments.size(); ++k) {
    const Vec3 start = c.plc.points[c.plc.segments[k][0]];
    double last = 0;
    for (Index i = s.first[k]; i < s.first[k + 1]; ++i) {
      const double d = distance(start, s.points[s.inserted[i]]);
      CHECK(d > last);
      last = d;
    }
  }
}

TEST_CASE("a coarse size keeps circles round and short edges whole") {
  const Curves c(24, 0.01);
  const CurveSampling s = sample(c, 1000);
  CHECK(count_segments(s, 0) == 4);
  CHECK(count_segments(s, 1) == 4);
  CHECK(count_segments(s, 2) == 1);
}

TEST_CASE("points asked to stay do") {
  const Curves c(24, 4);
  CurveOptions options;
  options.keep.assign(c.plc.points.size(), 0);
  options.keep[5] = 1;
  const CurveSampling s = sample(c, 100, options);
  CHECK(s.role[5] == CurvePointRole::fixed);
  CHECK(s.points[5] == c.plc.points[5]);
}

TEST_CASE("nothing is inserted between frozen points, and unchanged edges keep their samples") {
  const Curves c(24, 4);
  const CurveSampling before = sample(c, 1);
  CurveOptions options;
  options.keep.assign(c.plc.points.size(), 0);
  for (Index p = 0; p < 24; ++p) options.keep[p] = 2;
  const CurveSampling after = sample(c, 1, options);
  CHECK(count_segments(before, 0) > 24);
  CHECK(count_segments(after, 0) == 24);
  const CurveChanges changes(before, after, c.plc.edge_count);
  CHECK(changes.edge_changed(0));
  CHECK(!changes.edge_changed(1));
  for (std::size_t s = 0; s < before.segments.size(); ++s)
    if (before.segment_edge[s] != 0)
      for (const Index p : before.segments[s]) CHECK(before.points[p] == after.points[changes.new_number(p)]);
}

namespace {

struct TenEverywhere {
  Curves curves{24, 4};
  Geometry geometry{curves.plc, curves.records};
  Context context;
  SizeField size{curves.plc, geometry, options(), context};
  static SizeOptions options() {
    SizeOptions sizes;
    sizes.max_size = 10;
    sizes.elements_per_circle = sizes.elements_across = 0;
    return sizes;
  }
};

}  // namespace

TEST_CASE("caps and floors of the length field") {
  const TenEverywhere field;
  LengthField lengths(field.size, 0.8);
  CHECK(lengths.at({0, 0, 0}) == doctest::Approx(8));
  lengths.add_cap({0, 0, 0}, 1);
  lengths.add_cap({5, 0, 0}, 20);  // no effect
  CHECK(lengths.apply_caps().size() == 1);
  CHECK(lengths.at({0, 0, 0}) == doctest::Approx(1));
  CHECK(lengths.at({2, 0, 0}) == doctest::Approx(2));
  CHECK(lengths.at({40, 0, 0}) == doctest::Approx(8));
  lengths.add_floor({0, 0, 0}, 3);
  CHECK(lengths.apply_caps().empty());
  CHECK(lengths.at({0, 0, 0}) == doctest::Approx(3));
  CHECK(lengths.at({1, 0, 0}) == doctest::Approx(2.5));
}

TEST_CASE("many caps and floors: the walk in the tree finds what asking each place finds") {
  const TenEverywhere field;
  constexpr double growth = 0.5;
  for (const int floor_count : {0, 7}) {
    LengthField lengths(field.size, 0.8);
    std::vector<std::pair<Vec3, double>> caps, floors;
    Random random(3, floor_count);
    const auto place = [&] {
      return Vec3{10 * random.symmetric(), 10 * random.symmetric(), 2 * random.symmetric()};
    };
    for (int i = 0; i < 200; ++i) {
      caps.push_back({place(), 1 + std::abs(random.symmetric())});
      lengths.add_cap(caps.back().first, caps.back().second);
      if (i == 120) lengths.apply_caps();  // the tree is built again
    }
    for (int i = 0; i < floor_count; ++i) {
      floors.push_back({place(), 3});
      lengths.add_floor(floors.back().first, floors.back().second);
    }
    lengths.apply_caps();
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = 1.5 * place();
      double wanted = 8;
      for (const auto& [at, value] : caps) wanted = std::min(wanted, value + growth * distance(at, p));
      for (const auto& [at, value] : floors) wanted = std::max(wanted, value - growth * distance(at, p));
      CHECK(lengths.at(p) == doctest::Approx(wanted));
      const double low = 1 + 3 * std::abs(random.symmetric()), high = low + 1;
      const double found = lengths.at_between(p, low, high);
      if (wanted <= low) CHECK(found <= low);
      if (wanted >= high) CHECK(found >= high);
      if (low < wanted && wanted < high) CHECK(found == doctest::Approx(wanted));
    }
  }
}

namespace {

// Two straight edges along x, `gap` apart, the second longer and shifted, so that equal parts do not match.
CurveSampling sample_strip(double gap) {
  Plc plc;
  plc.points = {{0, 0, 0}, {10, 0, 0}, {-0.37, gap, 0}, {10.9, gap, 0}};
  plc.segments = {{0, 1}, {2, 3}};
  plc.segment_edge = {0, 1};
  plc.corners = plc.corner_vertex = {0, 1, 2, 3};
  plc.edge_count = 2;
  plc.vertex_count = 4;
  plc.triangles = {{0, 1, 3}};
  plc.triangle_face = {0};
  plc.face_solids = {{1, 0}};
  plc.solid_count = 1;
  GeometryRecords records;
  records.faces.push_back({});
  records.edges.push_back({CurveKind::line, {0, 0, 0}, {1, 0, 0}, 0, -1});
  records.edges.push_back({CurveKind::line, {0, gap, 0}, {1, 0, 0}, 0, -1});
  const Geometry geometry(plc, records);
  Context context;
  SizeOptions sizes;
  sizes.max_size = 1;
  sizes.elements_per_circle = sizes.elements_across = 0;
  const SizeField field(plc, geometry, sizes, context);
  return sample_curves(plc, geometry, LengthField(field, 0.8), {}, context);
}

}  // namespace

TEST_CASE("samples of two curves closer together than their parts stand opposite each other") {
  for (const double gap : {0.2, 0.02, 1e-3, 1e-4}) {
    CAPTURE(gap);
    const CurveSampling s = sample_strip(gap);
    std::vector<double> first;
    for (std::size_t k = 0; k < s.segments.size(); ++k) {
      const double length = distance(s.points[s.segments[k][0]], s.points[s.segments[k][1]]);
      CHECK(length > 0.3);
      CHECK(length < 1.5);
      if (s.segment_edge[k] == 0) first.push_back(s.points[s.segments[k][1]].x);
    }
    for (const double x : first) {
      double nearest = HUGE_VAL;
      for (std::size_t k = 0; k < s.segments.size(); ++k)
        if (s.segment_edge[k] == 1)
          for (const Index v : s.segments[k]) nearest = std::min(nearest, std::abs(s.points[v].x - x));
      CHECK(nearest < 0.11 * gap);
    }
  }
}
