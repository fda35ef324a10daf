#include "optimisation/check_mesh.h"

#include <algorithm>
#include <string>

namespace dm {
namespace {

[[noreturn]] void broken(const char* code, const std::string& what, Index item, Vec3 place = {}) {
  throw Failure("check", code, what + " (number " + std::to_string(item) + ").", place);
}

using Key = std::array<Index, 3>;
Key sorted_face(const Tet& t, int face) {
  Key k{};
  int n = 0;
  for (int i = 0; i < 4; ++i)
    if (i != face) k[n++] = t[i];
  std::sort(k.begin(), k.end());
  return k;
}

void check_sizes(const VolumeMesh& m) {
  if (m.point_entity.size() != m.points.size())
    broken("sizes", "points and their entities differ in number", 0);
  if (m.neighbours.size() != m.tets.size() || m.tet_solid.size() != m.tets.size())
    broken("sizes", "tetrahedra, neighbours and solids differ in number", 0);
  if (m.triangle_face.size() != m.triangles.size() || m.segment_edge.size() != m.segments.size())
    broken("sizes", "boundary elements and their labels differ in number", 0);
  const Index n = static_cast<Index>(m.points.size());
  std::vector<char> used(n, 0);
  const auto use = [&](Index v, Index item) {
    if (v < 0 || v >= n) broken("index", "an element refers to a point that does not exist", item);
    used[v] = 1;
  };
  for (std::size_t i = 0; i < m.tets.size(); ++i)
    for (Index v : m.tets[i]) use(v, static_cast<Index>(i));
  for (Index v = 0; v < n; ++v)
    if (!used[v]) broken("isolated", "a point belongs to no tetrahedron", v, m.points[v]);
  for (std::size_t i = 0; i < m.triangles.size(); ++i)
    for (Index v : m.triangles[i]) use(v, static_cast<Index>(i));
  for (std::size_t i = 0; i < m.segments.size(); ++i)
    for (Index v : m.segments[i]) use(v, static_cast<Index>(i));
}

void check_tets(const VolumeMesh& m) {
  for (Index t = 0; t < static_cast<Index>(m.tets.size()); ++t) {
    const Tet& c = m.tets[t];
    const Vec3& a = m.points[c[0]];
    if (!(dot(area_vector(a, m.points[c[1]], m.points[c[2]]), m.points[c[3]] - a) > 0))
      broken("orientation", "a tetrahedron has no positive volume", t, a);
    for (int i = 0; i < 4; ++i) {
      const Index n = m.neighbours[t][i];
      if (n == -1) continue;
      if (n < 0 || n / 4 >= static_cast<Index>(m.tets.size()))
        broken("neighbour", "a neighbour is out of range", t, a);
      if (m.neighbours[n / 4][n % 4] != 4 * t + i) broken("neighbour", "neighbours do not agree", t, a);
      if (sorted_face(c, i) != sorted_face(m.tets[n / 4], n % 4))
        broken("neighbour", "neighbours do not share a face", t, a);
    }
  }
}

void check_boundary(const VolumeMesh& m) {
  std::vector<Key> faces, triangles;
  std::vector<Key> all;
  for (Index t = 0; t < static_cast<Index>(m.tets.size()); ++t)
    for (int i = 0; i < 4; ++i) {
      const Index n = m.neighbours[t][i];
      if (n < 4 * t + i) all.push_back(sorted_face(m.tets[t], i));
      if (n == -1 || (n < 4 * t + i && m.tet_solid[n / 4] != m.tet_solid[t])) faces.push_back(all.back());
    }
  for (const Triangle& t : m.triangles) {
    Key k = t;
    std::sort(k.begin(), k.end());
    triangles.push_back(k);
  }
  for (auto* list : {&faces, &triangles, &all}) std::sort(list->begin(), list->end());
  if (std::adjacent_find(triangles.begin(), triangles.end()) != triangles.end())
    broken("boundary", "a boundary triangle is listed twice", 0);
  if (!std::includes(triangles.begin(), triangles.end(), faces.begin(), faces.end()))
    broken("boundary", "an outer face is no boundary triangle", 0);
  if (!std::includes(all.begin(), all.end(), triangles.begin(), triangles.end()))
    broken("boundary", "a boundary triangle is no face of a tetrahedron", 0);
  std::vector<Segment> edges;
  for (const Key& k : faces)
    for (int i = 0; i < 3; ++i) edges.push_back({k[i == 2 ? 0 : i], k[i == 2 ? 2 : i + 1]});
  std::sort(edges.begin(), edges.end());
  for (const Segment& s : m.segments) {
    const Segment key{std::min(s[0], s[1]), std::max(s[0], s[1])};
    if (!std::binary_search(edges.begin(), edges.end(), key) && faces.size() == triangles.size())
      broken("segment", "a segment is no edge of the boundary", key[0], m.points[key[0]]);
  }
}

// The outer faces of each solid form closed surfaces: every edge in an even number of them.
void check_closed(const VolumeMesh& m) {
  std::vector<std::array<Index, 3>> edges;  // solid, two points
  for (Index t = 0; t < static_cast<Index>(m.tets.size()); ++t)
    for (int i = 0; i < 4; ++i) {
      const Index n = m.neighbours[t][i];
      if (n != -1 && m.tet_solid[n / 4] == m.tet_solid[t]) continue;
      const Key k = sorted_face(m.tets[t], i);
      for (int j = 0; j < 3; ++j) edges.push_back({m.tet_solid[t], k[j == 2 ? 0 : j], k[j == 2 ? 2 : j + 1]});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if ((j - i) % 2 != 0)
      broken("open", "the boundary of a solid is not closed", edges[i][1], m.points[edges[i][1]]);
    i = j;
  }
}

}  // namespace

void check_volume_mesh(const VolumeMesh& mesh) {
  check_sizes(mesh);
  check_tets(mesh);
  check_boundary(mesh);
  check_closed(mesh);
}

void check_on_geometry(const VolumeMesh& mesh, const Geometry& geometry, double tolerance) {
  for (Index v = 0; v < static_cast<Index>(mesh.points.size()); ++v) {
    const Vec3 p = mesh.points[v];
    if (distance(p, geometry.project(mesh.point_entity[v], p)) > tolerance)
      throw Failure("check", "off_geometry", "A boundary point is off its CAD element.", p,
                    mesh.point_entity[v]);
  }
}

}  // namespace dm
