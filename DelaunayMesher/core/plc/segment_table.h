// Segments of a PLC by their ends.
#pragma once

#include <vector>

#include "plc/plc.h"

namespace dm {

class SegmentTable {
 public:
  explicit SegmentTable(const Plc& plc);
  Index find(Index a, Index b) const;  // -1 = none

 private:
  std::vector<std::array<Index, 3>> ends_;  // sorted: lower point, higher point, segment
};

}  // namespace dm
