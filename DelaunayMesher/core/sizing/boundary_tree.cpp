#include "sizing/boundary_tree.h"

#include "sizing/size_source.h"

namespace dm {

namespace {

std::vector<Box> triangle_boxes(const Plc& plc) {
  std::vector<Box> boxes(plc.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const Index v : plc.triangles[i]) boxes[i].add(plc.points[v]);
  return boxes;
}

// Distance along a ray of length `to` at which it enters the box, infinity if it misses.
inline double entry(const Box& box, const Vec3& origin, const Vec3& inverse, double to) {
  double from = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::isinf(inverse[i])) {  // in the plane of a side the products would be 0 * infinity
      if (origin[i] < box.low[i] || origin[i] > box.high[i]) return HUGE_VAL;
      continue;
    }
    const double a = (box.low[i] - origin[i]) * inverse[i], b = (box.high[i] - origin[i]) * inverse[i];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to ? from : HUGE_VAL;
}

}  // namespace

BoundaryTree::BoundaryTree(const Plc& plc) : plc_(plc), tree_(triangle_boxes(plc)) {}

RayHit BoundaryTree::first_hit(const Vec3& origin, const Vec3& direction, double from, double to,
                               Index skip) const {
  const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  RayHit hit;
  hit.distance = to;
  struct Entry {
    Index node;
    double entry;
  } stack[128];
  int top = 0;
  stack[top++] = {0, 0.0};
  // Moeller and Trumbore (1997); the tolerance closes the cracks between neighbouring triangles.
  constexpr double kEdge = 1e-10;
  const auto ask = [&](Index t) {
    if (t == skip) return;
    const Triangle& v = plc_.triangles[t];
    const Vec3 a = plc_.points[v[0]], e1 = plc_.points[v[1]] - a, e2 = plc_.points[v[2]] - a;
    const Vec3 q = cross(direction, e2);
    const double det = dot(e1, q);
    if (det == 0) return;
    const Vec3 s = origin - a, r = cross(s, e1);
    const double u = dot(s, q) / det, w = dot(direction, r) / det, distance = dot(e2, r) / det;
    if (u < -kEdge || w < -kEdge || u + w > 1 + kEdge || distance <= from) return;
    if (distance < hit.distance || (distance == hit.distance && t < hit.triangle))
      hit = {distance, t, -det / norm(cross(e1, e2))};
  };
  while (top > 0) {
    const Entry next = stack[--top];
    if (next.entry > hit.distance) continue;
    const BoxTree::Node& node = tree_.nodes()[next.node];
    for (Index k = 0; k < node.count; ++k) ask(tree_.order()[node.first + k]);
    if (node.count > 0) continue;
    Entry near{node.first, entry(tree_.nodes()[node.first].box, origin, inverse, hit.distance)};
    Entry far{node.first + 1, entry(tree_.nodes()[node.first + 1].box, origin, inverse, hit.distance)};
    if (far.entry < near.entry) std::swap(near, far);
    if (far.entry < HUGE_VAL) stack[top++] = far;
    if (near.entry < HUGE_VAL) stack[top++] = near;
  }
  return hit;
}

Index BoundaryTree::solid_along(const Vec3& p, const Vec3& direction) const {
  const RayHit hit = first_hit(p, direction, 0, HUGE_VAL);
  if (hit.triangle < 0) return 0;
  return plc_.face_solids[plc_.triangle_face[hit.triangle]][hit.cosine > 0 ? 0 : 1];
}

Index BoundaryTree::solid_at(const Vec3& p) const {
  // Skew directions: real parts have few triangles along them.
  static constexpr Vec3 kDirections[3] = {
      {0.8017, 0.2673, 0.5345}, {-0.3254, 0.7231, -0.6093}, {0.1741, -0.8123, -0.5566}};
  if (!box().overlaps(Box{p, p})) return 0;
  const Index first = solid_along(p, kDirections[0]);
  const Index second = solid_along(p, kDirections[1]);
  return first == second ? first : solid_along(p, kDirections[2]);
}

Index BoundaryTree::solid_by_nearest(const Vec3& p, double within) const {
  // Nearest to an edge or corner, several triangles tie: they must agree about the solid, or rays decide.
  constexpr double kTie = 1 + 1e-9;
  Index found = -1;
  bool agree = true;
  double best2 = within * within * kTie;
  const auto ask = [&](Index index) {
    const Triangle& t = plc_.triangles[index];
    const Vec3 a = plc_.points[t[0]], b = plc_.points[t[1]], c = plc_.points[t[2]];
    const Vec3 q = nearest_on_triangle(p, a, b, c);
    const double d2 = norm2(q - p);
    if (d2 > best2 * kTie) return;
    const Index solid =
        plc_.face_solids[plc_.triangle_face[index]][dot(p - q, area_vector(a, b, c)) > 0 ? 1 : 0];
    agree = d2 * kTie < best2 || (agree && solid == found);
    if (d2 < best2) found = solid, best2 = d2;
  };
  struct Entry {
    Index node;
    double distance2;
  } stack[128];
  int top = 0;
  stack[top++] = {0, 0.0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.distance2 > best2 * kTie) continue;
    const BoxTree::Node& node = tree_.nodes()[entry.node];
    for (Index k = 0; k < node.count; ++k) ask(tree_.order()[node.first + k]);
    if (node.count > 0) continue;
    Entry near{node.first, tree_.nodes()[node.first].box.distance2(p)};
    Entry far{node.first + 1, tree_.nodes()[node.first + 1].box.distance2(p)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    stack[top++] = far;
    stack[top++] = near;
  }
  return agree ? found : solid_at(p);
}

}  // namespace dm
