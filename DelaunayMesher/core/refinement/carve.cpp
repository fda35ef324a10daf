#include "refinement/carve.h"

#include <algorithm>
#include <set>

#include "base/keep_rows.h"
#include "refinement/angle_test.h"

namespace dm {

namespace {

constexpr int kPasses = 8;

// The CAD face of an outer boundary triangle of t, or -1 when t is not on the outer boundary alone.
Index outer_face(const LabelledTriangulation& mesh, Index t) {
  Index face = -1;
  for (int i = 0; i < 4; ++i) {
    const auto beyond = mesh.tets.tag(mesh.tets.neighbour(t, i) / 4);
    if (beyond != 0 && beyond != mesh.tets.tag(t)) return -1;
    if (beyond == 0) face = mesh.boundary.face(label_of(mesh, t, i));
  }
  return face;
}

void carve(LabelledTriangulation& mesh, Index t, Index face, const std::array<Index, 2>& solids) {
  const Tet v = mesh.tets.corners(t);
  const bool solid_in_front = solids[1] != 0;
  for (int i = 0; i < 4; ++i) {
    const Face f = 4 * t + i, across = mesh.tets.neighbour(t, i);
    if (mesh.tets.marked(t, i)) {
      mesh.boundary.remove(label_of(mesh, t, i));
      set_marked_both(mesh.tets, f, false);
      continue;
    }
    Triangle q{v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3]};
    if (corner_in_front(mesh.tets.corners(across / 4), across % 4, q) != solid_in_front)
      std::swap(q[1], q[2]);
    for (const Index corner : q)
      if (mesh.boundary.entity(corner).dimension == 3) mesh.boundary.set_entity(corner, {2, face});
    mesh.boundary.add(q[0], q[1], q[2], face);
    set_marked_both(mesh.tets, f, true);
  }
  mesh.tets.set_tag(t, 0);
}

}  // namespace

Index carve_flat_tets(LabelledTriangulation& mesh) {
  Index carved = 0;
  for (int pass = 0, changed = 1; changed && pass < kPasses; ++pass) {
    changed = 0;
    for (Index t = 0; t < mesh.tets.slot_count(); ++t) {
      if (mesh.tets.is_free(t) || mesh.tets.tag(t) == 0 || !mesh.tets.marks(t) || !is_flat(mesh.tets, t))
        continue;
      const Index face = outer_face(mesh, t);
      if (face < 0) continue;
      int i = 0;
      while (!mesh.tets.marked(t, i) || mesh.boundary.face(label_of(mesh, t, i)) != face) ++i;
      carve(mesh, t, face, mesh.boundary.solids(label_of(mesh, t, i)));
      ++changed;
    }
    carved += changed;
  }
  // Carving can take an edge between two faces of one plane away, and so can a split where the boundary was
  // replaced.
  mesh.boundary.drop_bare_segments();
  return carved;
}

namespace {

// Triangles that are no face of a tetrahedron any more, and segments that are no edge of a triangle.
void drop_bare_boundary(VolumeMesh& mesh) {
  const auto sorted = [](auto corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::vector<Triangle> faces;
  for (const auto& [a, b, c, d] : mesh.tets)
    for (const Triangle& face : {Triangle{b, c, d}, {a, c, d}, {a, b, d}, {a, b, c}})
      faces.push_back(sorted(face));
  std::sort(faces.begin(), faces.end());
  keep_rows(mesh.triangles, mesh.triangle_face,
            [&](const Triangle& t) { return std::binary_search(faces.begin(), faces.end(), sorted(t)); });
  std::set<Segment> edges;
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = sorted(t);
    edges.insert({Segment{a, b}, {b, c}, {a, c}});
  }
  keep_rows(mesh.segments, mesh.segment_edge, [&](const Segment& s) { return edges.contains(sorted(s)); });
}

}  // namespace

std::vector<Vec3> leave_out_flat_tets(VolumeMesh& mesh) {
  std::vector<std::size_t> flat;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (is_flat(mesh.points, mesh.tets[t])) flat.push_back(t);
  if (flat.empty()) return {};
  std::vector<Index> uses(mesh.points.size(), 0);  // tetrahedra at each point
  for (const Tet& v : mesh.tets)
    for (const Index p : v) ++uses[p];
  std::vector<Vec3> places;
  for (const std::size_t t : flat) {
    const auto [a, b, c, d] = mesh.tets[t];
    if (std::min({uses[a], uses[b], uses[c], uses[d]}) < 2) continue;
    for (const Index p : {a, b, c, d}) --uses[p];
    places.push_back(0.25 * (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]));
    mesh.tets[t] = {-1, -1, -1, -1};
  }
  keep_rows(mesh.tets, mesh.tet_solid, [](const Tet& v) { return v[0] >= 0; });
  mesh.neighbours.clear();
  if (!places.empty()) drop_bare_boundary(mesh);
  return places;
}

}  // namespace dm
