#include "sizing/shared_edges.h"

#include <algorithm>
#include <array>

#include "sizing/size_source.h"

namespace dm {

namespace {

// Faces in groups of equal keys, sorted and without repetition.
template <class Key>
struct KeyedFace {
  Key key;
  Index face;
  friend auto operator<=>(const KeyedFace&, const KeyedFace&) = default;
};

template <class Key, class Visit>
void for_each_pair(std::vector<KeyedFace<Key>>& items, Visit&& visit) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
  for (std::size_t begin = 0, end = 0; begin < items.size(); begin = end) {
    while (end < items.size() && items[end].key == items[begin].key) ++end;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = i + 1; j < end; ++j) visit(items[i].key, items[i].face, items[j].face);
  }
}

}  // namespace

SharedEdges::SharedEdges(const Plc& plc) : plc_(plc) {
  std::vector<char> is_corner(plc.points.size(), 0);
  for (const Index c : plc.corners) is_corner[c] = 1;
  std::vector<KeyedFace<Segment>> edges;
  std::vector<KeyedFace<Index>> corners;
  edges.reserve(3 * plc.triangles.size());
  for (std::size_t t = 0; t < plc.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const Index a = plc.triangles[t][i], b = plc.triangles[t][(i + 1) % 3];
      edges.push_back({{std::min(a, b), std::max(a, b)}, plc.triangle_face[t]});
      if (is_corner[a]) corners.push_back({a, plc.triangle_face[t]});
    }
  for_each_pair(edges, [&](const Segment& s, Index f, Index g) { shared_[key(f, g)].push_back(s); });
  for_each_pair(corners, [&](Index c, Index f, Index g) { shared_[key(f, g)].push_back({c, c}); });
}

double SharedEdges::distance(Index face, Index other, const Vec3& p) const {
  double best2 = HUGE_VAL;
  const auto at = shared_.find(key(face, other));
  if (at == shared_.end()) return best2;
  for (const auto& [a, b] : at->second)
    best2 = std::min(best2, norm2(p - nearest_on_segment(p, plc_.points[a], plc_.points[b])));
  return std::sqrt(best2);
}

}  // namespace dm
