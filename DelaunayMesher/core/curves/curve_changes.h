// What differs between two samplings of the same curves, so that only the faces concerned are done again.
#pragma once

#include <vector>

#include "curves/sample_curves.h"

namespace dm {

class CurveChanges {
 public:
  // Both samplings are of the same PLC.  Cost O(points + segments).
  CurveChanges(const CurveSampling& before, const CurveSampling& after, Index edge_count);

  // Have the points on this CAD edge changed in number or position?
  bool edge_changed(Index edge) const { return changed_[edge]; }
  // Number after of a point that was on an unchanged edge or of the PLC; -1 stays.
  Index new_number(Index before) const { return before < 0 ? -1 : number_[before]; }

 private:
  std::vector<char> changed_;
  std::vector<Index> number_;
};

}  // namespace dm
