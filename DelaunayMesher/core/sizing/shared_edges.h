// Where two faces of a PLC meet: their common segments and corners.
#pragma once

#include <unordered_map>
#include <vector>

#include "plc/plc.h"

namespace dm {

class SharedEdges {
 public:
  explicit SharedEdges(const Plc& plc);
  // Distance from p to where the two faces meet, infinity if they do not.
  double distance(Index face, Index other, const Vec3& p) const;

 private:
  static std::uint64_t key(Index a, Index b) {
    return (static_cast<std::uint64_t>(a < b ? a : b) << 32) | static_cast<std::uint32_t>(a < b ? b : a);
  }
  const Plc& plc_;
  std::unordered_map<std::uint64_t, std::vector<Segment>> shared_;  // a corner is a segment of equal ends
};

}  // namespace dm
