#include "plc/geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "plc/analytic_curve.h"
#include "plc/analytic_surface.h"
#include "plc/facet_surface.h"

namespace dm {
namespace {

[[noreturn]] void bad_record(const std::string& what, Entity entity) {
  const std::string name = (entity.dimension == 2 ? "Face" : "Edge") + std::to_string(entity.index + 1);
  throw Failure("plc", "bad_geometry", name + ": " + what + ".", {}, entity);
}

bool finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
bool positive(double x) { return std::isfinite(x) && x > 0; }

void check_record(const SurfaceRecord& r, Index face, std::size_t splines) {
  const Entity entity{2, face};
  if (!finite(r.origin) || !finite(r.axis))
    bad_record("its surface has a coordinate that is not a number", entity);
  const bool needs_axis = r.kind == SurfaceKind::plane || r.kind == SurfaceKind::cylinder ||
                          r.kind == SurfaceKind::cone || r.kind == SurfaceKind::torus;
  if (needs_axis && norm2(r.axis) == 0) bad_record("its surface has no direction", entity);
  const bool round =
      r.kind == SurfaceKind::cylinder || r.kind == SurfaceKind::sphere || r.kind == SurfaceKind::torus;
  if (round && !positive(r.a)) bad_record("its radius is not a positive number", entity);
  if (r.kind == SurfaceKind::torus && !positive(r.b))
    bad_record("its minor radius is not a positive number", entity);
  if (r.kind == SurfaceKind::cone && !(positive(r.a) && r.a < 0.5 * std::numbers::pi)) {
    bad_record("the half angle of its cone is not between 0 and 90 degrees", entity);
  }
  if (r.kind == SurfaceKind::spline && (r.spline < 0 || static_cast<std::size_t>(r.spline) >= splines)) {
    bad_record("its spline surface is missing", entity);
  }
  if (r.kind < SurfaceKind::facets || r.kind > SurfaceKind::spline)
    bad_record("unknown kind of surface", entity);
}

void check_record(const CurveRecord& r, Index edge, std::size_t splines) {
  const Entity entity{1, edge};
  if (!finite(r.origin) || !finite(r.axis))
    bad_record("its curve has a coordinate that is not a number", entity);
  const bool needs_axis = r.kind == CurveKind::line || r.kind == CurveKind::circle;
  if (needs_axis && norm2(r.axis) == 0) bad_record("its curve has no direction", entity);
  if (r.kind == CurveKind::circle && !positive(r.a))
    bad_record("its radius is not a positive number", entity);
  if (r.kind == CurveKind::spline && (r.spline < 0 || static_cast<std::size_t>(r.spline) >= splines)) {
    bad_record("its spline curve is missing", entity);
  }
  if (r.kind < CurveKind::polyline || r.kind > CurveKind::spline) bad_record("unknown kind of curve", entity);
}

// The PLC's triangles of one face, and where their middle is.
struct FacePatch {
  std::vector<TriangleItem> triangles;
  Vec3 centre;
};

std::vector<FacePatch> face_patches(const Plc& plc) {
  std::vector<FacePatch> patches(plc.face_solids.size());
  for (std::size_t i = 0; i < plc.triangles.size(); ++i) {
    const Triangle& t = plc.triangles[i];
    patches[plc.triangle_face[i]].triangles.emplace_back(plc.points[t[0]], plc.points[t[1]],
                                                         plc.points[t[2]]);
  }
  for (FacePatch& patch : patches) {
    double total = 0;
    for (const TriangleItem& t : patch.triangles) {
      const double weight = norm(t.area_normal()) + 1e-300;
      patch.centre += (weight / 3) * (t.corner(0) + t.corner(1) + t.corner(2));
      total += weight;
    }
    if (total > 0) patch.centre = (1 / total) * patch.centre;
  }
  return patches;
}

std::vector<EdgePath> edge_paths(const Plc& plc) {
  std::vector<EdgePath> paths(plc.edge_count);
  std::vector<std::map<Index, int>> uses(plc.edge_count);
  for (std::size_t i = 0; i < plc.segments.size(); ++i) {
    const auto [a, b] = plc.segments[i];
    const Index edge = plc.segment_edge[i];
    paths[edge].segments.push_back({plc.points[a], plc.points[b]});
    ++uses[edge][a], ++uses[edge][b];
  }
  for (Index edge = 0; edge < plc.edge_count; ++edge) {
    for (const auto& [point, count] : uses[edge]) {
      if (count == 1) paths[edge].ends.push_back(plc.points[point]);
    }
  }
  return paths;
}

std::unique_ptr<Surface> make_surface(const SurfaceRecord& record, const FacePatch& patch) {
  switch (record.kind) {
    case SurfaceKind::facets:
    case SurfaceKind::spline:
      if (patch.triangles.empty()) return std::make_unique<NoSurface>();
      return std::make_unique<FacetSurface>(patch.triangles);
    default: {
      auto surface = std::make_unique<AnalyticSurface>(record, patch.centre);
      std::vector<Vec3> points;
      for (const TriangleItem& t : patch.triangles) {
        for (int k = 0; k < 3; ++k) points.push_back(t.corner(k));
      }
      surface->restrict_sheets(points);
      return surface;
    }
  }
}

std::unique_ptr<Curve> make_curve(const CurveRecord& record, const EdgePath& path) {
  switch (record.kind) {
    case CurveKind::line:
      return std::make_unique<LineCurve>(record, path);
    case CurveKind::circle:
      return std::make_unique<CircleCurve>(record, path);
    default: {
      if (path.segments.empty()) return std::make_unique<NoCurve>();
      std::vector<SegmentItem> segments;
      for (const auto& [a, b] : path.segments) segments.emplace_back(a, b);
      return std::make_unique<Polyline>(std::move(segments));
    }
  }
}

// +1 or -1 for each sheet: the side of the surface's own normal that the triangles' right-hand normal is on.
std::array<double, 2> sides(const Surface& surface, const FacePatch& patch) {
  constexpr std::size_t enough = 256;
  const std::size_t step = patch.triangles.size() / enough + 1;
  double sum[2] = {0, 0};
  for (std::size_t i = 0; i < patch.triangles.size(); i += step) {
    const TriangleItem& t = patch.triangles[i];
    const Vec3 centre = (1.0 / 3) * (t.corner(0) + t.corner(1) + t.corner(2));
    sum[surface.sheet(centre)] += dot(t.area_normal(), surface.normal(centre));
  }
  std::array<double, 2> result;
  for (int s = 0; s < 2; ++s) {
    const double own = sum[s] != 0 ? sum[s] : sum[1 - s];
    result[s] = own < 0 ? -1 : 1;
  }
  return result;
}

}  // namespace

struct Geometry::Impl {
  struct Face {
    std::unique_ptr<Surface> surface;
    std::array<double, 2> side;
    bool plane;
  };
  struct Edge {
    std::unique_ptr<Curve> curve;
    bool line;
  };
  std::vector<Face> faces;
  std::vector<Edge> edges;
};

Geometry::Geometry(const Plc& plc, GeometryRecords records) : impl_(std::make_unique<Impl>()) {
  const std::size_t face_count = plc.face_solids.size(), edge_count = plc.edge_count;
  if (records.faces.empty()) records.faces.resize(face_count);
  if (records.edges.empty()) records.edges.resize(edge_count);
  if (records.faces.size() != face_count || records.edges.size() != edge_count) {
    throw Failure("plc", "bad_geometry",
                  "The CAD geometry describes " + std::to_string(records.faces.size()) + " faces and " +
                      std::to_string(records.edges.size()) + " edges, but the triangulated boundary has " +
                      std::to_string(face_count) + " and " + std::to_string(edge_count) + ".");
  }
  const std::vector<FacePatch> patches = face_patches(plc);
  const std::vector<EdgePath> paths = edge_paths(plc);
  for (std::size_t i = 0; i < face_count; ++i) {
    const SurfaceRecord& record = records.faces[i];
    check_record(record, static_cast<Index>(i), records.spline_surfaces.size());
    std::unique_ptr<Surface> surface = make_surface(record, patches[i]);
    const auto side = sides(*surface, patches[i]);
    impl_->faces.push_back({std::move(surface), side, record.kind == SurfaceKind::plane});
  }
  for (std::size_t i = 0; i < edge_count; ++i) {
    const CurveRecord& record = records.edges[i];
    check_record(record, static_cast<Index>(i), records.spline_curves.size());
    impl_->edges.push_back({make_curve(record, paths[i]), record.kind == CurveKind::line});
  }
}

Geometry::~Geometry() = default;

Vec3 Geometry::project_to_face(Index face, const Vec3& p) const {
  return impl_->faces[face].surface->project(p);
}

Vec3 Geometry::project_to_edge(Index edge, const Vec3& p) const {
  return impl_->edges[edge].curve->project(p);
}

Vec3 Geometry::normal(Index face, const Vec3& p) const {
  const Impl::Face& f = impl_->faces[face];
  return f.side[f.surface->sheet(p)] * f.surface->normal(p);
}

double Geometry::curvature(Index face, const Vec3& p) const {
  return impl_->faces[face].surface->curvature(p);
}

double Geometry::edge_curvature(Index edge, const Vec3& p) const {
  return impl_->edges[edge].curve->curvature(p);
}

bool Geometry::is_plane(Index face) const { return impl_->faces[face].plane; }

bool Geometry::is_line(Index edge) const { return impl_->edges[edge].line; }

}  // namespace dm
