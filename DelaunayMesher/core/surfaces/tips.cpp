#include "surfaces/tips.h"

#include <algorithm>
#include <tuple>

#include "plc/segment_table.h"

namespace dm {
namespace {

constexpr double kSharp = 0.17;  // width over distance from the corner: 10 degrees

// A face's side of a segment, at one of its ends.
struct Corner {
  Index face, point, next, edge;
};

std::vector<Corner> corners_of_faces(const Plc& plc) {
  const SegmentTable segments(plc);
  std::vector<Corner> corners;
  for (std::size_t t = 0; t < plc.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const Index a = plc.triangles[t][i], b = plc.triangles[t][(i + 1) % 3], s = segments.find(a, b);
      if (s < 0) continue;
      corners.push_back({plc.triangle_face[t], a, b, plc.segment_edge[s]});
      corners.push_back({plc.triangle_face[t], b, a, plc.segment_edge[s]});
    }
  const auto key = [](const Corner& c) { return std::tie(c.face, c.point, c.next); };
  std::sort(corners.begin(), corners.end(),
            [&](const Corner& x, const Corner& y) { return key(x) < key(y); });
  return corners;
}

}  // namespace

std::vector<Tip> find_tips(const Plc& plc, const Geometry& geometry, const Tolerance& tolerance) {
  const std::vector<Corner> corners = corners_of_faces(plc);
  std::vector<Tip> tips;
  for (std::size_t i = 0, j = 0; i < corners.size(); i = j) {
    const Corner& c = corners[i];
    while (j < corners.size() && corners[j].face == c.face && corners[j].point == c.point) ++j;
    if (j != i + 2 || c.edge == corners[i + 1].edge) continue;
    const Vec3 &tip = plc.points[c.point], &next = plc.points[c.next];
    const double length = distance(tip, next);
    if (length == 0) continue;
    const Vec3 p =
        geometry.project_to_edge(c.edge, tip + std::min(1.0, tolerance(tip) / length) * (next - tip));
    const Vec3 q = geometry.project_to_edge(corners[i + 1].edge, p);
    if (distance(p, q) < kSharp * distance(p, tip))
      tips.push_back({c.face, c.point, c.edge, corners[i + 1].edge});
  }
  return tips;
}

}  // namespace dm
