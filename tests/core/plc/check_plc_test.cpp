#include <doctest/doctest.h>

#include <limits>
#include <string>

#include "shapes.h"

using namespace dm;
using namespace dm::test;

namespace {

struct Found {
  std::string code, message;
  Entity entity, other;
  Vec3 place;
};

Found defect(const Plc& plc) {
  try {
    Context context;
    check_plc(plc, context);
  } catch (const Failure& failure) {
    CHECK(failure.stage == "plc");
    return {failure.code, failure.what(), failure.entity, failure.other, failure.place};
  }
  return {"none", "", {}, {}, {}};
}

}  // namespace

TEST_CASE("valid complexes pass at every scale") {
  CHECK(defect(box()).code == "none");
  CHECK(defect(two_boxes()).code == "none");
  for (double scale : {1e-3, 1e3, 1e6}) CHECK(defect(box(scale, 2 * scale, 0.5 * scale)).code == "none");
  CHECK(defect(box(1000, 1000, 1e-4)).code == "none");
}

TEST_CASE("a sheet inside a solid and a cavity are legal") {
  Plc plc = box(10, 10, 10);
  const Plc inner = box();
  const Index first = static_cast<Index>(plc.points.size());
  for (const Vec3& p : inner.points) plc.points.push_back(p + Vec3{4, 4, 4});
  for (std::size_t i = 0; i < inner.triangles.size(); ++i) {
    Triangle t = inner.triangles[i];
    for (Index& v : t) v += first;
    plc.triangles.push_back(t);
    plc.triangle_face.push_back(6 + inner.triangle_face[i]);
  }
  plc.face_solids.resize(12, {0, 1});
  CHECK(defect(plc).code == "none");

  plc.points.insert(plc.points.end(), {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}});
  const Index a = static_cast<Index>(plc.points.size()) - 3;
  plc.triangles.push_back({a, a + 1, a + 2});
  plc.triangle_face.push_back(12);
  plc.face_solids.push_back({1, 1});
  CHECK(defect(plc).code == "none");
}

TEST_CASE("two cubes that touch along an edge are one legal solid") {
  Plc plc = box();
  // Points 3 and 7 are the common edge.
  const Plc other = box();
  std::vector<Index> renumbered;
  for (Index i = 0; i < 8; ++i) {
    if (i == 0 || i == 4) {
      renumbered.push_back(i + 3);
    } else {
      renumbered.push_back(static_cast<Index>(plc.points.size()));
      plc.points.push_back(other.points[i] + Vec3{1, 1, 0});
    }
  }
  for (std::size_t i = 0; i < other.triangles.size(); ++i) {
    const Triangle& t = other.triangles[i];
    plc.triangles.push_back({renumbered[t[0]], renumbered[t[1]], renumbered[t[2]]});
    plc.triangle_face.push_back(6 + other.triangle_face[i]);
  }
  plc.face_solids.resize(12, {1, 0});
  CHECK(defect(plc).code == "none");
}

TEST_CASE("a missing triangle leaves a gap, with its face and place") {
  Plc plc = box();
  plc.triangles.pop_back();
  plc.triangle_face.pop_back();
  const Found found = defect(plc);
  CHECK(found.code == "open");
  CHECK(found.entity.dimension == 2);
  CHECK(found.place.x == doctest::Approx(1));
  CHECK(found.message.find("Face") != std::string::npos);
}

TEST_CASE("orientation") {
  Plc plc = box();
  std::swap(plc.triangles[4][0], plc.triangles[4][1]);
  CHECK(defect(plc).code == "orientation");

  plc = box();
  plc.face_solids[2] = {0, 1};
  const Found found = defect(plc);
  CHECK(found.code == "orientation");
  CHECK((found.entity == Entity{2, 2} || found.other == Entity{2, 2}));

  plc = box();
  for (auto& solids : plc.face_solids) solids = {0, 1};
  CHECK(defect(plc).code == "inside_out");
  CHECK(defect(plc).entity == Entity{3, 1});

  plc = two_boxes();
  plc.face_solids.back() = {2, 1};
  CHECK(defect(plc).code == "orientation");
  plc = two_boxes();
  plc.face_solids.back() = {1, 0};
  CHECK(defect(plc).code == "open");
}

