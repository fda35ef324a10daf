#include "curves/curve_changes.h"

#include <numeric>

namespace dm {
namespace {

std::vector<std::vector<Index>> points_by_edge(const CurveSampling& curves, Index edge_count) {
  std::vector<std::vector<Index>> points(edge_count);
  for (std::size_t s = 0; s < curves.segments.size(); ++s)
    for (const Index p : curves.segments[s]) points[curves.segment_edge[s]].push_back(p);
  return points;
}

}  // namespace

CurveChanges::CurveChanges(const CurveSampling& before, const CurveSampling& after, Index edge_count)
    : changed_(edge_count, 0), number_(before.points.size()) {
  std::iota(number_.begin(), number_.end(), 0);
  const auto old_points = points_by_edge(before, edge_count), new_points = points_by_edge(after, edge_count);
  for (Index e = 0; e < edge_count; ++e) {
    bool same = old_points[e].size() == new_points[e].size();
    for (std::size_t i = 0; same && i < old_points[e].size(); ++i)
      same = before.points[old_points[e][i]] == after.points[new_points[e][i]];
    changed_[e] = !same;
    if (!same) continue;
    for (std::size_t i = 0; i < old_points[e].size(); ++i) number_[old_points[e][i]] = new_points[e][i];
  }
}

}  // namespace dm
