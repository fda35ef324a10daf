// PatchRemesher: insertion of points until every triangle is small enough.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "surfaces/remesh_patch.h"
#include "surfaces/triangle_shape.h"

namespace dm {
namespace {

constexpr double kDisplacement = 0.1;  // of the circumcentre, over the circumradius
constexpr double kLongEdge = 1.4;      // split at its middle when no centre will do
constexpr double kClosest = 0.55;      // least distance of a new point from old ones, over the wanted length
constexpr double kBoundaryHeight = 0.3;  // ... and from boundary edges, over their length
constexpr double kFairShape = 0.2;       // a middle may not leave flatter triangles, unless they were before
constexpr double kFlat = 1e-6;           // ... ever: what lies on a line would be divided for ever
constexpr double kOnEdge = 0.02;   // height over the edge's length under which a point goes into the edge
constexpr double kSameSide = 0.5;  // cosine between normals that may be walked over
constexpr int kBucketsPerOctave = 4;
constexpr int kBuckets = 80;
constexpr std::size_t kFewestTests = 10000;  // of edges for a flip
constexpr double kTestsPerPoint = 40;        // of those wanted; faces of 400 CAD files need 8 to 19

struct Circle {
  Vec3 centre;
  double radius;
};

Circle circumcircle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, n = cross(u, v);
  const double det = 2 * norm2(n);
  if (det == 0) return {a, HUGE_VAL};
  const Vec3 o = (1 / det) * (norm2(u) * cross(v, n) + norm2(v) * cross(n, u));
  return {a + o, norm(o)};
}

}  // namespace

void PatchRemesher::enqueue(Index t) {
  const double ratio = radius_ratio(t) / refine_limit_;
  if (ratio <= 1) return;
  // A flat triangle's radius is infinite.
  const int k = static_cast<int>(std::min(kBuckets - 1.0, kBucketsPerOctave * std::log2(ratio)));
  buckets_[k].push_back({t, patch_.stamp(t)});
  top_bucket_ = std::max(top_bucket_, static_cast<Index>(k));
}

void PatchRemesher::refine(double radius_ratio_limit) {
  refine_limit_ = radius_ratio_limit;
  buckets_.assign(kBuckets, {});
  top_bucket_ = -1;
  for (Index t = 0; t < patch_.triangle_slots(); ++t)
    if (patch_.alive(t)) enqueue(t);
  std::size_t steps = 0, next_check = kFewestTests;
  flip_tests_ = 0;
  while (top_bucket_ >= 0) {
    if (flip_tests_ > next_check) {  // a folded or flat patch would be divided and flipped for ever
      if (flip_tests_ > kFewestTests + kTestsPerPoint * wanted_points()) break;
      next_check = 2 * flip_tests_;
    }
    std::vector<Entry>& bucket = buckets_[top_bucket_];
    if (bucket.empty()) {
      --top_bucket_;
      continue;
    }
    const Entry entry = bucket.back();
    bucket.pop_back();
    if (!patch_.alive(entry.triangle) || patch_.stamp(entry.triangle) != entry.stamp) continue;
    if (!insert_near_centre(entry.triangle)) split_longest(entry.triangle);
    if ((++steps & 255) == 0) poll_();
  }
}

// How many points the patch has when its triangles are equilateral and as large as wanted.
double PatchRemesher::wanted_points() const {
  double squares = 0;
  for (Index t = 0; t < patch_.triangle_slots(); ++t) {
    if (!patch_.alive(t)) continue;
    const Index* v = &patch_.vertex[3 * t];
    const double length = (patch_.lengths[v[0]] + patch_.lengths[v[1]] + patch_.lengths[v[2]]) / 3;
    squares += norm(area_vector(points()[v[0]], points()[v[1]], points()[v[2]])) / (length * length);
  }
  return squares / std::numbers::sqrt3;
}

// Triangle into which p projects, walking from t; -1 when the boundary or a fold of the surface is in the
// way.
Index PatchRemesher::locate(Index t, const Vec3& p) const {
  Index from = -1;
  Vec3 last{};
  for (int step = 0; step < 100; ++step) {
    const Index* v = &patch_.vertex[3 * t];
    const Vec3 n = area_vector(points()[v[0]], points()[v[1]], points()[v[2]]);
    if (!planar_ && from >= 0 && dot(n, last) < kSameSide * std::sqrt(norm2(n) * norm2(last))) return -1;
    last = n;
    Index across = -1;
    double most = 0;
    for (int i = 0; i < 3; ++i) {
      const Index e = 3 * t + i;
      if (e == from) continue;
      const Vec3 &a = points()[patch_.origin(e)], &b = points()[patch_.target(e)];
      const double side = dot(cross(b - a, p - a), n) / std::sqrt(norm2(b - a));
      if (side < most) {
        most = side;
        across = e;
      }
    }
    if (across < 0) return t;
    from = patch_.twin[across];
    if (from < 0) return -1;
    t = from / 3;
  }
  return -1;
}

bool PatchRemesher::may_insert(Index s, const Vec3& p, double length, double radius) const {
  const double closest = kClosest * std::min(length, radius);
  for (int i = 0; i < 3; ++i) {
    const Index e = 3 * s + i;
    const Vec3 &a = points()[patch_.origin(e)], &b = points()[patch_.target(e)];
    if (norm2(p - a) < closest * closest) return false;
    if (patch_.twin[e] >= 0) continue;
    const double base2 = norm2(b - a), height2 = norm2(cross(b - a, p - a)) / base2;
    const double wanted = kBoundaryHeight * std::min(std::sqrt(base2), length);
    if (height2 < wanted * wanted) return false;
  }
  return true;
}