TEST_CASE("points") {
  Plc plc = box();
  plc.points[5].y = std::numeric_limits<double>::quiet_NaN();
  CHECK(defect(plc).code == "not_a_number");
  plc.points[5].y = std::numeric_limits<double>::infinity();
  CHECK(defect(plc).code == "not_a_number");
  plc = box();
  plc.points.push_back(plc.points[3]);
  CHECK(defect(plc).code == "repeated_point");
  CHECK(defect(plc).place == plc.points[3]);
}

TEST_CASE("indices and lengths") {
  Plc plc = box();
  plc.triangles[7][1] = 8;
  CHECK(defect(plc).code == "bad_index");
  CHECK(defect(plc).entity == Entity{2, 3});
  plc = box();
  plc.triangles[7][1] = -1;
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.triangle_face[0] = 6;
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.face_solids[0][0] = 2;
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.segment_edge[0] = 12;
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.segments[0] = {2, 2};
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.corner_vertex[0] = 8;
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.kept_faces = {6};
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.kept_edges = {12};
  CHECK(defect(plc).code == "bad_index");
  plc = box();
  plc.triangles[7][1] = plc.triangles[7][0];
  CHECK(defect(plc).code == "collapsed_triangle");
  plc = box();
  plc.triangle_face.pop_back();
  CHECK(defect(plc).code == "bad_arrays");
  plc = box();
  plc.edge_count = -1;
  CHECK(defect(plc).code == "bad_arrays");
  CHECK(defect(Plc{}).code == "empty");
}

TEST_CASE("features lie on triangles") {
  Plc plc = box();
  plc.segments.push_back({0, 7});
  plc.segment_edge.push_back(4);
  CHECK(defect(plc).code == "loose_segment");
  CHECK(defect(plc).entity == Entity{1, 4});
  plc = box();
  plc.points.push_back({5, 5, 5});
  plc.corners.push_back(8);
  plc.corner_vertex.push_back(7);
  CHECK(defect(plc).code == "loose_corner");
  CHECK(defect(plc).entity == Entity{0, 7});
}

TEST_CASE("solids") {
  Plc plc = box();
  for (auto& solids : plc.face_solids) solids = {0, 0};
  CHECK(defect(plc).code == "not_a_solid");
  plc = box();
  plc.face_solids[3] = {0, 0};
  CHECK(defect(plc).code == "free_face");
  CHECK(defect(plc).entity == Entity{2, 3});
  plc = box();
  plc.solid_count = 2;
  CHECK(defect(plc).code == "empty_solid");
  plc.solid_count = kMostSolids;
  CHECK(defect(plc).code == "empty_solid");
  ++plc.solid_count;
  CHECK(defect(plc).code == "too_many_solids");
}

TEST_CASE("checking can be cancelled") {
  Context context([](const char*, double) { return false; });
  CHECK_THROWS_AS(check_plc(box(), context), Cancelled);
}

TEST_CASE("zero volume") {
  // A square, its two sides triangulated along different diagonals.
  Plc plc;
  plc.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  plc.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  plc.triangle_face = {0, 0, 1, 1};
  plc.face_solids = {{1, 0}, {1, 0}};
  plc.solid_count = 1;
  CHECK(defect(plc).code == "no_volume");
}

TEST_CASE("faces that coincide without being shared") {
  Plc plc = two_boxes();
  const std::size_t last = plc.triangles.size() - 2;
  plc.face_solids[6] = {1, 0};
  for (std::size_t i = last; i < last + 2; ++i) {
    const Triangle t = plc.triangles[i];
    plc.triangles.push_back({t[0], t[2], t[1]});
    plc.triangle_face.push_back(11);
  }
  plc.face_solids.resize(12, {2, 0});
  const Found found = defect(plc);
  CHECK(found.code == "coincident_faces");
}
