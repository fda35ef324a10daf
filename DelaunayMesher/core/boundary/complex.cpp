#include "boundary/complex.h"

#include <algorithm>
#include <string>

namespace dm {

BoundaryComplex::BoundaryComplex(const SurfaceMesh& surface, std::vector<std::array<Index, 2>> face_solids)
    : face_solids_(std::move(face_solids)),
      entities_(surface.point_entity),
      incident_(surface.points.size()) {
  triangles_.reserve(surface.triangles.size() * 5 / 4);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    add(a, b, c, surface.triangle_face[t]);
  }
  for (std::size_t s = 0; s < surface.segments.size(); ++s)
    segments_[key(surface.segments[s][0], surface.segments[s][1])] = surface.segment_edge[s];
}

std::uint64_t BoundaryComplex::key(Index a, Index b) {
  if (a > b) std::swap(a, b);
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

Entity BoundaryComplex::entity(Index v) const {
  return v < static_cast<Index>(entities_.size()) ? entities_[v] : Entity{3, 0};
}

void BoundaryComplex::set_entity(Index v, Entity entity) {
  if (v >= static_cast<Index>(entities_.size())) {
    entities_.resize(v + 1, Entity{3, 0});
    incident_.resize(v + 1);
  }
  entities_[v] = entity;
}

int BoundaryComplex::triangles_at(Index a, Index b, Fan& fan) const {
  int n = 0;
  for (const Index t : incident_[a]) {
    const Triangle& q = triangles_[t].corners;
    if (q[0] != b && q[1] != b && q[2] != b) continue;
    if (n == kMaxFan)
      throw Failure("boundary", "too_many_faces_at_edge",
                    "More than " + std::to_string(kMaxFan) + " faces meet at one edge; cut the part there.",
                    {}, entity(a), entity(b));
    fan[n++] = t;
  }
  return n;
}

Index BoundaryComplex::find(Index a, Index b, Index c) const {
  if (a >= static_cast<Index>(incident_.size())) return -1;
  for (const Index t : incident_[a]) {
    const Triangle& q = triangles_[t].corners;
    const bool has_b = q[0] == b || q[1] == b || q[2] == b;
    const bool has_c = q[0] == c || q[1] == c || q[2] == c;
    if (has_b && has_c) return t;
  }
  return -1;
}

bool BoundaryComplex::has_edge(Index a, Index b) const {
  return std::any_of(incident_[a].begin(), incident_[a].end(), [&](Index t) {
    const Triangle& q = triangles_[t].corners;
    return q[0] == b || q[1] == b || q[2] == b;
  });
}

Index BoundaryComplex::segment(Index a, Index b) const {
  if (entity(a).dimension > 1 || entity(b).dimension > 1) return -1;
  const auto it = segments_.find(key(a, b));
  return it == segments_.end() ? -1 : it->second;
}

void BoundaryComplex::set_acute(Index a, Index b) { acute_[key(a, b)] = 1; }

bool BoundaryComplex::is_acute(Index a, Index b) const {
  if (acute_.empty() || entity(a).dimension > 1 || entity(b).dimension > 1) return false;
  return acute_.count(key(a, b)) > 0;
}

Index BoundaryComplex::add(Index a, Index b, Index c, Index face) {
  const Index t = slot_count();
  triangles_.push_back({{a, b, c}, face});
  for (const Index v : {a, b, c}) incident_[v].push_back(t);
  return t;
}

void BoundaryComplex::remove(Index t) {
  for (const Index v : triangles_[t].corners) {
    auto& list = incident_[v];
    list.erase(std::find(list.begin(), list.end(), t));
  }
  triangles_[t].face = -1;
}

void BoundaryComplex::split_segment(Index a, Index b, Index v) {
  const auto it = segments_.find(key(a, b));
  const Index edge = it->second;
  segments_.erase(it);
  set_entity(v, {1, edge});
  segments_[key(a, v)] = edge;
  segments_[key(v, b)] = edge;
  if (acute_.erase(key(a, b))) {
    set_acute(a, v);
    set_acute(v, b);
  }
}

void BoundaryComplex::drop_bare_segments() {
  std::erase_if(segments_, [&](const auto& entry) {
    const auto [a, b] = segment_of_key(entry.first);
    const bool bare = !has_edge(a, b);
    if (bare) acute_.erase(entry.first);
    return bare;
  });
}

Index opposite_corner(const BoundaryComplex& complex, Index t, Index a, Index b) {
  const Triangle& q = complex.corners(t);
  for (const Index v : q)
    if (v != a && v != b) return v;
  return -1;
}

namespace {

// Cosine of the angle at a.
double angle_cosine(const std::vector<Vec3>& p, Index a, Index b, Index c) {
  return dot(normalized(p[b] - p[a]), normalized(p[c] - p[a]));
}

double largest_cosine(const std::vector<Vec3>& p, Index a, Index b, Index c) {
  return std::max({angle_cosine(p, a, b, c), angle_cosine(p, b, c, a), angle_cosine(p, c, a, b)});
}

bool oriented_as(const Triangle& q, Index a, Index b) {
  return (q[0] == a && q[1] == b) || (q[1] == a && q[2] == b) || (q[2] == a && q[0] == b);
}

}  // namespace

bool can_flip(const BoundaryComplex& complex, const std::vector<Vec3>& points, Index a, Index b,
              EdgeFlip& flip) {
  if (complex.is_segment(a, b)) return false;
  BoundaryComplex::Fan fan;
  if (complex.triangles_at(a, b, fan) != 2) return false;
  Index first = fan[0], second = fan[1];
  if (complex.face(first) != complex.face(second)) return false;
  if (!oriented_as(complex.corners(first), a, b)) std::swap(first, second);
  const Index c = opposite_corner(complex, first, a, b), d = opposite_corner(complex, second, a, b);
  if (c == d || complex.has_edge(c, d)) return false;
  flip = {a, b, c, d, first, second};
  const auto normal = [&](Index u, Index v, Index w) {
    return normalized(area_vector(points[u], points[v], points[w]));
  };
  const Vec3 before = normal(a, b, c) + normal(b, a, d);
  const Vec3 n0 = normal(c, a, d), n1 = normal(d, b, c);
  return dot(n0, before) > 0.3 && dot(n1, before) > 0.3 && dot(n0, n1) > -0.2;
}

bool flip_keeps_angles(const std::vector<Vec3>& points, const EdgeFlip& f) {
  const double before = std::acos(
      std::min(1.0, std::max(largest_cosine(points, f.a, f.b, f.c), largest_cosine(points, f.b, f.a, f.d))));
  const double after = std::acos(
      std::min(1.0, std::max(largest_cosine(points, f.c, f.a, f.d), largest_cosine(points, f.d, f.b, f.c))));
  return after > std::min(25 * std::numbers::pi / 180, 0.8 * before);
}

std::array<Index, 2> do_flip(BoundaryComplex& complex, const EdgeFlip& f) {
  const Index face = complex.face(f.first);
  complex.remove(f.first);
  complex.remove(f.second);
  return {complex.add(f.c, f.a, f.d, face), complex.add(f.d, f.b, f.c, face)};
}

bool flip_improves(const std::vector<Vec3>& points, const EdgeFlip& f) {
  const double at_c = std::acos(std::clamp(angle_cosine(points, f.c, f.a, f.b), -1.0, 1.0));
  const double at_d = std::acos(std::clamp(angle_cosine(points, f.d, f.a, f.b), -1.0, 1.0));
  return at_c + at_d > std::numbers::pi + 1e-7;
}

Sphere circumcircle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, w = c - a, n = cross(u, w);
  const double det = 2 * norm2(n);
  if (det <= 0) return {a, HUGE_VAL};
  const Vec3 o = (1 / det) * (norm2(u) * cross(w, n) + norm2(w) * cross(n, u));
  return {a + o, norm2(o)};
}

void check_complex(const BoundaryComplex& complex) {
  BoundaryComplex::Fan fan;
  for (Index t = 0; t < complex.slot_count(); ++t) {
    if (!complex.alive(t)) continue;
    const Triangle& q = complex.corners(t);
    if (complex.find(q[0], q[1], q[2]) != t)
      throw Failure("boundary", "repeated_triangle", "a boundary triangle stands twice", {},
                    {2, complex.face(t)});
    for (int i = 0; i < 3; ++i) {
      const Index a = q[i], b = q[(i + 1) % 3];
      const int n = complex.triangles_at(a, b, fan);
      if (complex.is_segment(a, b)) continue;
      if (n != 2 || complex.face(fan[0]) != complex.face(fan[1]))
        throw Failure("boundary", "open_edge", "a boundary edge inside a face has not two triangles", {},
                      {2, complex.face(t)});
    }
  }
}

}  // namespace dm
