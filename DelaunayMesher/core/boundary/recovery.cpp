#include "boundary/recovery.h"

#include <algorithm>
#include <numeric>

#include "boundary/layers.h"
#include "boundary/partition.h"
#include "boundary/recover_triangles.h"
#include "boundary/weld.h"
#include "surfaces/repeated_points.h"

namespace dm {

namespace {

constexpr double kMostReplaced = 0.01;  // share of triangles that the last resort may replace between solids
constexpr int kLayerRounds = 3;

// Their CAD faces, ascending.
std::vector<Index> faces_of(const BoundaryComplex& boundary, const std::vector<Index>& triangles) {
  std::vector<Index> faces;
  for (const Index t : triangles) faces.push_back(boundary.face(t));
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

// Do shared faces connect all solids?
bool is_connected(const Plc& plc) {
  std::vector<Index> group(plc.solid_count + 1);
  std::iota(group.begin(), group.end(), 0);
  Index groups = plc.solid_count;
  for (const auto& [behind, front] : plc.face_solids) {
    if (behind == 0 || front == 0 || group[behind] == group[front]) continue;
    std::replace(group.begin(), group.end(), Index{group[front]}, Index{group[behind]});
    --groups;
  }
  return groups <= 1;
}

LabelledTriangulation triangulate(const SurfaceMesh& surface, const Plc& plc, Context& context) {
  LabelledTriangulation mesh{Triangulation(surface.points, context),
                             BoundaryComplex(surface, plc.face_solids)};
  for (Index v = 0; v < static_cast<Index>(surface.points.size()); ++v)
    if (mesh.tets.vertex_tet(v) < 0)
      throw Failure("boundary", "repeated_point", "two boundary points coincide", surface.points[v],
                    surface.point_entity[v]);
  context.poll(0.4);
  return mesh;
}

// Marks the faces that are labelled triangles; returns the triangles that are no face.
std::vector<Index> label_faces(LabelledTriangulation& mesh, Context& context) {
  std::vector<char> present(mesh.boundary.slot_count(), 0);
  for (Index tet = 0; tet < mesh.tets.slot_count(); ++tet) {
    context.tick(0.4);
    if (mesh.tets.is_free(tet) || mesh.tets.is_ghost(tet)) continue;
    for (int i = 0; i < 4; ++i) {
      const Index t = label_of(mesh, tet, i);
      if (t < 0) continue;
      set_marked_both(mesh.tets, 4 * tet + i, true);
      present[t] = 1;
    }
  }
  std::vector<Index> missing;
  for (Index t = 0; t < mesh.boundary.slot_count(); ++t)
    if (!present[t]) missing.push_back(t);
  return missing;
}

}  // namespace

LabelledTriangulation recover_boundary(SurfaceMesh surface, const Plc& plc, const Geometry& geometry,
                                       const SizeField& size, Context& context, RecoveryReport& report) {
  context.begin("boundary");
  LabelledTriangulation mesh = triangulate(surface, plc, context);
  std::vector<Index> missing = label_faces(mesh, context);
  std::vector<char> fixed;
  for (int round = 0; round < kLayerRounds && !missing.empty(); ++round) {
    SurfaceMesh matching = surface;
    const Index matched = match_layers(matching, plc, geometry, size, missing, fixed, context);
    if (matched == 0 || has_repeated_points(matching)) break;
    surface = std::move(matching);
    report.layer_points += matched;
    mesh = triangulate(surface, plc, context);
    missing = label_faces(mesh, context);
  }
  missing = recover_triangles(mesh, geometry, size, missing, true, context, report);
  report.unrecovered_faces = faces_of(mesh.boundary, missing);
  if (!missing.empty() || !tag_solids(mesh)) {
    const Replaced replaced = partition_solids(mesh, missing, context);
    report.replaced = replaced.triangles;
    SurfaceMesh welded;
    if (weld_points(mesh, plc, replaced.points, welded)) {
      mesh = triangulate(welded, plc, context);
      RecoveryReport again;
      missing = recover_triangles(mesh, geometry, size, label_faces(mesh, context), false, context, again);
      partition_solids(mesh, missing, context);
    }
  }
  // Touching solids whose faces do not match: the caller can mesh them apart, unless shared faces connect
  // them.
  if (!is_connected(plc) && report.replaced > kMostReplaced * static_cast<double>(surface.triangles.size()))
    throw Failure("boundary", "leak",
                  "faces of different solids overlap or cross each other: " +
                      std::to_string(report.replaced) + " boundary triangles are affected");
  return mesh;
}

}  // namespace dm
