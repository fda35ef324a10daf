// The boundary stage: every label a face of the triangulation, every tetrahedron in its solid.
#include "boundary/recovery.h"

#include <doctest/doctest.h>

#include <map>
#include <numeric>

#include "../surfaces/shapes.h"
#include "boundary/partition.h"
#include "boundary/weld.h"
#include "surfaces/crossings.h"
#include "surfaces/remesh.h"

using namespace dm;

namespace {

struct Case {
  const char* name;
  shapes::Shape shape;
  double size;
};

std::vector<Case> cases() {
  return {{"box", shapes::box(6, 4, 3), 0.6},
          {"two boxes", shapes::two_boxes(), 0.4},
          {"tube", shapes::turned(5, 5, 8, 3, 24), 1.0},
          {"cone", shapes::turned(4, 0, 8, 0, 24), 1.0},
          {"sphere", shapes::sphere(5, 16), 1.2},
          {"torus", shapes::torus(8, 2, 24, 12), 1.0}};
}

struct Stages {
  Geometry geometry;
  Context context;
  SizeField size;
  SurfaceMesh surface;

  explicit Stages(const Case& c)
      : geometry(c.shape.plc, c.shape.records),
        size(c.shape.plc, geometry, options(c.size), context),
        surface(mesh_surfaces(c.shape.plc, geometry, size, {}, context)) {}
  static SizeOptions options(double h) {
    SizeOptions o;
    o.max_size = h;
    return o;
  }
};

double solid_volume(const LabelledTriangulation& mesh, int solid) {
  double volume = 0;
  for (Index t = 0; t < mesh.tets.slot_count(); ++t) {
    if (mesh.tets.is_free(t) || mesh.tets.is_ghost(t) || mesh.tets.tag(t) != solid) continue;
    const auto [a, b, c, d] = mesh.tets.corners(t);
    const auto& p = mesh.tets.points();
    volume += dot(area_vector(p[a], p[b], p[c]), p[d] - p[a]) / 6;
  }
  return volume;
}

double surface_volume(const SurfaceMesh& surface, const Plc& plc, Index solid) {
  double volume = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& s = plc.face_solids[surface.triangle_face[t]];
    const auto [a, b, c] = surface.triangles[t];
    const double v = dot(surface.points[a], cross(surface.points[b], surface.points[c])) / 6;
    volume += (s[0] == solid ? v : 0) - (s[1] == solid ? v : 0);
  }
  return volume;
}

}  // namespace

TEST_CASE("recovery: the labels are faces and the solids have the volume of their surface") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    Stages stages(c);
    RecoveryReport report;
    const auto mesh =
        recover_boundary(stages.surface, c.shape.plc, stages.geometry, stages.size, stages.context, report);
    mesh.tets.check(true);
    check_complex(mesh.boundary);
    check_boundary(mesh);
    CHECK(report.replaced == 0);
    for (Index solid = 1; solid <= c.shape.plc.solid_count; ++solid) {
      const double expected = surface_volume(stages.surface, c.shape.plc, solid);
      // Flips and splits on curved faces move the surface within its own faceting error.
      CHECK(solid_volume(mesh, solid) == doctest::Approx(expected).epsilon(2e-3));
    }
  }
}

TEST_CASE("recovery: every segment is an edge of the triangulation and keeps its CAD edge") {
  const Case c{"tube", shapes::turned(5, 5, 8, 3, 24), 1.0};
  Stages stages(c);
  RecoveryReport report;
  const auto mesh =
      recover_boundary(stages.surface, c.shape.plc, stages.geometry, stages.size, stages.context, report);
  CHECK(mesh.boundary.segments().size() >= stages.surface.segments.size());
  for (const auto& [key, edge] : mesh.boundary.segments()) {
    const auto [a, b] = BoundaryComplex::segment_of_key(key);
    for (const Index v : {a, b})
      CHECK(distance(mesh.tets.point(v), stages.geometry.project_to_edge(edge, mesh.tets.point(v))) < 1e-9);
  }
}

TEST_CASE("partition: a removed label is found again from the tetrahedra") {
  const Case c{"two boxes", shapes::two_boxes(), 0.4};
  Stages stages(c);
  RecoveryReport report;
  auto mesh =
      recover_boundary(stages.surface, c.shape.plc, stages.geometry, stages.size, stages.context, report);
  const double before[2] = {solid_volume(mesh, 1), solid_volume(mesh, 2)};
  std::vector<Index> missing;
  for (Index t = 0; t < mesh.boundary.slot_count(); t += 60) {
    if (!mesh.boundary.alive(t)) continue;
    const Triangle& q = mesh.boundary.corners(t);
    set_marked_both(mesh.tets, find_face(mesh.tets, q[0], q[1], q[2]), false);
    missing.push_back(t);
  }
  REQUIRE(missing.size() > 10);
  Context cancelled([](const char*, double) { return false; });
  auto copy = mesh;
  CHECK_THROWS_AS(partition_solids(copy, missing, cancelled), Cancelled);
  partition_solids(mesh, missing, stages.context);
  check_boundary(mesh);
  CHECK(solid_volume(mesh, 1) == doctest::Approx(before[0]).epsilon(0.02));
  CHECK(solid_volume(mesh, 2) == doctest::Approx(before[1]).epsilon(0.02));
}

