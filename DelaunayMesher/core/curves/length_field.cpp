#include "curves/length_field.h"

#include <algorithm>
#include <utility>

namespace dm {

void LengthField::Places::add(const Vec3& p, double value) { places_.push_back({p, value}); }

void LengthField::Places::build() {
  if (tree_.order().size() == places_.size()) return;
  std::vector<Box> boxes(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) boxes[i].add(places_[i].point);
  tree_ = BoxTree(boxes);
  least_.assign(tree_.nodes().size(), HUGE_VAL);
  const std::vector<Place> given(places_);
  for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = given[tree_.order()[i]];
  for (std::size_t n = least_.size(); n-- > 0;) {
    const BoxTree::Node& node = tree_.nodes()[n];
    if (node.count == 0) least_[n] = std::min(least_[node.first], least_[node.first + 1]);
    for (Index k = node.first; k < node.first + node.count; ++k)
      least_[n] = std::min(least_[n], places_[k].value);
  }
}

double LengthField::Places::lowest(const Vec3& p, double most, double enough) const {
  if (tree_.empty()) return most;
  // A value v at the distance d counts where v + kGrowth d < most; without square roots.
  const auto counts = [&](double value, double distance2) {
    const double room = most - value;
    return room > 0 && kGrowth * kGrowth * distance2 < room * room;
  };
  struct Visit {
    Index node;
    double distance2;
  };
  Visit stack[64];  // the tree is balanced: depth < 32
  int top = 0;
  stack[top++] = {0, tree_.nodes()[0].box.distance2(p)};
  while (top > 0 && most >= enough) {
    const auto [n, distance2] = stack[--top];
    if (!counts(least_[n], distance2)) continue;
    const BoxTree::Node& node = tree_.nodes()[n];
    if (node.count == 0) {
      Visit near{node.first, tree_.nodes()[node.first].box.distance2(p)};
      Visit far{node.first + 1, tree_.nodes()[node.first + 1].box.distance2(p)};
      if (far.distance2 < near.distance2) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
    }
    for (Index k = node.first; k < node.first + node.count; ++k) {
      const double d2 = norm2(p - places_[k].point);
      if (counts(places_[k].value, d2)) most = places_[k].value + kGrowth * std::sqrt(d2);
    }
  }
  return most;
}

double LengthField::at_between(const Vec3& p, double low, double high) const {
  const double most = std::min(without_caps(p), high);
  return -floors_.lowest(p, -caps_.lowest(p, most, low));
}

void LengthField::add_cap(const Vec3& p, double length) {
  const double lowered = without_caps(p) - length, steeper = kGrowth - edge_ratio_ * size_.growth();
  if (!(lowered > 0 && length > 0)) return;
  const double reach = steeper > 0 ? lowered / steeper : HUGE_VAL;  // where the field itself is lower again
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