bool PatchRemesher::insert_near_centre(Index t) {
  const Index* v = &patch_.vertex[3 * t];
  const Vec3 &a = points()[v[0]], &b = points()[v[1]], &c = points()[v[2]];
  if (!planar_) {
    const Vec3 &na = patch_.normals[v[0]], &nb = patch_.normals[v[1]], &nc = patch_.normals[v[2]];
    if (dot(na, nb) < 0.8 || dot(nb, nc) < 0.8 || dot(nc, na) < 0.8) return false;
  }
  const Circle circle = circumcircle(a, b, c);
  const double length = (patch_.lengths[v[0]] + patch_.lengths[v[1]] + patch_.lengths[v[2]]) / 3;
  if (!(circle.radius < 1e3 * length)) return false;
  Random random(seed_, 0x66616365, face_, patch_.vertex_count());
  const Vec3 wanted = circle.centre + kDisplacement * circle.radius * random.in_ball();
  if (locate(t, wanted) < 0) return false;
  const Vec3 normal = patch_.normals[v[0]] + patch_.normals[v[1]] + patch_.normals[v[2]];
  const Vec3 p = geometry_.project_to_face(face_, wanted, normal);
  if (!(distance(p, wanted) < 0.7 * circle.radius)) return false;
  const Index s = locate(t, p);
  if (s < 0) return false;
  const double length_at_p = lengths_.at(p);
  if (!may_insert(s, p, length_at_p, circle.radius)) return false;

  const Index x = patch_.add_vertex(p, VertexKind::interior, -1);
  const Index corners[3] = {patch_.vertex[3 * s], patch_.vertex[3 * s + 1], patch_.vertex[3 * s + 2]};
  set_vertex(x, p, patch_.normals[corners[0]] + patch_.normals[corners[1]] + patch_.normals[corners[2]]);
  Index on_edge = -1;
  double lowest = kOnEdge;
  bool aligned = true;
  for (int i = 0; i < 3; ++i) {
    const Index e = 3 * s + i, o = corners[(i + 1) % 3], q = corners[(i + 2) % 3];
    const Vec3 d = points()[q] - points()[o];
    const double height = norm(cross(d, p - points()[o])) / norm2(d);
    if (height < lowest && patch_.twin[e] >= 0) {
      lowest = height;
      on_edge = e;
    } else if (alignment(o, q, x) < 0.3) {
      aligned = false;
    }
  }
  if (!aligned) {
    patch_.pop_vertex();
    return false;
  }
  if (on_edge >= 0)
    patch_.split_edge(on_edge, x);
  else
    patch_.split_triangle(s, x);
  finish_insertion(x);
  return true;
}

void PatchRemesher::finish_insertion(Index v) {
  patch_.for_each_corner(v, [&](Index c) { stack_.push_back(c); });
  lawson();
  if (!buckets_.empty()) patch_.for_each_corner(v, [&](Index c) { enqueue(c / 3); });
}

bool PatchRemesher::split_longest(Index t) {
  for (double limit = HUGE_VAL;;) {
    Index longest = -1;
    double ratio = kLongEdge;
    for (Index e = 3 * t; e < 3 * t + 3; ++e) {
      if (patch_.twin[e] < 0) continue;
      const double r = edge_ratio(patch_.origin(e), patch_.target(e));
      if (r > ratio && r < limit) {
        ratio = r;
        longest = e;
      }
    }
    if (longest < 0) return false;
    if (split_at_middle(longest)) return true;
    limit = ratio;
  }
}

bool PatchRemesher::split_at_middle(Index e) {
  const Index a = patch_.origin(e), b = patch_.target(e), c = patch_.apex(e), d = patch_.apex(patch_.twin[e]);
  const Vec3 middle = 0.5 * (points()[a] + points()[b]);
  const Vec3 p = geometry_.project_to_face(face_, middle, patch_.normals[a] + patch_.normals[b]);
  if (!(distance(p, middle) < 0.5 * distance(points()[a], points()[b]))) return false;
  const Vec3 &pa = points()[a], &pb = points()[b], &pc = points()[c], &pd = points()[d];
  const double shape_before = std::min(triangle_shape(pa, pb, pc), triangle_shape(pb, pa, pd));
  const double shape_after = std::min({triangle_shape(pa, p, pc), triangle_shape(p, pb, pc),
                                       triangle_shape(pb, p, pd), triangle_shape(p, pa, pd)});
  if (shape_after < std::max(kFlat, std::min(kFairShape, 0.5 * shape_before))) return false;
  const double before = std::min(alignment(a, b, c), alignment(b, a, d));
  const Index x = patch_.add_vertex(p, VertexKind::interior, -1);
  set_vertex(x, p, patch_.normals[a] + patch_.normals[b]);
  const double after =
      std::min({alignment(a, x, c), alignment(x, b, c), alignment(b, x, d), alignment(x, a, d)});
  if (after < std::min(0.3, before)) {
    patch_.pop_vertex();
    return false;
  }
  patch_.split_edge(e, x);
  finish_insertion(x);
  return true;
}

}  // namespace dm