TEST_CASE("complex: a segment that is an edge of no triangle any more is dropped, the others stay") {
  const Case c{"two boxes", shapes::two_boxes(), 0.4};
  const Stages stages(c);
  BoundaryComplex complex(stages.surface, c.shape.plc.face_solids);
  const std::size_t before = complex.segments().size();
  const auto [a, b] = BoundaryComplex::segment_of_key(complex.segments().begin()->first);
  BoundaryComplex::Fan fan;
  const int count = complex.triangles_at(a, b, fan);
  for (int i = 0; i < count; ++i) complex.remove(fan[i]);
  complex.drop_bare_segments();
  CHECK_FALSE(complex.is_segment(a, b));
  CHECK(complex.segments().size() < before);
  CHECK(complex.segments().size() >= before - 1 - 2 * static_cast<std::size_t>(count));
}

TEST_CASE("complex: many faces at one edge are all found, and too many are not left out in silence") {
  const auto fan_of = [](Index faces) {
    SurfaceMesh surface;
    surface.points = {{0, 0, 0}, {0, 0, 1}};
    for (Index k = 0; k < faces; ++k) {
      surface.points.push_back({std::cos(0.01 * k), std::sin(0.01 * k), 0});
      surface.triangles.push_back({0, 1, k + 2});
      surface.triangle_face.push_back(k);
    }
    surface.point_entity.assign(surface.points.size(), {0, 0});
    return BoundaryComplex(surface, std::vector<std::array<Index, 2>>(faces, {1, 2}));
  };
  BoundaryComplex::Fan fan;
  CHECK(fan_of(40).triangles_at(0, 1, fan) == 40);
  CHECK_THROWS_AS(fan_of(kMaxFan + 1).triangles_at(0, 1, fan), Failure);
}

TEST_CASE("tag_solids: an open boundary is noticed") {
  const Case c{"box", shapes::box(6, 4, 3), 0.6};
  Stages stages(c);
  RecoveryReport report;
  auto mesh =
      recover_boundary(stages.surface, c.shape.plc, stages.geometry, stages.size, stages.context, report);
  CHECK(tag_solids(mesh));
  Index t = 0;
  while (!mesh.boundary.alive(t)) ++t;
  const Triangle& q = mesh.boundary.corners(t);
  set_marked_both(mesh.tets, find_face(mesh.tets, q[0], q[1], q[2]), false);
  CHECK_FALSE(tag_solids(mesh));
  CHECK_THROWS_AS(check_boundary(mesh), Failure);
}

TEST_CASE("complex: a flip exchanges the diagonal and a flip back restores it") {
  SurfaceMesh surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  surface.point_entity.assign(4, {2, 0});
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  surface.triangle_face = {0, 0};
  BoundaryComplex complex(surface, {{1, 0}});
  EdgeFlip flip;
  REQUIRE(can_flip(complex, surface.points, 0, 2, flip));
  do_flip(complex, flip);
  CHECK(complex.find(0, 1, 3) >= 0);
  CHECK(complex.find(1, 2, 3) >= 0);
  CHECK(complex.find(0, 1, 2) < 0);
  CHECK_FALSE(can_flip(complex, surface.points, 0, 1, flip));  // an edge of one triangle
  REQUIRE(can_flip(complex, surface.points, 1, 3, flip));
  do_flip(complex, flip);
  CHECK(complex.find(0, 1, 2) >= 0);
}

TEST_CASE("corner_in_front agrees with the sign of the volume") {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Tet tet{0, 1, 2, 3};
  for (int i = 0; i < 4; ++i) {
    Triangle t{tet[(i + 1) & 3], tet[(i + 2) & 3], tet[(i + 3) & 3]};
    for (int turn = 0; turn < 2; ++turn) {
      const bool front = dot(area_vector(p[t[0]], p[t[1]], p[t[2]]), p[i] - p[t[0]]) > 0;
      CHECK(corner_in_front(tet, i, t) == front);
      std::swap(t[0], t[1]);
    }
  }
}

