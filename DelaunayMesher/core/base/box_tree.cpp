#include "base/box_tree.h"

#include <numeric>

namespace dm {

namespace {
constexpr Index kLeafItems = 4;
}

BoxTree::BoxTree(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  std::vector<Vec3> centres(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) centres[i] = boxes[i].centre();
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(boxes.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<Index>(boxes.size()), centres);
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    if (node.count == 0) {
      node.box.add(nodes_[node.first].box);
      node.box.add(nodes_[node.first + 1].box);
    }
    for (Index k = 0; k < node.count; ++k) node.box.add(boxes[order_[node.first + k]]);
  }
}

void BoxTree::split(Index node, Index begin, Index end, const std::vector<Vec3>& centres) {
  if (end - begin <= kLeafItems) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  Box box;
  for (Index i = begin; i < end; ++i) box.add(centres[order_[i]]);
  const Vec3 size = box.extent();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](Index i, Index j) {
                     const double a = centres[i][axis], b = centres[j][axis];
                     return a < b || (a == b && i < j);
                   });
  const auto child = static_cast<Index>(nodes_.size());
  nodes_[node].first = child;
  nodes_.emplace_back();
  nodes_.emplace_back();
  split(child, begin, middle, centres);
  split(child + 1, middle, end, centres);
}

}  // namespace dm
