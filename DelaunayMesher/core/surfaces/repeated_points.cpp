#include "surfaces/repeated_points.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "base/keep_rows.h"

namespace dm {
namespace {

// Round a place with several points.
struct Star {
  std::map<Index, std::set<Index>> neighbours;  // of each of the points
  std::set<Index> apexes;                       // of triangles with two of them, which vanish
};

// Neighbours are counted as what stands for them.
std::map<Index, Star> stars_of_repeated(const SurfaceMesh& mesh, const std::vector<Index>& first) {
  std::vector<char> repeated(mesh.points.size(), 0);
  for (std::size_t v = 0; v < first.size(); ++v)
    if (first[v] != static_cast<Index>(v)) repeated[first[v]] = 1;
  std::map<Index, Star> stars;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const Index place = first[t[i]], a = first[t[(i + 1) % 3]], b = first[t[(i + 2) % 3]];
      if (!repeated[place]) continue;
      Star& star = stars[place];
      for (const Index w : {a, b})
        if (w != place) star.neighbours[t[i]].insert(w);
      if ((a == place) != (b == place)) star.apexes.insert(a == place ? b : a);
    }
  return stars;
}

// Would two edges become one, other than those of triangles that vanish?
bool joins_edges(const Star& star) {
  std::set<Index> seen;
  for (const auto& [v, others] : star.neighbours)
    for (const Index w : others)
      if (!seen.insert(w).second && !star.apexes.contains(w)) return true;
  return false;
}

void renumber(SurfaceMesh& mesh, const std::vector<Index>& to) {
  std::vector<Index> number(mesh.points.size(), -1);
  Index count = 0;
  for (Index v = 0; v < static_cast<Index>(number.size()); ++v) {
    if (to[v] != v) continue;
    mesh.points[count] = mesh.points[v];
    mesh.point_entity[count] = mesh.point_entity[v];
    number[v] = count++;
  }
  mesh.points.resize(count);
  mesh.point_entity.resize(count);
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) v = number[to[v]];
  for (Segment& s : mesh.segments)
    for (Index& v : s) v = number[to[v]];
}

}  // namespace

std::vector<Index> first_at_place(const SurfaceMesh& mesh) {
  std::vector<Index> order(mesh.points.size()), first(mesh.points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index v) {
    const Vec3& p = mesh.points[v];
    return std::tuple(p.x, p.y, p.z, mesh.point_entity[v].dimension, v);
  };
  std::sort(order.begin(), order.end(), [&](Index v, Index w) { return key(v) < key(w); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool again = k > 0 && mesh.points[order[k]] == mesh.points[order[k - 1]];
    first[order[k]] = again ? first[order[k - 1]] : order[k];
  }
  return first;
}

bool has_repeated_points(const SurfaceMesh& mesh) {
  const std::vector<Index> first = first_at_place(mesh);
  for (std::size_t v = 0; v < first.size(); ++v)
    if (first[v] != static_cast<Index>(v)) return true;
  return false;
}

void join_repeated_points(SurfaceMesh& mesh) {
  std::vector<Index> to = first_at_place(mesh);
  const std::map<Index, Star> stars = stars_of_repeated(mesh, to);
  if (stars.empty()) return;
  for (const auto& [place, star] : stars)
    if (joins_edges(star))
      for (const auto& [v, others] : star.neighbours) to[v] = v;
  renumber(mesh, to);
  keep_rows(mesh.triangles, mesh.triangle_face,
            [](const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; });
  std::set<std::pair<Index, Index>> known;
  keep_rows(mesh.segments, mesh.segment_edge,
            [&](const Segment& s) { return s[0] != s[1] && known.insert(std::minmax(s[0], s[1])).second; });
}

}  // namespace dm