TEST_CASE("find_crossings: proper crossings only") {
  const std::vector<Vec3> p = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1},
                               {2, 1, 1}, {0, 0, 5}, {4, 0, 5}, {4, 4, 0}};
  Context context;
  CHECK(find_crossings(p, {{0, 1, 2}, {3, 4, 5}}, context).size() == 1);
  CHECK(find_crossings(p, {{0, 1, 2}, {0, 1, 6}}, context).empty());      // a shared edge
  CHECK(find_crossings(p, {{0, 1, 2}, {4, 5, 6}}, context).empty());      // apart
  CHECK(find_crossings(p, {{0, 1, 2}, {1, 2, 8}}, context).empty());      // coplanar neighbours
  CHECK(find_crossings(p, {{0, 3, 4}, {0, 1, 2}}, context).size() == 1);  // through, from a shared corner
}

namespace {

using Row = std::vector<Index>;

// A box whose top has a strip of width 0.01 between two CAD edges, with points on one of
// them opposite the middles of the other's parts.
struct StripBox {
  Plc plc;
  GeometryRecords records;
  SurfaceMesh surface;
  static constexpr double kWidth = 0.01;

  StripBox() {
    for (int i = 0; i <= 10; ++i) {
      xs.push_back(0.1 * i);
      ys.push_back(i <= 5 ? 0.1 * i : 0.1 * (i - 1) + kWidth);
      zs.push_back(0.1 * i);
    }
    ys.push_back(1 + kWidth);
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
      const double middle = 0.5 * (ys[j] + ys[j + 1]);
      loft(top_row(j), top_row(j + 1), middle < 0.5 ? 0 : middle < 0.5 + kWidth ? 1 : 2);
      loft(row(xs,
               [&](double x) {
                 return Vec3{x, ys[j + 1], 0};
               }),
           row(xs,
               [&](double x) {
                 return Vec3{x, ys[j], 0};
               }),
           3);
    }
    for (int k = 0; k < 10; ++k) {
      const double low = zs[k], high = zs[k + 1];
      for (const int end : {0, 1}) {
        const auto side = [&](double z) { return row(ys, [&](double y) { return Vec3{1.0 * end, y, z}; }); };
        const auto wall = [&](double z) {
          return row(xs, [&](double x) { return Vec3{x, end * (1 + kWidth), z}; });
        };
        loft(side(end ? low : high), side(end ? high : low), 4 + end);
        loft(wall(end ? high : low), wall(end ? low : high), 6 + end);
      }
    }
    plc.face_solids.assign(8, {1, 0});
    plc.solid_count = 1;
    plc.triangles = surface.triangles;
    plc.triangle_face = surface.triangle_face;
    plc.points = surface.points;
    records.faces.assign(8, {});
    add_segments();
  }

 private:
  std::vector<double> xs, ys, zs;

  Index point(const Vec3& p) {
    for (std::size_t i = 0; i < surface.points.size(); ++i)
      if (distance(surface.points[i], p) < 1e-9) return static_cast<Index>(i);
    surface.points.push_back(p);
    return static_cast<Index>(surface.points.size()) - 1;
  }
  template <class Place>
  Row row(const std::vector<double>& values, Place place) {
    Row out;
    for (const double value : values) out.push_back(point(place(value)));
    return out;
  }
  Row top_row(std::size_t j) {
    std::vector<double> values(xs);
    if (j == 6) {
      values = {0};
      for (int i = 0; i < 10; ++i) values.push_back(0.05 + 0.1 * i);
      values.push_back(1);
    }
    return row(values, [&](double x) { return Vec3{x, ys[j], 1}; });
  }
  void add(Index a, Index b, Index c, Index face) {
    surface.triangles.push_back({a, b, c});
    surface.triangle_face.push_back(face);
  }
  // Triangles between two rows, counter-clockwise seen from in front when `to` lies left of `from`.
  void loft(const Row& from, const Row& to, Index face) {
    const auto& p = surface.points;
    for (std::size_t i = 0, j = 0; i + 1 < from.size() || j + 1 < to.size();) {
      const bool can_i = i + 1 < from.size(), can_j = j + 1 < to.size();
      if (can_i && (!can_j || norm2(p[from[i + 1]] - p[to[j]]) <= norm2(p[to[j + 1]] - p[from[i]]))) {
        add(from[i], from[i + 1], to[j], face);
        ++i;
      } else {
        add(from[i], to[j + 1], to[j], face);
        ++j;
      }
    }
  }
  // An edge between two triangles of different faces is a segment; its number is that of the pair of faces.
  void add_segments() {
    std::map<std::pair<Index, Index>, Index> owner;
    std::map<std::pair<Index, Index>, Index> edges;
    surface.point_entity.assign(surface.points.size(), Entity{2, 0});
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Index a = surface.triangles[t][i], b = surface.triangles[t][(i + 1) % 3];
        const Index face = surface.triangle_face[t];
        const auto [it, is_new] = owner.try_emplace(std::minmax(a, b), face);
        if (is_new || it->second == face) continue;
        const auto pair = std::minmax(face, it->second);
        const Index edge = edges.try_emplace(pair, static_cast<Index>(edges.size())).first->second;
        surface.segments.push_back({a, b});
        surface.segment_edge.push_back(edge);
        for (const Index v : {a, b}) surface.point_entity[v] = {1, edge};
      }
    plc.segments = surface.segments;
    plc.segment_edge = surface.segment_edge;
    plc.edge_count = static_cast<Index>(edges.size());
    records.edges.assign(edges.size(), {});
  }
};

}  // namespace

