// From the PLC and the sampled curves to the patch of one CAD face.
#pragma once

#include <vector>

#include "curves/sample_curves.h"
#include "plc/plc.h"
#include "plc/segment_table.h"
#include "surfaces/face_patch.h"

namespace dm {

// What all faces share: triangles by face, segments by their ends.  Cost O(triangles + segments log
// segments).
class PatchSource {
 public:
  PatchSource(const Plc& plc, const CurveSampling& curves);

  // The patch of `face`: its tessellation, cut along segments, with the curve samples pending in its boundary
  // edges.  Old curve points are still in it, with kind `dropped`.  Cost O(size log size).
  FacePatch extract(Index face) const;
  Index triangle_count(Index face) const { return first_[face + 1] - first_[face]; }
  // PLC segment joining two points, or -1.
  Index find_segment(Index a, Index b) const { return segments_.find(a, b); }

 private:
  std::vector<Index> pair_half_edges(const std::vector<Index>& corners) const;
  void fix_unlabelled(FacePatch& patch, const std::vector<Index>& corners) const;
  void add_samples(FacePatch& patch) const;

  const Plc& plc_;
  const CurveSampling& curves_;
  std::vector<Index> first_, triangles_;  // by face
  SegmentTable segments_;
};

}  // namespace dm
