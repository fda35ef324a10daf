#include "surfaces/edge_paths.h"

#include <algorithm>
#include <cmath>

#include "sizing/size_source.h"

namespace dm {
namespace {

constexpr double kParallel = 0.6;  // width half-way over the width

}  // namespace

EdgePaths::EdgePaths(const SurfaceMesh& mesh) : mesh_(mesh), position_(mesh.points.size(), -1) {
  std::vector<Use> uses;
  for (std::size_t s = 0; s < mesh.segments.size(); ++s) {
    const auto& [a, b] = mesh.segments[s];
    uses.push_back({mesh.segment_edge[s], a, b});
    uses.push_back({mesh.segment_edge[s], b, a});
  }
  std::sort(uses.begin(), uses.end());
  ends_.resize(uses.empty() ? 0 : uses.back()[0] + 1);
  paths_.resize(ends_.size());
  const auto same = [](const Use& u, const Use& v) { return u[0] == v[0] && u[1] == v[1]; };
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && same(uses[i], uses[j])) ++j;
    if (j == i + 1) ends_[uses[i][0]].push_back(uses[i][1]);
  }
  for (std::size_t e = 0; e < ends_.size(); ++e)
    if (!ends_[e].empty()) walk(uses, static_cast<Index>(e));
}

void EdgePaths::walk(const std::vector<Use>& uses, Index edge) {
  Path& path = paths_[edge];
  double arc = 0;
  for (Index p = ends_[edge].front(), before = -1; p >= 0;) {
    if (before >= 0) arc += distance(mesh_.points[before], mesh_.points[p]);
    if (mesh_.point_entity[p].dimension == 1) position_[p] = static_cast<Index>(path.points.size());
    path.points.push_back(p);
    path.arc.push_back(arc);
    Index next = -1;
    int ways = 0;
    for (auto use = std::lower_bound(uses.begin(), uses.end(), Use{edge, p, -1});
         use != uses.end() && (*use)[0] == edge && (*use)[1] == p; ++use)
      if ((*use)[2] != before && ++ways) next = (*use)[2];
    before = p;
    p = ways == 1 ? next : -1;  // a fork ends the path
  }
}

Vec3 EdgePaths::point_at(const Path& path, double arc) const {
  const auto after = std::upper_bound(path.arc.begin() + 1, path.arc.end() - 1, arc);
  const std::size_t k = after - path.arc.begin();
  const double step = path.arc[k] - path.arc[k - 1];
  const double t = step > 0 ? (arc - path.arc[k - 1]) / step : 0;
  return (1 - t) * mesh_.points[path.points[k - 1]] + t * mesh_.points[path.points[k]];
}

// From the place at `arc` along the path to the nearest one thereabouts.
double EdgePaths::distance_to(const Path& path, double arc, const Vec3& p) const {
  const auto at = [&](std::size_t k) -> const Vec3& { return mesh_.points[path.points[k]]; };
  const std::size_t last = path.points.size() - 1;
  std::size_t k = std::lower_bound(path.arc.begin(), path.arc.end() - 1, arc) - path.arc.begin();
  while (k < last && norm2(at(k + 1) - p) < norm2(at(k) - p)) ++k;
  while (k > 0 && norm2(at(k - 1) - p) < norm2(at(k) - p)) --k;
  double least = HUGE_VAL;
  for (const std::size_t end : {k, k + 1})
    if (end > 0 && end <= last)
      least = std::min(least, distance(p, nearest_on_segment(p, at(end - 1), at(end))));
  return least;
}

bool EdgePaths::run_in_parallel(Index edge, Index p, Index other, Index meeting, double width) const {
  const Path &path = paths_[edge], &beside = paths_[other];
  const Index k = position_[p];
  if (path.points.size() < 2 || beside.points.size() < 2 || k < 0 || path.points[k] != p) return false;
  const bool at_start = path.points.front() == meeting, beside_at_start = beside.points.front() == meeting;
  const double length = path.arc.back(), beside_length = beside.arc.back();
  const double half = (at_start ? path.arc[k] : length - path.arc[k]) / 2;
  const Vec3 place = point_at(path, at_start ? half : length - half);
  return distance_to(beside, beside_at_start ? half : beside_length - half, place) > kParallel * width;
}

}  // namespace dm
