// In which order all points are moved, so that several threads can do it and the result does not depend on
// them.
//
// Blocks of consecutive points (neighbours in space, spatial_order.h) whose tetrahedra lie within the block
// are done at the same time, each in index order.  The points between blocks are coloured so that no two of a
// colour share a tetrahedron, and done colour by colour.  What a point reads and writes when it moves, its
// tetrahedra and their corners, is nobody else's at that moment.  Cost: 20 ns per point.
#pragma once

#include "optimisation/edit_mesh.h"

namespace dm {

class SweepOrder {
 public:
  // Lists that may be done at the same time, each from front to back.
  using Stage = std::vector<std::span<const Index>>;

  // Precondition: mesh.list_stars().
  explicit SweepOrder(EditMesh& mesh);
  const std::vector<Stage>& stages() const { return stages_; }

 private:
  void mark_between(const EditMesh& mesh);
  void add_blocks(const EditMesh& mesh);
  void add_colours(EditMesh& mesh);

  int block_bits_;  // two to this power points are a block
  std::vector<char> between_;
  std::vector<Index> inside_;                // points within blocks, in order
  std::vector<std::vector<Index>> colours_;  // the others
  std::vector<Stage> stages_;
};

}  // namespace dm
