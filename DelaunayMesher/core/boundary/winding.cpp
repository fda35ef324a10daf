#include "boundary/winding.h"

#include <numbers>

#include "base/tet_geometry.h"

namespace dm {

namespace {

constexpr double kFar = 3;  // distance over the radius from which a group of triangles counts as a dipole

}  // namespace

WindingNumber::WindingNumber(const std::vector<Vec3>& points, std::vector<Triangle> triangles)
    : points_(points), triangles_(std::move(triangles)) {
  std::vector<Box> boxes(triangles_.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
    for (const Index v : triangles_[t]) boxes[t].add(points_[v]);
  tree_ = BoxTree(boxes);
  dipoles_.resize(tree_.nodes().size());
  for (auto node = static_cast<Index>(dipoles_.size()); node-- > 0;) add_up(node);
}

// Children come after their parent in the tree, so they are added up before it.
void WindingNumber::add_up(Index number) {
  const BoxTree::Node& node = tree_.nodes()[number];
  Dipole& dipole = dipoles_[number];
  dipole.centre = node.box.centre();
  dipole.radius = 0.5 * norm(node.box.extent());
  if (node.count == 0) dipole.moment = dipoles_[node.first].moment + dipoles_[node.first + 1].moment;
  for (Index k = node.first; k < node.first + node.count; ++k) {
    const auto& [a, b, c] = triangles_[tree_.order()[k]];
    dipole.moment = dipole.moment + 0.5 * area_vector(points_[a], points_[b], points_[c]);
  }
}

double WindingNumber::at(const Vec3& place) const {
  double sum = 0;
  std::vector<Index> stack;
  if (!tree_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const Index number = stack.back();
    stack.pop_back();
    const BoxTree::Node& node = tree_.nodes()[number];
    const Dipole& dipole = dipoles_[number];
    const Vec3 d = dipole.centre - place;
    const double far = kFar * dipole.radius;
    if (norm2(d) > far * far) {
      sum += dot(dipole.moment, d) / (norm2(d) * norm(d));
    } else if (node.count == 0) {
      stack.insert(stack.end(), {node.first, node.first + 1});
    } else {
      for (Index k = node.first; k < node.first + node.count; ++k) {
        const auto& [a, b, c] = triangles_[tree_.order()[k]];
        sum += solid_angle(points_[a] - place, points_[b] - place, points_[c] - place);
      }
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace dm