TEST_CASE("recovery: very obtuse triangles in a narrow strip are split where they lie") {
  const StripBox box;
  const Geometry geometry(box.plc, box.records);
  Context context;
  const SizeField size(box.plc, geometry, Stages::options(0.125), context);
  RecoveryReport report;
  const auto mesh = recover_boundary(box.surface, box.plc, geometry, size, context, report);
  check_boundary(mesh);
  CHECK(report.missing_at_start > 0);
  CHECK(report.replaced == 0);
  CHECK(report.segment_splits + report.triangle_splits < 100);
  CHECK(solid_volume(mesh, 1) == doctest::Approx(1 + StripBox::kWidth).epsilon(1e-9));
  double area = 0;
  for (Index t = 0; t < mesh.boundary.slot_count(); ++t) {
    if (!mesh.boundary.alive(t)) continue;
    const auto& [a, b, c] = mesh.boundary.corners(t);
    area += 0.5 * norm(area_vector(mesh.tets.point(a), mesh.tets.point(b), mesh.tets.point(c)));
  }
  CHECK(area == doctest::Approx(6 + 4 * StripBox::kWidth).epsilon(1e-9));
}

TEST_CASE("recovery: where faces cross, no points are put in, and the solid is what they enclose together") {
  Case c{"two boxes that cross, one solid", {}, 0.5};
  shapes::box_walls(c.shape, {0, 0, 0}, {4, 4, 4}, 1, false, 0);
  shapes::box_walls(c.shape, {1.3, 1.1, 2.2}, {2.9, 2.7, 6.1}, 1, false, 0);
  Stages stages(c);
  RecoveryReport report;
  const auto mesh =
      recover_boundary(stages.surface, c.shape.plc, stages.geometry, stages.size, stages.context, report);
  check_boundary(mesh);
  CHECK(report.replaced > 0);
  CHECK(report.segment_splits + report.triangle_splits == 0);
  CHECK(std::binary_search(report.unrecovered_faces.begin(), report.unrecovered_faces.end(), 5));
  CHECK(report.unrecovered_faces.back() >= 6);
  const double both = 4 * 4 * 4 + 1.6 * 1.6 * (6.1 - 4);
  CHECK(solid_volume(mesh, 1) == doctest::Approx(both).epsilon(0.01));
  int bare = 0;
  for (Index v = 0; v < mesh.tets.vertex_count(); ++v)
    bare += mesh.boundary.on_boundary(v) && mesh.boundary.triangles_at(v).empty();
  CHECK(bare == 0);
}

TEST_CASE("weld: points far from each other stay apart") {
  const Case c{"two boxes", shapes::two_boxes(), 0.8};
  Stages stages(c);
  RecoveryReport report;
  const auto mesh =
      recover_boundary(stages.surface, c.shape.plc, stages.geometry, stages.size, stages.context, report);
  std::vector<Index> all(mesh.tets.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  SurfaceMesh welded;
  CHECK_FALSE(weld_points(mesh, c.shape.plc, all, welded));
}

TEST_CASE("recovery: sheets that cross at next to no angle become one") {
  shapes::Shape shape;
  shapes::box_walls(shape, {0, 0, 0}, {4, 4, 4}, 1, false, 0);
  shapes::box_walls(shape, {0.9, 1.1, 2}, {3, 2.9, 4 + 1e-3}, 1, false, 0);
  const Geometry geometry(shape.plc, shape.records);
  Context context;
  SizeOptions options = Stages::options(0.5);
  options.elements_across = 0;
  const SizeField size(shape.plc, geometry, options, context);
  RecoveryReport report;
  const auto mesh = recover_boundary(mesh_surfaces(shape.plc, geometry, size, {}, context), shape.plc,
                                     geometry, size, context, report);
  check_boundary(mesh);
  CHECK(report.replaced > 0);
  CHECK(solid_volume(mesh, 1) == doctest::Approx(64).epsilon(1e-3));
  double shortest = HUGE_VAL;
  for (Index t = 0; t < mesh.boundary.slot_count(); ++t) {
    if (!mesh.boundary.alive(t)) continue;
    const auto& q = mesh.boundary.corners(t);
    for (int i = 0; i < 3; ++i)
      shortest = std::min(shortest, distance(mesh.tets.point(q[i]), mesh.tets.point(q[(i + 1) % 3])));
  }
  CHECK(shortest > 0.01);
}
