#include "surfaces/remesh_patch.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "base/random.h"

namespace dm {
namespace {

// Flips keep normals within 32 degrees of the surface's: where the triangles do not yet resolve a bend, being
// Delaunay would otherwise mean edges across its inside.
constexpr double kAligned = 0.85;
constexpr double kAlignedShort = 0.5;  // ... and within 60 where the new edge is no longer than
constexpr double kShort = 2;           // this many wanted lengths
constexpr double kDegenerate = 1e-10;  // area over the square of the longest edge
constexpr double kBend = 0.5;          // cosine of what an edge may turn: 60 degrees
constexpr int kBendRounds = 6;         // each halves what bends too far
constexpr double kStraight = 1e-6;     // radians
constexpr double kHalfway = 0.7;  // of what normals turn (1 - cosine), from the middle of an arc to its ends
constexpr double kFlipMargin = 1e-6;  // keeps rounding from flipping back and forth

double longest2(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::max({norm2(b - a), norm2(c - b), norm2(a - c)});
}

// From the middle of a chord to that of the circular arc over it, by the normals at its ends.  (The chord's
// own middle may be close to the arc's axis, from where every direction is as near.)
Vec3 rise_of_arc(const Vec3& chord, const Vec3& normal_a, const Vec3& normal_b) {
  const Vec3 across = normal_b - normal_a, outwards = normal_a + normal_b;
  const double sine = norm(across) / 2, cosine = norm(outwards) / 2;  // of half the angle
  if (sine < kStraight || cosine < kStraight) return {};
  return dot(chord, across) / (4 * (1 + cosine)) * (1 / (2 * cosine)) * outwards;
}

}  // namespace

PatchRemesher::PatchRemesher(FacePatch& patch, Index face, const Geometry& geometry,
                             const LengthField& lengths, const SurfaceOptions& options, std::uint64_t seed,
                             PatchPoll poll)
    : patch_(patch),
      face_(face),
      geometry_(geometry),
      lengths_(lengths),
      options_(options),
      seed_(seed),
      poll_(poll),
      planar_(geometry.is_plane(face)) {
  start_vertices();
}

std::vector<Index> PatchRemesher::run() {
  split_across_bends();
  insert_samples();
  make_delaunay();
  remove_dropped(kAligned);
  collapse_short(0.6);
  make_delaunay();
  refine(0.78);
  remove_dropped(kAlignedShort);
  smooth(2);
  collapse_short(0.6);
  refine(0.82);
  smooth(2);
  remove_dropped(kAlignedShort);
  jitter();
  std::vector<Index> left;
  for (Index v = 0; v < patch_.vertex_count(); ++v)
    if (patch_.kinds[v] == VertexKind::dropped && patch_.corner_of(v) >= 0) left.push_back(patch_.global[v]);
  return left;
}

void PatchRemesher::set_vertex(Index v, const Vec3& p, const Vec3& hint) {
  patch_.points[v] = p;
  patch_.lengths[v] = lengths_.at(p);
  if (planar_ && v > 0) {
    patch_.normals[v] = patch_.normals[0];
    return;
  }
  const Vec3 n = geometry_.normal(face_, p);
  const double l = norm2(n);
  const bool known = l > 0.5 && l < 2;  // false for NaN
  patch_.normals[v] = !known ? Vec3{} : dot(n, hint) < 0 ? -n : n;
}

void PatchRemesher::start_vertices() {
  for (Index v = 0; v < patch_.vertex_count(); ++v) {
    set_vertex(v, patch_.points[v], {});
    if ((v & 255) == 0) poll_();
  }
}

// At an apex or pole the surface has no normal, and what the geometry says there misleads.
void PatchRemesher::drop_doubtful_normals() {
  for (Index t = 0; t < patch_.triangle_slots(); ++t) {
    const Index* v = &patch_.vertex[3 * t];
    const Vec3 &a = points()[v[0]], &b = points()[v[1]], &c = points()[v[2]];
    const Vec3 n = area_vector(a, b, c);
    const double area = norm(n);
    if (area < 1e-6 * longest2(a, b, c)) continue;
    for (int i = 0; i < 3; ++i)
      if (dot(n, patch_.normals[v[i]]) < 0.2 * area) patch_.normals[v[i]] = {};
  }
}

double PatchRemesher::alignment(const Vec3& pa, const Vec3& pb, const Vec3& pc, Index a, Index b,
                                Index c) const {
  const Vec3 n = area_vector(pa, pb, pc);
  const double size2 = longest2(pa, pb, pc);
  if (planar_) {
    const double d = dot(n, patch_.normals[0]);
    return d > kDegenerate * size2 ? 1 : d < -kDegenerate * size2 ? -1 : 0;
  }
  const double area = norm(n);
  if (!(area > kDegenerate * size2)) return 0;
  double least = 1;
  for (const Index v : {a, b, c}) {
    const Vec3& normal = patch_.normals[v];
    if (norm2(normal) > 0) least = std::min(least, dot(n, normal) / area);
  }
  return least;
}

double PatchRemesher::edge_ratio(Index a, Index b) const {
  return 2 * distance(points()[a], points()[b]) / (patch_.lengths[a] + patch_.lengths[b]);
}

double PatchRemesher::radius_ratio(Index t) const {
  const Index* v = &patch_.vertex[3 * t];
  const Vec3 &a = points()[v[0]], &b = points()[v[1]], &c = points()[v[2]];
  const double area2 = norm(area_vector(a, b, c));
  const double product = std::sqrt(norm2(b - a) * norm2(c - b) * norm2(a - c));
  const double length = (patch_.lengths[v[0]] + patch_.lengths[v[1]] + patch_.lengths[v[2]]) / 3;
  return product / (2 * std::max(area2, kDegenerate * longest2(a, b, c)) * length);
}

// ---- bends

// CAD kernels now and then lay triangles across a whole fillet, or along it so thin that the bend in the
// other direction turns them over.  Points beside such a triangle project anywhere, so its edges are split
// first, the one farthest from the surface before the others, each at the middle of its arc.
void PatchRemesher::split_across_bends() {
  if (planar_ || geometry_.is_facets(face_) || !spans_bend()) return;
  for (int round = 0; round < kBendRounds; ++round) {
    std::vector<std::pair<Index, Index>> across;
    for (Index t = 0; t < patch_.triangle_slots(); ++t) {
      if (!patch_.alive(t)) continue;
      const Index* v = &patch_.vertex[3 * t];
      if (alignment(v[0], v[1], v[2]) >= kAlignedShort) continue;
      if (const Index e = highest_edge(t); e >= 0) across.emplace_back(patch_.origin(e), patch_.target(e));
    }
    bool any = false;
    for (const auto& [a, b] : across) any |= split_arc(a, b);
    poll_();
    if (!any) return;
  }
}

// Does a long edge turn by much?
bool PatchRemesher::spans_bend() const {
  for (Index e = 0; e < 3 * patch_.triangle_slots(); ++e) {
    if (!patch_.alive(e / 3) || patch_.twin[e] < e) continue;
    const Index a = patch_.origin(e), b = patch_.target(e);
    const Vec3 &na = patch_.normals[a], &nb = patch_.normals[b];
    if (norm2(na) > 0 && norm2(nb) > 0 && dot(na, nb) < kBend && edge_ratio(a, b) > 1) return true;
  }
  return false;
}

Vec3 PatchRemesher::rise(Index a, Index b) const {
  return rise_of_arc(points()[b] - points()[a], patch_.normals[a], patch_.normals[b]);
}

// The edge of t, longer than wanted, whose arc rises highest; -1 if none does.
Index PatchRemesher::highest_edge(Index t) const {
  Index highest = -1;
  double most2 = 0;
  for (Index e = 3 * t; e < 3 * t + 3; ++e) {
    const Index a = patch_.origin(e), b = patch_.target(e);
    const double r2 = norm2(rise(a, b));
    if (r2 <= most2 || edge_ratio(a, b) <= 1) continue;
    most2 = r2;
    highest = e;
  }
  return highest;
}

bool PatchRemesher::split_arc(Index a, Index b) {
  const Index e = patch_.find_edge(a, b);
  if (e < 0 || patch_.twin[e] < 0) return false;
  const Vec3 na = patch_.normals[a], nb = patch_.normals[b];
  const Vec3 middle = 0.5 * (points()[a] + points()[b]) + rise(a, b);
  const Vec3 p = geometry_.project_to_face(face_, middle, na + nb);
  if (!(distance(p, middle) < 0.25 * distance(points()[a], points()[b]))) return false;
  const Index x = patch_.add_vertex(p, VertexKind::interior, -1);
  set_vertex(x, p, na + nb);
  const Vec3& n = patch_.normals[x];
  const double turn = 1 - dot(na, nb);
  if (!(std::min(dot(n, na), dot(n, nb)) > 1 - kHalfway * turn)) {  // at an apex the normals mislead
    patch_.pop_vertex();
    return false;
  }
  patch_.split_edge(e, x);
  return true;
}

// ---- samples of the boundary

void PatchRemesher::insert_samples() {
  using Pending = FacePatch::Pending;
  std::priority_queue<std::tuple<double, Index, Index, Index>> longest;
  const auto push = [&](const Pending& part) {
    if (part.first >= part.last) return;
    const Index e = patch_.boundary_edge(part.origin);
    const double length2 = norm2(points()[patch_.target(e)] - points()[part.origin]);
    longest.emplace(length2, part.origin, part.first, part.last);
  };
  // Not before the bends are split: across one the normals at both ends would look doubtful.
  if (!planar_) drop_doubtful_normals();
  for (const Pending& part : patch_.pending) push(part);
  patch_.pending.clear();
  std::size_t steps = 0;
  while (!longest.empty()) {
    const auto [length2, origin, first, last] = longest.top();
    longest.pop();
    const Index middle = first + (last - first) / 2;
    patch_.split_edge(patch_.boundary_edge(origin), middle);
    push_star(middle);
    lawson();
    push({origin, first, middle});
    push({middle, middle + 1, last});
    if ((++steps & 255) == 0) poll_();
  }
  if (!planar_) drop_doubtful_normals();
}

// ---- Lawson flips

// Sum of the angles facing e over 180 degrees, or one of the two triangles turned over.  Sines are signed by
// the surface normal; sin(alpha + beta) < 0 needs neither square root nor arc function.
bool PatchRemesher::violates_delaunay(Index e) const {
  const Index m = patch_.twin[e];
  const Index a = patch_.origin(e), b = patch_.target(e);
  const Vec3 &pa = points()[a], &pb = points()[b], &pc = points()[patch_.apex(e)],
             &pd = points()[patch_.apex(m)];
  const Vec3 u = pa - pc, v = pb - pc, w = pb - pd, x = pa - pd;
  const Vec3 cross1 = cross(u, v), cross2 = cross(w, x);
  Vec3 n = patch_.normals[a] + patch_.normals[b];
  if (norm2(n) < 0.1) n = cross1 + cross2;
  const double s1 = dot(cross1, n), s2 = dot(cross2, n);
  if (s1 <= 0 || s2 <= 0) return true;
  const double d1 = dot(u, v), d2 = dot(w, x);
  return s1 * d2 + s2 * d1 < -kFlipMargin * (std::abs(s1 * d2) + std::abs(s2 * d1));
}

bool PatchRemesher::can_flip(Index e) const {
  const Index m = patch_.twin[e];
  const Index a = patch_.origin(e), b = patch_.target(e), c = patch_.apex(e), d = patch_.apex(m);
  if (c == d) return false;
  const double after = std::min(alignment(c, a, d), alignment(d, b, c));
  if (after < (edge_ratio(c, d) < kShort ? kAlignedShort : kAligned)) {
    const double before = std::min(alignment(c, a, b), alignment(d, b, a));
    if (after < before) return false;
  }
  return patch_.find_edge(c, d) < 0;
}

void PatchRemesher::push_star(Index v) {
  patch_.for_each_corner(v, [&](Index c) {
    stack_.push_back(c);
    stack_.push_back(FacePatch::next(c));
    stack_.push_back(FacePatch::prev(c));
  });
}

void PatchRemesher::lawson() {
  // The bound only matters where normals contradict each other.
  std::size_t budget = 1000 + 30 * stack_.size();
  while (!stack_.empty() && budget > 0) {
    --budget;
    ++flip_tests_;
    const Index e = stack_.back();
    stack_.pop_back();
    if (!patch_.alive(e / 3) || patch_.twin[e] < 0) continue;
    if (!violates_delaunay(e) || !can_flip(e)) continue;
    const Index s = patch_.twin[e] / 3, t = e / 3;
    patch_.flip(e);
    for (const Index h : {3 * t, 3 * t + 2, 3 * s, 3 * s + 2}) stack_.push_back(h);
  }
  stack_.clear();
}

void PatchRemesher::make_delaunay() {
  const Index n = static_cast<Index>(patch_.vertex.size());
  for (Index e = n - 1; e >= 0; --e)
    if (patch_.alive(e / 3) && patch_.twin[e] > e) stack_.push_back(e);
  poll_();
  lawson();
}

}  // namespace dm
