#include "optimisation/spatial_order.h"

#include <algorithm>

#include "base/hilbert_curve.h"

namespace dm {
namespace {

// New number of each point.
std::vector<Index> point_places(const std::vector<Vec3>& points) {
  const auto curve =
      HilbertCurve::through(points.size(), [&](std::size_t v) -> const Vec3& { return points[v]; });
  std::vector<std::uint64_t> keys(points.size());  // place on the curve, then the old number
  for (std::size_t v = 0; v < points.size(); ++v)
    keys[v] = static_cast<std::uint64_t>(curve.code(points[v])) << 32 | v;
  std::sort(keys.begin(), keys.end());
  std::vector<Index> place(points.size());
  for (std::size_t k = 0; k < keys.size(); ++k) place[keys[k] & 0xffffffff] = static_cast<Index>(k);
  return place;
}

// New number of each tetrahedron: counting sort by smallest point.
std::vector<Index> tet_places(const std::vector<Tet>& tets, std::size_t point_count) {
  std::vector<Index> next(point_count + 1, 0);
  const auto smallest = [](const Tet& t) { return *std::min_element(t.begin(), t.end()); };
  for (const Tet& t : tets) ++next[smallest(t) + 1];
  for (std::size_t v = 0; v < point_count; ++v) next[v + 1] += next[v];
  std::vector<Index> place(tets.size());
  for (std::size_t t = 0; t < tets.size(); ++t) place[t] = next[smallest(tets[t])]++;
  return place;
}

// Flips take a few slots more than there are: growing would hold all of them twice.
std::size_t with_room(std::size_t count) { return count + count / 16; }

template <class T>
void permute(std::vector<T>& items, const std::vector<Index>& place) {
  std::vector<T> sorted;
  sorted.reserve(with_room(items.size()));
  sorted.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) sorted[place[i]] = items[i];
  items.swap(sorted);
}

template <class Item>
void rename(std::vector<Item>& items, const std::vector<Index>& place) {
  for (Item& item : items)
    for (Index& v : item) v = place[v];
}

}  // namespace

void sort_in_space(VolumeMesh& mesh) {
  if (mesh.points.empty()) return;
  const std::vector<Index> point_place = point_places(mesh.points);
  permute(mesh.points, point_place);
  permute(mesh.point_entity, point_place);
  rename(mesh.tets, point_place);
  rename(mesh.triangles, point_place);
  rename(mesh.segments, point_place);
  const std::vector<Index> tet_place = tet_places(mesh.tets, mesh.points.size());
  for (auto& across : mesh.neighbours)
    for (Index& n : across)
      if (n >= 0) n = 4 * tet_place[n / 4] + n % 4;
  permute(mesh.tets, tet_place);
  permute(mesh.neighbours, tet_place);
  permute(mesh.tet_solid, tet_place);
}

}  // namespace dm
