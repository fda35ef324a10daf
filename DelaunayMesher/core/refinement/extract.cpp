#include "refinement/extract.h"

#include <algorithm>

namespace dm {

namespace {

void extract_tets(const Triangulation& tets, const std::vector<Index>& vertex_of, VolumeMesh& out) {
  std::vector<Index> tet_of(tets.slot_count(), -1);
  Index count = 0;
  for (Index t = 0; t < tets.slot_count(); ++t)
    if (!tets.is_free(t) && tets.tag(t) != 0) tet_of[t] = count++;
  out.tets.reserve(count);
  out.neighbours.reserve(count);
  out.tet_solid.reserve(count);
  for (Index t = 0; t < tets.slot_count(); ++t) {
    if (tet_of[t] < 0) continue;
    Tet corners;
    std::array<Index, 4> across;
    for (int i = 0; i < 4; ++i) {
      corners[i] = vertex_of[tets.corners(t)[i]];
      const Face g = tets.neighbour(t, i);
      across[i] = tet_of[g / 4] < 0 ? -1 : 4 * tet_of[g / 4] + g % 4;
    }
    out.tets.push_back(corners);
    out.neighbours.push_back(across);
    out.tet_solid.push_back(tets.tag(t));
  }
}

void extract_boundary(const BoundaryComplex& complex, const std::vector<Index>& vertex_of, VolumeMesh& out) {
  for (Index t = 0; t < complex.slot_count(); ++t) {
    if (!complex.alive(t)) continue;
    const auto [a, b, c] = complex.corners(t);
    out.triangles.push_back({vertex_of[a], vertex_of[b], vertex_of[c]});
    out.triangle_face.push_back(complex.face(t));
  }
  std::vector<std::pair<Segment, Index>> segments;
  for (const auto& [key, edge] : complex.segments()) {
    const auto [a, b] = BoundaryComplex::segment_of_key(key);
    segments.push_back({{vertex_of[a], vertex_of[b]}, edge});
  }
  std::sort(segments.begin(), segments.end());
  for (const auto& [segment, edge] : segments) {
    out.segments.push_back(segment);
    out.segment_edge.push_back(edge);
  }
}

}  // namespace

VolumeMesh extract_volume_mesh(const LabelledTriangulation& mesh) {
  const Triangulation& tets = mesh.tets;
  std::vector<Index> solid_of(tets.vertex_count(), 0);
  for (Index t = 0; t < tets.slot_count(); ++t)
    if (!tets.is_free(t) && tets.tag(t) != 0)
      for (const Index v : tets.corners(t)) solid_of[v] = tets.tag(t);
  VolumeMesh out;
  std::vector<Index> vertex_of(tets.vertex_count(), -1);
  for (Index v = 0; v < tets.vertex_count(); ++v) {
    if (!solid_of[v]) continue;
    vertex_of[v] = static_cast<Index>(out.points.size());
    out.points.push_back(tets.point(v));
    Entity entity = mesh.boundary.entity(v);
    if (entity.dimension == 3) entity.index = solid_of[v];
    out.point_entity.push_back(entity);
  }
  extract_tets(tets, vertex_of, out);
  extract_boundary(mesh.boundary, vertex_of, out);
  return out;
}

}  // namespace dm
