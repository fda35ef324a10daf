#include "refinement/boundary_site.h"

#include <algorithm>

namespace dm {

namespace {

constexpr double kFlat = -0.87;  // cosine of the angle at which a site may see a segment: 150 degrees

bool contains(const std::vector<Index>& list, Index t) {
  return std::find(list.begin(), list.end(), t) != list.end();
}

}  // namespace

bool BoundarySite::swallowed(Index t) const { return contains(swallowed_, t); }

bool BoundarySite::is_own_segment(Index a, Index b) const {
  return (a == own_[0] && b == own_[1]) || (a == own_[1] && b == own_[0]);
}

SiteVerdict BoundarySite::propose(const Vec3& p, Index hint, Index t, Index a, Index b) {
  site_ = p;
  face_ = t >= 0 ? mesh_.boundary.face(t) : -1;
  own_ = {a, b};
  segment_ = {-1, -1};
  const Index start = conflict_near(mesh_.tets, p, hint);
  if (start < 0) return SiteVerdict::outside_cavity;
  mesh_.tets.find_cavity(p, start, false, cavity_);
  if (cavity_.border.empty()) return SiteVerdict::outside_cavity;
  if (!collect_patch(t, a, b)) return SiteVerdict::outside_cavity;
  if (segment_[0] >= 0) return SiteVerdict::segment;
  if (patch_.size() != swallowed_.size()) return SiteVerdict::other_boundary;
  if (!collect_ring() || !ring_separates_regions()) return SiteVerdict::not_a_disc;
  sharpness_ = evaluate_site(mesh_, cavity_, p, bound_, target_, kRejected);
  return sharpness_ < kRejected ? SiteVerdict::ok : SiteVerdict::not_a_disc;
}

// Would the site make a triangle so flat on the segment that no tetrahedron on it is any good?
bool BoundarySite::is_flat_on(Index u, Index w) const {
  const Vec3 a = mesh_.tets.point(u) - site_, b = mesh_.tets.point(w) - site_;
  return dot(a, b) < kFlat * std::sqrt(norm2(a) * norm2(b));
}

// The labelled triangles inside the cavity, and those of them that hang together with t (or the segment's
// fan) without crossing a segment.  False when t itself is not among them.
bool BoundarySite::collect_patch(Index t, Index a, Index b) {
  const Triangulation& tets = mesh_.tets;
  const BoundaryComplex& complex = mesh_.boundary;
  swallowed_.clear();
  patch_.clear();

  border_.assign(cavity_.border.begin(), cavity_.border.end());
  std::sort(border_.begin(), border_.end());
  for (const Index tet : cavity_.tets) {
    if (!tets.marks(tet) || tets.is_ghost(tet)) continue;
    for (int i = 0; i < 4; ++i) {
      if (!tets.marked(tet, i) || std::binary_search(border_.begin(), border_.end(), 4 * tet + i)) continue;
      const Index label = label_of(mesh_, tet, i);
      if (!swallowed(label)) swallowed_.push_back(label);
    }
  }
  BoundaryComplex::Fan fan;
  if (t >= 0) {
    patch_.push_back(t);
  } else {
    const int n = complex.triangles_at(a, b, fan);
    patch_.assign(fan.begin(), fan.begin() + n);
  }
  for (const Index seed : patch_)
    if (!swallowed(seed)) return false;
  for (std::size_t k = 0; k < patch_.size(); ++k) {
    const Triangle q = complex.corners(patch_[k]);
    for (int i = 0; i < 3; ++i) {
      const Index u = q[i], w = q[(i + 1) % 3];
      if (is_own_segment(u, w)) continue;
      const int n = complex.triangles_at(u, w, fan);
      if (complex.is_segment(u, w)) {
        // Two of its triangles would become one.
        const auto inside =
            std::count_if(fan.begin(), fan.begin() + n, [&](Index s) { return swallowed(s); });
        if (is_flat_on(u, w) || inside >= std::min(n, 2)) segment_ = {u, w};
        continue;
      }
      for (int m = 0; m < n; ++m)
        if (swallowed(fan[m]) && !contains(patch_, fan[m])) patch_.push_back(fan[m]);
    }
  }
  return true;
}

// The boundary edges of the patch, per CAD face; false unless the patch is a disc in each face.
bool BoundarySite::collect_ring() {
  const BoundaryComplex& complex = mesh_.boundary;
  ring_.clear();
  struct Count {
    Index face;
    int triangles, edges;
  };
  std::vector<Count> counts;
  BoundaryComplex::Fan fan;
  for (const Index t : patch_) {
    const Index face = complex.face(t);
    auto it = std::find_if(counts.begin(), counts.end(), [&](const Count& c) { return c.face == face; });
    if (it == counts.end()) it = counts.insert(it, {face, 0, 0});
    ++it->triangles;
    const Triangle& q = complex.corners(t);
    for (int i = 0; i < 3; ++i) {
      const Index a = q[i], b = q[(i + 1) % 3];
      if (is_own_segment(a, b)) {
        ++it->edges;
        continue;
      }
      int inside = 0;
      const int n = complex.triangles_at(a, b, fan);
      for (int m = 0; m < n; ++m) inside += complex.face(fan[m]) == face && contains(patch_, fan[m]);
      if (inside > 1 && !complex.is_segment(a, b)) continue;
      ++it->edges;
      ring_.push_back({a, b, face});
    }
  }
  return std::all_of(counts.begin(), counts.end(), [](const Count& c) { return c.triangles == c.edges - 2; });
}

// The solid behind the cavity's border must change exactly at the ring.
bool BoundarySite::ring_separates_regions() {
  const Triangulation& tets = mesh_.tets;
  struct Side {
    std::uint64_t key;
    int tag;
  };
  std::vector<Side> sides;
  sides.reserve(3 * cavity_.border.size());
  for (const Face f : cavity_.border) {
    const Tet& v = tets.corners(f / 4);
    Index u[3];
    for (int m = 0; m < 3; ++m) u[m] = v[(f % 4 + 1 + m) & 3];
    for (int m = 0; m < 3; ++m)
      sides.push_back({BoundaryComplex::key(u[m], u[(m + 1) % 3]), tets.tag(f / 4)});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key < b.key; });
  std::vector<std::uint64_t> ring;
  for (const RingEdge& e : ring_) ring.push_back(BoundaryComplex::key(e.a, e.b));
  std::sort(ring.begin(), ring.end());
  // Two faces that meet where no CAD edge lies (the boundary was replaced there) would share a triangle.
  if (std::adjacent_find(ring.begin(), ring.end()) != ring.end()) return false;
  std::size_t found = 0;
  for (std::size_t k = 0; k + 1 < sides.size(); k += 2) {
    if (sides[k].key != sides[k + 1].key) return false;
    if (k + 2 < sides.size() && sides[k + 2].key == sides[k].key) return false;
    const bool on_ring = std::binary_search(ring.begin(), ring.end(), sides[k].key);
    if (sides[k].tag != sides[k + 1].tag && !on_ring) return false;
    found += on_ring;
  }
  return found == ring.size();
}

const std::vector<Index>& BoundarySite::commit() {
  Triangulation& tets = mesh_.tets;
  BoundaryComplex& complex = mesh_.boundary;
  const Index v = tets.insert(site_, cavity_);
  for (const Index t : patch_) complex.remove(t);
  if (face_ >= 0)
    complex.set_entity(v, {2, face_});
  else
    complex.split_segment(own_[0], own_[1], v);
  std::vector<std::uint64_t> ring;
  for (const RingEdge& e : ring_) {
    complex.add(e.a, e.b, v, e.face);
    ring.push_back(BoundaryComplex::key(e.a, e.b));
  }
  std::sort(ring.begin(), ring.end());
  for (const Index tet : cavity_.created) {
    const Tet& q = tets.corners(tet);
    for (int i = 0; i < 4; ++i) {
      if (q[i] == v) continue;
      Index u[2] = {-1, -1};
      int n = 0;
      for (int m = 0; m < 4; ++m)
        if (m != i && q[m] != v) u[n++] = q[m];
      if (std::binary_search(ring.begin(), ring.end(), BoundaryComplex::key(u[0], u[1])))
        tets.set_marked(tet, i, true);
    }
  }
  return cavity_.created;
}

}  // namespace dm
