#include "plc/records.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "plc/bspline.h"

namespace dm {
namespace {

[[noreturn]] void bad_record(const std::string& what, Entity entity) {
  const std::string name = (entity.dimension == 2 ? "Face" : "Edge") + std::to_string(entity.index + 1);
  throw Failure("plc", "bad_geometry", name + ": " + what + ".", {}, entity);
}

bool finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
bool positive(double x) { return std::isfinite(x) && x > 0; }

void check_record(const SurfaceRecord& r, Index face, const GeometryRecords& records) {
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
  if (r.kind == SurfaceKind::spline) {
    if (r.spline < 0 || static_cast<std::size_t>(r.spline) >= records.spline_surfaces.size()) {
      bad_record("its spline surface is missing", entity);
    }
    const std::string found = defect(records.spline_surfaces[r.spline]);
    if (!found.empty()) bad_record(found, entity);
  }
  if (r.kind < SurfaceKind::facets || r.kind > SurfaceKind::spline)
    bad_record("unknown kind of surface", entity);
}

void check_record(const CurveRecord& r, Index edge, const GeometryRecords& records) {
  const Entity entity{1, edge};
  if (!finite(r.origin) || !finite(r.axis))
    bad_record("its curve has a coordinate that is not a number", entity);
  const bool needs_axis = r.kind == CurveKind::line || r.kind == CurveKind::circle;
  if (needs_axis && norm2(r.axis) == 0) bad_record("its curve has no direction", entity);
  if (r.kind == CurveKind::circle && !positive(r.a))
    bad_record("its radius is not a positive number", entity);
  if (r.kind == CurveKind::spline) {
    if (r.spline < 0 || static_cast<std::size_t>(r.spline) >= records.spline_curves.size()) {
      bad_record("its spline curve is missing", entity);
    }
    const std::string found = defect(records.spline_curves[r.spline]);
    if (!found.empty()) bad_record(found, entity);
  }
  if (r.kind < CurveKind::polyline || r.kind > CurveKind::spline) bad_record("unknown kind of curve", entity);
}

double flatness(double extent) { return std::min(1e-11 * extent, 1e-10); }

const Vec3& farthest(const std::vector<Vec3>& poles, const Vec3& from) {
  return *std::max_element(poles.begin(), poles.end(),
                           [&](const Vec3& p, const Vec3& q) { return norm2(p - from) < norm2(q - from); });
}

double distance_to_line(const Vec3& p, const Vec3& origin, const Vec3& axis) {
  return norm(cross(p - origin, axis));
}

std::optional<CurveRecord> as_line(const SplineCurveRecord& r) {
  const Vec3 origin = r.poles.front();
  const double extent = distance(origin, r.poles.back());
  if (extent == 0) return {};
  const Vec3 axis = (1 / extent) * (r.poles.back() - origin);
  for (const Vec3& p : r.poles) {
    if (distance_to_line(p, origin, axis) > flatness(extent)) return {};
    if (dot(p - origin, axis) < 0 || dot(p - origin, axis) > extent) return {};  // runs back on itself
  }
  return CurveRecord{CurveKind::line, origin, axis, 0, -1};
}

std::optional<SurfaceRecord> as_plane(const SplineSurfaceRecord& r) {
  const Vec3 origin = r.poles.front(), far = farthest(r.poles, origin);
  const double extent = distance(origin, far);
  if (extent == 0) return {};
  const Vec3 axis = (1 / extent) * (far - origin);
  const Vec3& aside = *std::max_element(r.poles.begin(), r.poles.end(), [&](const Vec3& p, const Vec3& q) {
    return distance_to_line(p, origin, axis) < distance_to_line(q, origin, axis);
  });
  const Vec3 normal = cross(axis, aside - origin);
  if (norm(normal) < 1e-6 * extent) return {};
  const Vec3 unit = normalized(normal);
  for (const Vec3& p : r.poles) {
    if (std::abs(dot(p - origin, unit)) > flatness(extent)) return {};
  }
  return SurfaceRecord{SurfaceKind::plane, origin, unit, 0, 0, -1};
}

}  // namespace

void check_records(const GeometryRecords& records, std::size_t face_count, std::size_t edge_count) {
  if (records.faces.size() != face_count || records.edges.size() != edge_count) {
    throw Failure("plc", "bad_geometry",
                  "The CAD geometry describes " + std::to_string(records.faces.size()) + " faces and " +
                      std::to_string(records.edges.size()) + " edges, but the triangulated boundary has " +
                      std::to_string(face_count) + " and " + std::to_string(edge_count) + ".");
  }
  for (std::size_t i = 0; i < face_count; ++i) {
    check_record(records.faces[i], static_cast<Index>(i), records);
  }
  for (std::size_t i = 0; i < edge_count; ++i) {
    check_record(records.edges[i], static_cast<Index>(i), records);
  }
}

void simplify_records(GeometryRecords& records) {
  for (SurfaceRecord& face : records.faces) {
    if (face.kind != SurfaceKind::spline) continue;
    if (const auto plane = as_plane(records.spline_surfaces[face.spline])) face = *plane;
  }
  for (CurveRecord& edge : records.edges) {
    if (edge.kind != CurveKind::spline) continue;
    if (const auto line = as_line(records.spline_curves[edge.spline])) edge = *line;
  }
}

}  // namespace dm
