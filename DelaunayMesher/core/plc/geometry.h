// Exact geometry of CAD faces and edges: every boundary node is put on it.
//
// Analytic surfaces in closed form; splines by Newton from the nearest triangle or chord of a grid.
// Postcondition: the projected point lies within 1e-10 * (model diagonal) of the surface or curve, and within
// 1e-9 mm on models of ordinary size (FreeCAD looks for nodes within 1e-7 mm).
#pragma once

#include <memory>
#include <vector>

#include "base/vec3.h"
#include "plc/plc.h"

namespace dm {

enum class SurfaceKind : Index {
  facets = 0,
  plane = 1,
  cylinder = 2,
  cone = 3,
  sphere = 4,
  torus = 5,
  spline = 6
};
enum class CurveKind : Index { polyline = 0, line = 1, circle = 2, spline = 3 };

// plane: origin, axis = normal | cylinder: a = radius | cone: origin = apex, a = half angle (radians, > 0),
// axis towards either nappe | sphere: a = radius | torus: a = major, b = minor radius (minor > major:
// spindle) | facets: the PLC's own triangles.  Of a cone's two nappes and a spindle torus's two sheets only
// those that the face has triangles on are projected on.
struct SurfaceRecord {
  SurfaceKind kind = SurfaceKind::facets;
  Vec3 origin, axis;
  double a = 0, b = 0;
  Index spline = -1;  // index into SplineRecord surfaces
};
// line: origin, axis = direction | circle: origin = centre, axis = normal, a = radius
struct CurveRecord {
  CurveKind kind = CurveKind::polyline;
  Vec3 origin, axis;
  double a = 0;
  Index spline = -1;
};
// Non-periodic, clamped or not; flat knots (with multiplicities); weights empty = polynomial.
struct SplineSurfaceRecord {
  int degree_u = 1, degree_v = 1;
  Index nu = 0, nv = 0;  // poles; pole (i, j) at i * nv + j
  std::vector<Vec3> poles;
  std::vector<double> weights, knots_u, knots_v;
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;  // parameter range of the face
};
struct SplineCurveRecord {
  int degree = 1;
  std::vector<Vec3> poles;
  std::vector<double> weights, knots;
  double u0 = 0, u1 = 1;
};
struct GeometryRecords {
  std::vector<SurfaceRecord> faces;
  std::vector<CurveRecord> edges;
  std::vector<SplineSurfaceRecord> spline_surfaces;
  std::vector<SplineCurveRecord> spline_curves;
};

// Thread-safe once built.
class Geometry {
 public:
  // With no records at all (an STL file) every face is 'facets' and every edge 'polyline'.
  Geometry(const Plc& plc, GeometryRecords records);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  // Nearest point of the surface of `face` (for facets: of its triangles) to p.
  Vec3 project_to_face(Index face, const Vec3& p) const;
  // The same on the sheets of the surface whose normal, as the PLC's triangles have it, is not opposite to
  // `side`: the coils of a spring, both sides of a thin wall may be one face, nearer to each other than the
  // triangles are to the surface.
  Vec3 project_to_face(Index face, const Vec3& p, const Vec3& side) const;
  // Nearest point of the curve of `edge` to p, not beyond its ends.
  Vec3 project_to_edge(Index edge, const Vec3& p) const;
  // Nearest point of the CAD element p belongs to: dimension 1 edge, 2 face; others return p.
  Vec3 project(Entity entity, const Vec3& p) const {
    return entity.dimension == 2   ? project_to_face(entity.index, p)
           : entity.dimension == 1 ? project_to_edge(entity.index, p)
                                   : p;
  }
  Vec3 project(Entity entity, const Vec3& p, const Vec3& side) const {
    return entity.dimension == 2 ? project_to_face(entity.index, p, side) : project(entity, p);
  }
  // Unit normal at the projection of p, sign as the PLC's triangles of that face near p.
  Vec3 normal(Index face, const Vec3& p) const;
  // Largest absolute principal curvature (1/mm) near p; 0 for planes and facets.
  double curvature(Index face, const Vec3& p) const;
  double edge_curvature(Index edge, const Vec3& p) const;
  bool is_plane(Index face) const;
  bool is_facets(Index face) const;
  bool is_line(Index edge) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dm
