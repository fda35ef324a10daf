#include "refinement/extract.h"

#include <algorithm>
#include <utility>

#include "base/memory.h"

namespace dm {

namespace {

bool is_meshed(const Triangulation::Arrays& arrays, Index t) {
  return arrays.corners[t][0] != Triangulation::free_slot && arrays.tags[t] != 0;
}

// Calls take(t) for every slot; what `used` has held up to there is given back, so that both meshes take
// hardly more room than one.
template <class T, class Take>
void use_up(Array<T>& used, Index slot_count, const Take& take) {
  constexpr Index kAtOnce = 1 << 17;
  for (Index begin = 0; begin < slot_count; begin += kAtOnce) {
    const Index end = std::min(slot_count, begin + kAtOnce);
    for (Index t = begin; t < end; ++t) take(t);
    return_front(used.data(), end * sizeof(T));
  }
  used = {};
}

void extract_tets(Triangulation::Arrays& arrays, const std::vector<Index>& vertex_of, bool with_neighbours,
                  VolumeMesh& out) {
  std::vector<Index> tet_of(arrays.slot_count, -1);
  Index count = 0;
  for (Index t = 0; t < arrays.slot_count; ++t)
    if (is_meshed(arrays, t)) tet_of[t] = count++;
  out.tet_solid.reserve(count);
  out.tets.reserve(count);
  if (!with_neighbours) arrays.neighbours = {};
  use_up(arrays.corners, arrays.slot_count, [&](Index t) {
    if (tet_of[t] < 0) return;
    out.tet_solid.push_back(arrays.tags[t]);
    Tet corners = arrays.corners[t];
    for (Index& v : corners) v = vertex_of[v];
    out.tets.push_back(corners);
  });
  arrays.tags = {};
  if (!with_neighbours) return;
  out.neighbours.reserve(count);
  use_up(arrays.neighbours, arrays.slot_count, [&](Index t) {
    if (tet_of[t] < 0) return;
    std::array<Index, 4> across = arrays.neighbours[t];
    for (Index& g : across) g = tet_of[g / 4] < 0 ? -1 : 4 * tet_of[g / 4] + g % 4;
    out.neighbours.push_back(across);
  });
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

VolumeMesh extract_volume_mesh(LabelledTriangulation mesh, bool with_neighbours) {
  Triangulation::Arrays arrays = std::move(mesh.tets).release();
  const auto vertex_count = static_cast<Index>(arrays.points.size());
  std::vector<Index> solid_of(vertex_count, 0);
  for (Index t = 0; t < arrays.slot_count; ++t)
    if (is_meshed(arrays, t))
      for (const Index v : arrays.corners[t]) solid_of[v] = arrays.tags[t];
  VolumeMesh out;
  std::vector<Index> vertex_of(vertex_count, -1);
  Index count = 0;
  for (Index v = 0; v < vertex_count; ++v) {
    if (!solid_of[v]) continue;
    Entity entity = mesh.boundary.entity(v);
    if (entity.dimension == 3) entity.index = solid_of[v];
    out.point_entity.push_back(entity);
    arrays.points[count] = arrays.points[v];
    vertex_of[v] = count++;
  }
  arrays.points.resize(count);
  arrays.points.shrink_to_fit();
  out.points = std::move(arrays.points);
  extract_boundary(BoundaryComplex(std::move(mesh.boundary)), vertex_of, out);
  extract_tets(arrays, vertex_of, with_neighbours, out);
  return out;
}

}  // namespace dm
