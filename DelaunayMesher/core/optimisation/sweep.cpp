#include "optimisation/sweep.h"

#include <bit>

namespace dm {
namespace {

constexpr int kColours = 64;
constexpr std::size_t kPiece = 256;  // points of one colour that one thread takes at a time

bool is_movable(const EditMesh& mesh, Index v) {
  return mesh.entity(v).dimension > 0 && mesh.vertex_tet(v) >= 0;
}

}  // namespace

SweepOrder::SweepOrder(EditMesh& mesh)
    : block_bits_(std::clamp(static_cast<int>(std::bit_width(static_cast<unsigned>(mesh.vertex_count()))) - 3,
                             10, 14)) {
  mark_between(mesh);
  add_blocks(mesh);
  add_colours(mesh);
}

void SweepOrder::mark_between(const EditMesh& mesh) {
  between_.assign(mesh.vertex_count(), 0);
  for (Index t = 0; t < mesh.slot_count(); ++t) {
    if (mesh.removed(t)) continue;
    const Tet& c = mesh.tet(t);
    if (((c[0] ^ c[1]) | (c[0] ^ c[2]) | (c[0] ^ c[3])) >> block_bits_ == 0) continue;
    for (const Index v : c) between_[v] = 1;
  }
}

void SweepOrder::add_blocks(const EditMesh& mesh) {
  std::vector<std::size_t> ends;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (v > 0 && v >> block_bits_ != (v - 1) >> block_bits_) ends.push_back(inside_.size());
    if (!between_[v] && is_movable(mesh, v)) inside_.push_back(v);
  }
  ends.push_back(inside_.size());
  Stage stage;
  std::size_t start = 0;
  for (const std::size_t end : ends) {
    stage.emplace_back(inside_.data() + start, end - start);
    start = end;
  }
  stages_.push_back(std::move(stage));
}

// The first colour that no neighbour has; the few points without one are done one by one at the end.
void SweepOrder::add_colours(EditMesh& mesh) {
  colours_.resize(kColours);
  std::vector<std::int8_t> colour(mesh.vertex_count(), -1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!between_[v] || !is_movable(mesh, v)) continue;
    std::uint64_t taken = 0;
    for (const Index t : mesh.star(v))
      for (const Index w : mesh.tet(t))
        if (colour[w] >= 0) taken |= std::uint64_t{1} << colour[w];
    const int own = std::min(std::countr_one(taken), kColours - 1);
    colour[v] = static_cast<std::int8_t>(own);
    colours_[own].push_back(v);
  }
  for (int k = 0; k < kColours; ++k) {
    const std::vector<Index>& points = colours_[k];
    const std::size_t piece = k == kColours - 1 ? points.size() : kPiece;
    Stage stage;
    for (std::size_t i = 0; i < points.size(); i += piece)
      stage.emplace_back(points.data() + i, std::min(piece, points.size() - i));
    if (!stage.empty()) stages_.push_back(std::move(stage));
  }
}

}  // namespace dm
