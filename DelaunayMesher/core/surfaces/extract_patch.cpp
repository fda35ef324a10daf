#include "surfaces/extract_patch.h"

#include <algorithm>

namespace dm {

PatchSource::PatchSource(const Plc& plc, const CurveSampling& curves)
    : plc_(plc), curves_(curves), segments_(plc) {
  first_.assign(plc.face_solids.size() + 1, 0);
  for (Index f : plc.triangle_face) ++first_[f + 1];
  for (std::size_t f = 0; f + 1 < first_.size(); ++f) first_[f + 1] += first_[f];
  triangles_.resize(plc.triangles.size());
  std::vector<Index> fill(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < plc.triangles.size(); ++t)
    triangles_[fill[plc.triangle_face[t]]++] = static_cast<Index>(t);
}

// Twins of the half-edges of a triangle list (PLC points), -1 along segments and wherever the edge has not
// exactly one triangle on each side.
std::vector<Index> PatchSource::pair_half_edges(const std::vector<Index>& corners) const {
  const Index n = static_cast<Index>(corners.size());
  std::vector<std::array<Index, 3>> edges;
  edges.reserve(corners.size());
  for (Index e = 0; e < n; ++e) {
    const auto [a, b] = std::minmax(corners[FacePatch::next(e)], corners[FacePatch::prev(e)]);
    edges.push_back({a, b, e});
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Index> twins(corners.size(), -1);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j][0] == edges[i][0] && edges[j][1] == edges[i][1]) ++j;
    const Index e = edges[i][2];
    if (j == i + 2) {
      const Index m = edges[i + 1][2];
      const bool opposite = corners[FacePatch::next(e)] == corners[FacePatch::prev(m)];
      if (opposite && find_segment(edges[i][0], edges[i][1]) < 0) {
        twins[e] = m;
        twins[m] = e;
      }
    }
    i = j;
  }
  return twins;
}

FacePatch PatchSource::extract(Index face) const {
  std::vector<Index> corners;
  corners.reserve(3 * static_cast<std::size_t>(triangle_count(face)));
  for (Index k = first_[face]; k < first_[face + 1]; ++k)
    for (Index p : plc_.triangles[triangles_[k]]) corners.push_back(p);
  std::vector<Index> twins = pair_half_edges(corners);

  // Each fan of triangles round a point becomes one vertex.
  FacePatch patch;
  const Index n = static_cast<Index>(corners.size());
  std::vector<Index> local(corners.size(), -1);
  for (Index start = 0; start < n; ++start) {
    if (local[start] >= 0) continue;
    const Index p = corners[start];
    const CurvePointRole role = curves_.role[p];
    const VertexKind kind = role == CurvePointRole::none    ? VertexKind::interior
                            : role == CurvePointRole::fixed ? VertexKind::fixed
                                                            : VertexKind::dropped;
    const Index v = patch.add_vertex(curves_.points[p], kind, role == CurvePointRole::none ? -1 : p);
    for (Index c = start; c >= 0 && local[c] < 0;) {
      local[c] = v;
      const Index m = twins[FacePatch::next(c)];
      c = m < 0 ? -1 : FacePatch::next(m);
    }
    for (Index m = twins[FacePatch::prev(start)]; m >= 0 && local[FacePatch::prev(m)] < 0;) {
      local[FacePatch::prev(m)] = v;
      m = twins[FacePatch::prev(FacePatch::prev(m))];
    }
  }
  patch.start(std::move(local), std::move(twins));
  fix_unlabelled(patch, corners);
  add_samples(patch);
  return patch;
}

// An edge on the patch's boundary that is no segment (a defect of the tessellation) stays as it is.
void PatchSource::fix_unlabelled(FacePatch& patch, const std::vector<Index>& corners) const {
  for (Index e = 0; e < static_cast<Index>(corners.size()); ++e) {
    if (patch.twin[e] >= 0) continue;
    const Index a = FacePatch::next(e), b = FacePatch::prev(e);
    if (find_segment(corners[a], corners[b]) >= 0) continue;
    for (const Index c : {a, b}) {
      patch.global[patch.vertex[c]] = corners[c];
      if (patch.kinds[patch.vertex[c]] == VertexKind::interior)
        patch.kinds[patch.vertex[c]] = VertexKind::fixed;
    }
  }
}

void PatchSource::add_samples(FacePatch& patch) const {
  for (Index e = 0; e < static_cast<Index>(patch.vertex.size()); ++e) {
    if (patch.twin[e] >= 0) continue;
    const Index a = patch.global[patch.origin(e)], b = patch.global[patch.target(e)];
    if (a < 0 || b < 0) continue;
    const Index s = find_segment(a, b);
    if (s < 0) continue;
    const Index low = curves_.first[s], count = curves_.first[s + 1] - low;
    if (count == 0) continue;
    const bool forward = plc_.segments[s][0] == a;
    patch.pending.push_back({patch.origin(e), patch.vertex_count(), patch.vertex_count() + count});
    for (Index k = 0; k < count; ++k) {
      const Index p = curves_.inserted[forward ? low + k : low + count - 1 - k];
      patch.add_vertex(curves_.points[p], VertexKind::fixed, p);
    }
  }
}

}  // namespace dm
