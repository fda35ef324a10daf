#include "curves/length_field.h"

#include <algorithm>
#include <utility>

namespace dm {

void LengthField::Places::add(const Vec3& p, double value) {
  points_.push_back(p);
  values_.push_back(value);
}

void LengthField::Places::build() {
  if (tree_.order().size() == points_.size()) return;
  std::vector<Box> boxes(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) boxes[i].add(points_[i]);
  tree_ = BoxTree(boxes);
  least_.assign(tree_.nodes().size(), HUGE_VAL);
  for (std::size_t n = least_.size(); n-- > 0;) {
    const BoxTree::Node& node = tree_.nodes()[n];
    if (node.count == 0) least_[n] = std::min(least_[node.first], least_[node.first + 1]);
    for (Index k = node.first; k < node.first + node.count; ++k)
      least_[n] = std::min(least_[n], values_[tree_.order()[k]]);
  }
}

double LengthField::Places::lowest(const Vec3& p, double most) const {
  if (tree_.empty()) return most;
  const auto bound = [&](Index n) {
    return least_[n] + kGrowth * std::sqrt(tree_.nodes()[n].box.distance2(p));
  };
  Index stack[64];  // the tree is balanced: depth < 32
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Index n = stack[--top];
    if (bound(n) >= most) continue;
    const BoxTree::Node& node = tree_.nodes()[n];
    if (node.count == 0) {
      const bool first_nearer = bound(node.first) < bound(node.first + 1);
      stack[top++] = node.first + first_nearer;
      stack[top++] = node.first + !first_nearer;
    }
    for (Index k = node.first; k < node.first + node.count; ++k) {
      const Index i = tree_.order()[k];
      most = std::min(most, values_[i] + kGrowth * distance(p, points_[i]));
    }
  }
  return most;
}

double LengthField::at(const Vec3& p) const { return -floors_.lowest(p, -caps_.lowest(p, without_caps(p))); }

void LengthField::add_cap(const Vec3& p, double length) {
  constexpr double field_growth = 0.2;  // the size field itself falls by no more, for usual growth rates
  const double reach = (without_caps(p) - length) / (kGrowth - field_growth);
  if (!(reach > 0 && length > 0)) return;
  caps_.add(p, length);
  const Vec3 d{reach, reach, reach};
  reach_.emplace_back();
  reach_.back().add(p - d);
  reach_.back().add(p + d);
}

std::vector<Box> LengthField::apply_caps() {
  caps_.build();
  floors_.build();
  return std::exchange(reach_, {});
}

}  // namespace dm
