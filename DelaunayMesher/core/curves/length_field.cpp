#include "curves/length_field.h"

#include <algorithm>

namespace dm {

void LengthField::Places::add(const Vec3& p, double length, double reach) {
  const Vec3 d{reach, reach, reach};
  points.push_back(p);
  lengths.push_back(length);
  boxes.emplace_back();
  boxes.back().add(p - d);
  boxes.back().add(p + d);
}

template <class F>
void LengthField::Places::for_each_near(const Vec3& p, F f) const {
  if (tree.empty()) return;
  Index stack[64];  // the tree is balanced: depth < 32
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const BoxTree::Node& node = tree.nodes()[stack[--top]];
    if (node.box.distance2(p) > 0) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = node.first + 1;
    }
    for (Index k = node.first; k < node.first + node.count; ++k) {
      const Index i = tree.order()[k];
      f(lengths[i], distance(p, points[i]));
    }
  }
}

double LengthField::at(const Vec3& p) const {
  double length = without_caps(p);
  caps_.for_each_near(p, [&](double cap, double d) { length = std::min(length, cap + kGrowth * d); });
  floors_.for_each_near(p, [&](double floor, double d) { length = std::max(length, floor - kGrowth * d); });
  return length;
}

void LengthField::add_cap(const Vec3& p, double length) {
  constexpr double field_growth = 0.2;  // the size field itself falls by no more, for usual growth rates
  const double reach = (without_caps(p) - length) / (kGrowth - field_growth);
  if (reach > 0 && length > 0) caps_.add(p, length, reach);
}

std::vector<Box> LengthField::apply_caps() {
  std::vector<Box> changed(caps_.boxes.begin() + static_cast<std::ptrdiff_t>(applied_), caps_.boxes.end());
  if (!changed.empty()) caps_.tree = BoxTree(caps_.boxes);
  applied_ = caps_.boxes.size();
  if (floors_.tree.order().size() != floors_.boxes.size()) floors_.tree = BoxTree(floors_.boxes);
  return changed;
}

}  // namespace dm
