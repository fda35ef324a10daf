#include "plc/segment_table.h"

#include <algorithm>

namespace dm {

SegmentTable::SegmentTable(const Plc& plc) {
  ends_.reserve(plc.segments.size());
  for (std::size_t s = 0; s < plc.segments.size(); ++s) {
    const auto [a, b] = std::minmax(plc.segments[s][0], plc.segments[s][1]);
    ends_.push_back({a, b, static_cast<Index>(s)});
  }
  std::sort(ends_.begin(), ends_.end());
}

Index SegmentTable::find(Index a, Index b) const {
  const std::array<Index, 3> key{std::min(a, b), std::max(a, b), -1};
  const auto at = std::lower_bound(ends_.begin(), ends_.end(), key);
  return at != ends_.end() && (*at)[0] == key[0] && (*at)[1] == key[1] ? (*at)[2] : -1;
}

}  // namespace dm
