#include "surfaces/strip_flips.h"

#include <algorithm>
#include <cmath>

namespace dm {
namespace {

constexpr double kThin = 3;           // heights of triangles that may be flipped, over the tolerance
constexpr double kBulging = 6;        // ... between two curves that are nearer to each other than it
constexpr double kFlipMargin = 1e-9;  // of sums of angles, against flipping back and forth

}  // namespace

void StripFlips::run(std::vector<Segment> stack, std::size_t& steps) {
  while (!stack.empty() && steps > 0) {
    const Segment ends = stack.back();
    stack.pop_back();
    const Index s = editor_.left_of(ends), t = editor_.left_of({ends[1], ends[0]});
    if (s < 0 || t < 0 || editor_.segment(ends[0], ends[1]) >= 0) continue;
    if (!wants_flip(ends[0], ends[1], editor_.apex(s, ends), editor_.apex(t, ends))) continue;
    --steps;
    editor_.flip(ends, s, t);
    for (const Index u : {s, t})
      for (int i = 0; i < 3; ++i) stack.push_back(editor_.side(u, i));
  }
}

bool StripFlips::is_in_strip(const Triangle& v) const {
  return height(v[0], v[1], v[2]) < kBulging * tolerance_(at(v[0])) &&
         strip_of({v[0], v[1], v[2], v[2]}).width > 0;
}

double StripFlips::height(Index a, Index b, Index c) const {
  const double longest2 = std::max({norm2(at(b) - at(a)), norm2(at(c) - at(b)), norm2(at(a) - at(c))});
  return norm(area_vector(at(a), at(b), at(c))) / std::sqrt(longest2);
}

bool StripFlips::may_flip(Index a, Index b, Index c, double heights) const {
  return height(a, b, c) <= heights * tolerance_(at(a)) || sharp_.contains(a) || sharp_.contains(b) ||
         sharp_.contains(c);
}

// Of the triangles (a, b, c) and (b, a, d): both thin or in the fan round a tip, the new ones facing as the
// old, and better: the angles at c and d over 180 degrees together, or across a strip the shorter side.
bool StripFlips::wants_flip(Index a, Index b, Index c, Index d) const {
  if (c == d || editor_.has_side(c, d)) return false;
  if (!may_flip(a, b, c, kBulging) || !may_flip(b, a, d, kBulging)) return false;
  const Strip strip = strip_of({a, b, c, d});
  const bool in_strip = strip.width > 0;
  if (!in_strip && !(may_flip(a, b, c, kThin) && may_flip(b, a, d, kThin))) return false;
  const Quad real{at(a), at(b), at(c), at(d)};
  const auto& [pa, pb, pc, pd] = in_strip ? unrolled({a, b, c, d}, strip) : real;
  const Vec3 n1 = area_vector(pa, pb, pc), n2 = area_vector(pb, pa, pd);
  const Vec3 m1 = area_vector(pc, pa, pd), m2 = area_vector(pd, pb, pc);
  const Vec3 n = n1 + n2;
  if (!(dot(m1, n) > 0 && dot(m2, n) > 0)) return false;
  if (in_strip) return norm2(real[2] - real[3]) < (1 - kFlipMargin) * norm2(real[0] - real[1]);
  const double s1 = norm(n1), s2 = norm(n2);
  const double d1 = dot(pa - pc, pb - pc), d2 = dot(pa - pd, pb - pd);
  return s1 * d2 + s2 * d1 < -kFlipMargin * (std::abs(s1 * d2) + std::abs(s2 * d1));
}

// The strip that has all these points on its two curves: one of them is a curve of the point with the
// fewest, as hundreds may meet at a vertex.
StripFlips::Strip StripFlips::strip_of(const std::array<Index, 4>& points) const {
  const auto fewer = [&](Index p, Index q) {
    return editor_.edges_of(p).size() < editor_.edges_of(q).size();
  };
  for (const Index one : editor_.edges_of(*std::min_element(points.begin(), points.end(), fewer))) {
    const auto is_off = [&](Index p) { return !editor_.is_on(p, one); };
    const auto across = std::find_if(points.begin(), points.end(), is_off);
    if (across == points.end()) continue;
    for (const Index other : editor_.edges_of(*across))
      if (const double width = width_between(one, other, points); width > 0) return {one, other, width};
  }
  return {};
}

// Largest exact distance of the points of one curve from the other; 0 where a point is on neither, or
// further away than the tolerance.
double StripFlips::width_between(Index one, Index other, const std::array<Index, 4>& points) const {
  double width = 0;
  for (const Index p : points) {
    const bool on_one = editor_.is_on(p, one), on_other = editor_.is_on(p, other);
    if (!on_one && !on_other) return 0;
    if (on_one && on_other) continue;
    const double w = distance(at(p), geometry_.project_to_edge(on_one ? other : one, at(p)));
    if (w > tolerance_(at(p))) return 0;
    width = std::max(width, w);
  }
  return width;
}

// Places along a strip and across it.  In space triangles between two curves that are nearer to each other
// than their segments bulge lie over one another.
StripFlips::Quad StripFlips::unrolled(const std::array<Index, 4>& points, const Strip& strip) const {
  Vec3 along;
  for (const Index p : points)
    if (const Vec3 d = at(p) - at(points[0]); norm2(d) > norm2(along)) along = d;
  Quad flat;
  for (int i = 0; i < 4; ++i) {
    const double side =
        1.0 * editor_.is_on(points[i], strip.other) - 1.0 * editor_.is_on(points[i], strip.one);
    flat[i] = {dot(at(points[i]) - at(points[0]), along) / norm(along), 0.5 * side * strip.width, 0.0};
  }
  return flat;
}

}  // namespace dm
