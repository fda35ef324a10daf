#include "curves/chains.h"

namespace dm {
namespace {

// Segments round each point in compressed rows.
struct Incidence {
  std::vector<Index> first, segment;
};

Incidence segments_of_points(const Plc& plc) {
  Incidence rows;
  rows.first.assign(plc.points.size() + 1, 0);
  for (const Segment& s : plc.segments)
    for (Index p : s) ++rows.first[p + 1];
  for (std::size_t p = 0; p < plc.points.size(); ++p) rows.first[p + 1] += rows.first[p];
  rows.segment.resize(2 * plc.segments.size());
  std::vector<Index> fill(rows.first.begin(), rows.first.end() - 1);
  for (std::size_t s = 0; s < plc.segments.size(); ++s)
    for (Index p : plc.segments[s]) rows.segment[fill[p]++] = static_cast<Index>(s);
  return rows;
}

std::vector<char> find_breaks(const Plc& plc, const Incidence& rows, const std::vector<char>& keep) {
  std::vector<char> breaks(plc.points.size(), 0);
  for (Index c : plc.corners) breaks[c] = 1;
  for (std::size_t p = 0; p < plc.points.size(); ++p) {
    const Index n = rows.first[p + 1] - rows.first[p];
    if (n == 0) continue;
    const Index* s = &rows.segment[rows.first[p]];
    if (n != 2 || plc.segment_edge[s[0]] != plc.segment_edge[s[1]]) breaks[p] = 1;
    if (!keep.empty() && keep[p]) breaks[p] = 1;
  }
  return breaks;
}

}  // namespace

std::vector<Chain> find_chains(const Plc& plc, const std::vector<char>& keep) {
  const Incidence rows = segments_of_points(plc);
  const std::vector<char> breaks = find_breaks(plc, rows, keep);
  std::vector<char> used(plc.segments.size(), 0);
  std::vector<Chain> chains;
  auto follow = [&](Index start, Index segment) {
    Chain chain;
    chain.edge = plc.segment_edge[segment];
    chain.points.push_back(start);
    for (Index p = start;;) {
      used[segment] = 1;
      const Segment& s = plc.segments[segment];
      p = s[0] == p ? s[1] : s[0];
      chain.points.push_back(p);
      chain.segments.push_back(segment);
      if (breaks[p] || p == start) break;
      const Index* pair = &rows.segment[rows.first[p]];
      segment = pair[0] == segment ? pair[1] : pair[0];
    }
    chains.push_back(std::move(chain));
  };
  // Chains with ends first, then the loops that have no corner at all.
  for (const bool loops : {false, true})
    for (std::size_t p = 0; p < plc.points.size(); ++p) {
      if (!loops && !breaks[p]) continue;
      for (Index k = rows.first[p]; k < rows.first[p + 1]; ++k)
        if (!used[rows.segment[k]]) follow(static_cast<Index>(p), rows.segment[k]);
    }
  return chains;
}

}  // namespace dm
