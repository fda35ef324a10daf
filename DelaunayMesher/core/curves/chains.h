// Chains: maximal runs of feature segments of one CAD edge between corners and junctions.
#pragma once

#include <vector>

#include "plc/plc.h"

namespace dm {

struct Chain {
  Index edge = -1;
  std::vector<Index> points;    // PLC points in order; closed chains repeat the first at the end
  std::vector<Index> segments;  // PLC segment between points[i] and points[i + 1]
  bool closed() const { return points.front() == points.back(); }
};

// Every segment is in exactly one chain.  A point inside a chain has exactly two segments, both of the same
// CAD edge, is no corner and is not in `keep` (empty = none).  Cost O(points + segments).
std::vector<Chain> find_chains(const Plc& plc, const std::vector<char>& keep);

}  // namespace dm
