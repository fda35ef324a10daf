#include "plc/geometry.h"

#include <map>

#include "plc/analytic_curve.h"
#include "plc/analytic_surface.h"
#include "plc/facet_surface.h"
#include "plc/records.h"
#include "plc/spline_curve.h"
#include "plc/spline_surface.h"

namespace dm {
namespace {

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

std::unique_ptr<Surface> make_surface(const SurfaceRecord& record, const GeometryRecords& records,
                                      const FacePatch& patch) {
  switch (record.kind) {
    case SurfaceKind::spline:
      return std::make_unique<SplineSurface>(records.spline_surfaces[record.spline]);
    case SurfaceKind::facets:
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

std::unique_ptr<Curve> make_curve(const CurveRecord& record, const GeometryRecords& records,
                                  const EdgePath& path) {
  switch (record.kind) {
    case CurveKind::line:
      return std::make_unique<LineCurve>(record, path);
    case CurveKind::circle:
      return std::make_unique<CircleCurve>(record, path);
    case CurveKind::spline:
      return std::make_unique<SplineCurve>(records.spline_curves[record.spline]);
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
    SurfaceKind kind;
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
  check_records(records, face_count, edge_count);
  simplify_records(records);
  const std::vector<FacePatch> patches = face_patches(plc);
  const std::vector<EdgePath> paths = edge_paths(plc);
  for (std::size_t i = 0; i < face_count; ++i) {
    const SurfaceRecord& record = records.faces[i];
    std::unique_ptr<Surface> surface = make_surface(record, records, patches[i]);
    const auto side = sides(*surface, patches[i]);
    impl_->faces.push_back({std::move(surface), side, record.kind});
  }
  for (std::size_t i = 0; i < edge_count; ++i) {
    const CurveRecord& record = records.edges[i];
    impl_->edges.push_back({make_curve(record, records, paths[i]), record.kind == CurveKind::line});
  }
}

Geometry::~Geometry() = default;

Vec3 Geometry::project_to_face(Index face, const Vec3& p) const {
  return impl_->faces[face].surface->project(p);
}

Vec3 Geometry::project_to_face(Index face, const Vec3& p, const Vec3& side) const {
  const Impl::Face& f = impl_->faces[face];
  return f.surface->project(p, f.side[f.surface->sheet(p)] * side);
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

bool Geometry::is_plane(Index face) const { return impl_->faces[face].kind == SurfaceKind::plane; }

bool Geometry::is_facets(Index face) const { return impl_->faces[face].kind == SurfaceKind::facets; }

bool Geometry::is_line(Index edge) const { return impl_->edges[edge].line; }

}  // namespace dm
