// Sites on the boundary: whatever is proposed, what is accepted leaves a boundary that passes all checks.
#include "refinement/boundary_site.h"

#include <doctest/doctest.h>

#include "../surfaces/shapes.h"
#include "base/random.h"
#include "refinement/boundary_lengths.h"
#include "surfaces/remesh.h"

using namespace dm;

namespace {

constexpr double kSize = 6;
constexpr int kSitesOfTriangle = 20, kSitesOfSegment = 5;

struct Meshed {
  Geometry geometry;
  Context context;
  SizeField size;
  SurfaceMesh surface;

  explicit Meshed(const shapes::Shape& s)
      : geometry(s.plc, s.records),
        size(s.plc, geometry, options(), context),
        surface(mesh_surfaces(s.plc, geometry, size, {}, context)) {}
  static SizeOptions options() {
    SizeOptions o;
    o.max_size = kSize;
    return o;
  }
};

// Proposes sites at random places on all triangles and segments, each on a fresh copy of the mesh; checks it
// after those that are taken and returns their number.
int check_sites(const LabelledTriangulation& mesh, const Geometry& geometry, const SizeField& size) {
  const LengthField lengths = lengths_inside(mesh, size);
  const RadiusBound bound{lengths};
  const auto& points = mesh.tets.points();
  int taken = 0;
  const auto propose = [&](const Vec3& site, Index start, Index t, Index a, Index b) {
    LabelledTriangulation copy = mesh;
    BoundarySite boundary_site(copy, bound, 1);
    if (boundary_site.propose(site, copy.tets.vertex_tet(start), t, a, b) != SiteVerdict::ok) return;
    boundary_site.commit();
    check_boundary(copy);
    ++taken;
  };
  for (Index t = 0; t < mesh.boundary.slot_count(); ++t) {
    if (!mesh.boundary.alive(t)) continue;
    const auto [a, b, c] = mesh.boundary.corners(t);
    const Sphere circle = circumcircle(points[a], points[b], points[c]);
    for (int k = 0; k < kSitesOfTriangle; ++k) {
      Random random(1, t, k);
      const Vec3 near = circle.centre + 2 * std::sqrt(circle.radius2) * random.in_ball();
      propose(geometry.project_to_face(mesh.boundary.face(t), near), a, t, -1, -1);
    }
  }
  for (const auto& [key, edge] : mesh.boundary.segments()) {
    const auto [a, b] = BoundaryComplex::segment_of_key(key);
    for (int k = 0; k < kSitesOfSegment; ++k) {
      const double w = (k + 1.0) / (kSitesOfSegment + 1);
      propose(geometry.project_to_edge(edge, (1 - w) * points[a] + w * points[b]), a, -1, a, b);
    }
  }
  return taken;
}

}  // namespace

TEST_CASE("boundary sites keep the boundary whole, also where three faces meet in an edge") {
  for (const shapes::Shape& shape : {shapes::two_boxes(), shapes::box(12, 10, 1), shapes::sphere(5, 16)}) {
    Meshed m(shape);
    RecoveryReport report;
    const auto mesh = recover_boundary(m.surface, shape.plc, m.geometry, m.size, m.context, report);
    CHECK(check_sites(mesh, m.geometry, m.size) > 20);
  }
}

// So it is where recovery has replaced triangles: found at 27 ellipsoids in a box that touch each other.
TEST_CASE("boundary sites keep the boundary whole where faces meet without a CAD edge") {
  for (const shapes::Shape& shape : {shapes::two_boxes(), shapes::box(12, 10, 1)}) {
    Meshed m(shape);
    m.surface.segments.clear();
    m.surface.segment_edge.clear();
    RecoveryReport report;
    const auto mesh = recover_boundary(m.surface, shape.plc, m.geometry, m.size, m.context, report);
    CHECK(check_sites(mesh, m.geometry, m.size) > 20);
  }
}
