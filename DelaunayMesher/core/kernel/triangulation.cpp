#include "kernel/triangulation.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "base/failure.h"
#include "kernel/predicates.h"

namespace dm {

void Triangulation::set_marked(Index tet, int i, bool on) {
  const auto bit = static_cast<std::uint8_t>(1 << i);
  flags_[tet] = static_cast<std::uint8_t>(on ? flags_[tet] | bit : flags_[tet] & ~bit);
}

Triangulation::Arrays Triangulation::release() && {
  flags_ = {};
  vertex_tet_ = {};
  return {std::move(points_), std::move(corners_), std::move(neighbours_), std::move(tags_), slots_.next};
}

void Triangulation::reserve_vertices(std::size_t count) {
  points_.reserve(count);
  vertex_tet_.reserve(count);
}

std::size_t Triangulation::bytes() const {
  const auto held = [](const auto& array) { return array.size() * sizeof(array[0]); };
  return held(points_) + held(corners_) + held(neighbours_) + held(tags_) + held(flags_) + held(vertex_tet_) +
         held(slots_.free) + held(numbers_);
}

// Four corners and p on one sphere.  Every vertex is lifted by an infinitesimal, the larger the number the
// larger: the power function changes by lift_i * volume_i for a corner and by -lift_p * (volume of the
// tetrahedron) for p, so the vertex of the highest number whose factor is not zero decides.
bool Triangulation::tie_conflict(const Tet& tet, const Vec3& p, Index number) const {
  ++predicate_counters().insphere_perturbed;
  std::array<std::pair<Index, int>, 4> order;
  for (int i = 0; i < 4; ++i) order[i] = {number_of(tet[i]), i};
  std::sort(order.begin(), order.end(), std::greater<>());
  for (const auto& [corner_number, i] : order) {
    if (corner_number < number) return false;
    std::array<const Vec3*, 4> c = {&points_[tet[0]], &points_[tet[1]], &points_[tet[2]], &points_[tet[3]]};
    c[i] = &p;
    const int sign = orient3d(*c[0], *c[1], *c[2], *c[3]);
    if (sign != 0) return sign > 0;
  }
  return false;
}

// The filter could not tell.
bool Triangulation::close_conflict(const Tet& tet, const Vec3& p, Index number) const {
  const int sign =
      filter::insphere_exact(points_[tet[0]], points_[tet[1]], points_[tet[2]], points_[tet[3]], p);
  return sign != 0 ? sign > 0 : tie_conflict(tet, p, number);
}

inline bool Triangulation::finite_conflict(const Tet& tet, const Vec3& p, Index number) const {
  const Vec3* points = points_.data();
  const filter::Seen seen = filter::see(points[tet[0]], points[tet[1]], points[tet[2]], points[tet[3]], p);
  const double power = seen.power();
  if (power * power > seen.power_error2()) [[likely]]
    return power > 0;
  return close_conflict(tet, p, number);
}

// Outside the hull plane: conflict.  In it: conflict when inside the (perturbed) circle of the facet, which
// is where the sphere of the tetrahedron behind the facet cuts the plane; the volume factor of that
// tetrahedron's fourth corner is zero here, so the perturbed answer too depends on the facet alone.
bool Triangulation::ghost_conflict(Index tet, const Vec3& p, Index number) const {
  const Tet& c = corners_[tet];
  const int sign = orient3d(points_[c[0]], points_[c[1]], points_[c[2]], p);
  if (sign != 0) return sign > 0;
  return finite_conflict(corners_[neighbours_[tet][3] >> 2], p, number);
}

bool Triangulation::conflict(Index tet, const Vec3& p, Index number) const {
  if (is_ghost(tet)) [[unlikely]]
    return ghost_conflict(tet, p, number);
  return finite_conflict(corners_[tet], p, number);
}

bool Triangulation::in_conflict(Index tet, const Vec3& p) const { return conflict(tet, p, vertex_count()); }

Index Triangulation::locate(const Vec3& p, Index hint) const { return walk(p, hint, Everywhere{}); }

// Visibility walk: it cannot cycle in a Delaunay triangulation, for every step lowers the power of p.  It may
// stop at the first tetrahedron in conflict; one that contains p and has it for no corner is, so it ends.
template <class Region>
Index Triangulation::walk(const Vec3& p, Index hint, const Region& region) const {
  Index tet = is_ghost(hint) ? neighbours_[hint][3] >> 2 : hint;
  int entered = -1;
  while (!is_ghost(tet)) {
    const Tet& c = corners_[tet];
    if (!region(c)) return kLeft;
    const std::array<const Vec3*, 4> corner = {&points_[c[0]], &points_[c[1]], &points_[c[2]],
                                               &points_[c[3]]};
    const filter::Seen seen = filter::see(*corner[0], *corner[1], *corner[2], *corner[3], p);
    const double power = seen.power();
    if (power > 0 && power * power > seen.power_error2()) return tet;
    const double error2 = seen.volume_error2();
    int out = -1;
    double lowest = 0;
    for (int i = 0; i < 4; ++i) {
      const double v = seen.volume[i];
      if (v < lowest && i != entered && v * v > error2) lowest = v, out = i;
    }
    for (int i = 0; i < 4 && out < 0; ++i) {
      if (seen.volume[i] * seen.volume[i] > error2 || i == entered) continue;
      auto replaced = corner;
      replaced[i] = &p;
      if (orient3d(*replaced[0], *replaced[1], *replaced[2], *replaced[3]) < 0) out = i;
    }
    if (out < 0) {
      for (const Vec3* q : corner)
        if (*q == p) return -1;
      return tet;
    }
    const Face face = neighbours_[tet][out];
    tet = face >> 2;
    entered = face & 3;
  }
  return region(corners_[tet]) ? tet : kLeft;
}

Face Triangulation::find_cavity(const Vec3& p, Index start, bool stop_at_marks, Cavity& cavity) const {
  cavity.tets.clear();
  cavity.border.clear();
  cavity.outside.clear();
  if (!in_conflict(start, p)) return -1;
  return stop_at_marks ? search<true>(p, vertex_count(), start, cavity, Everywhere{})
                       : search<false>(p, vertex_count(), start, cavity, Everywhere{});
}

// Breadth-first search over the tetrahedra in conflict, a level at a time: gather the neighbours not seen
// yet, test them all, append those in conflict.  No step branches on the outcome of a test, which nothing can
// predict, and the tests of a level overlap.
template <bool kStopAtMarks, class Region>
Face Triangulation::search(const Vec3& p, Index number, Index start, Cavity& cavity,
                           const Region& region) const {
  std::uint8_t* flags = flags_.data();
  cavity.tets.resize(
      64);  // not to its capacity: that of the largest cavity so far would be written each time
  cavity.seen.resize(std::max<std::size_t>(cavity.seen.capacity(), 128));
  cavity.tets[0] = cavity.seen[0] = start;
  flags[start] |= kInside | kSeen;
  std::size_t inside = 1, seen = 1;
  Face stopped = -1;
  for (std::size_t level = 0; level < inside && stopped == -1;) {
    const std::size_t level_end = inside, first = seen;
    const std::size_t most = seen + 4 * (level_end - level) + 4;
    if (cavity.seen.size() < most) cavity.seen.resize(2 * most);
    if (cavity.sign.size() < most) cavity.sign.resize(2 * most);
    for (std::size_t k = level; k < level_end; ++k)
      for (const Face face : neighbours_[cavity.tets[k]]) {
        const Index next = face >> 2;
        cavity.seen[seen] = next;
        seen += (flags[next] & kSeen) == 0;
        flags[next] |= kSeen;
      }
    if (cavity.tets.size() < inside + seen - first) cavity.tets.resize(2 * (inside + seen));
    inside = test(p, number, cavity, first, seen, inside);
    if (kStopAtMarks) stopped = marked_inside({cavity.tets.data() + level_end, inside - level_end});
    for (std::size_t k = level_end; k < inside; ++k)
      if (!region(corners_[cavity.tets[k]])) stopped = kLeft;
    if (stopped == kLeft) break;
    level = level_end;
  }
  cavity.tets.resize(inside);
  if (stopped == -1) collect_border(cavity);
  for (std::size_t k = 0; k < seen; ++k) flags[cavity.seen[k]] &= kMarks;
  return stopped;
}

// Tests cavity.seen[first .. end - 1] and appends those in conflict to cavity.tets; returns its new length.
std::size_t Triangulation::test(const Vec3& p, Index number, Cavity& cavity, std::size_t first,
                                std::size_t end, std::size_t inside) const {
  std::uint8_t* flags = flags_.data();
  const std::int8_t* sign = cavity.sign.data();
  sphere_tests_(points_.data(), corners_.data(), cavity.seen.data() + first, end - first, p,
                cavity.sign.data());
  const Index* seen = cavity.seen.data() + first;
  Index* tets = cavity.tets.data();
  for (std::size_t k = 0; k < end - first; ++k) {
    const Index tet = seen[k];
    bool hit = sign[k] > 0;
    if (sign[k] == 0) [[unlikely]]
      hit = conflict(tet, p, number);
    tets[inside] = tet;
    inside += hit;
    flags[tet] = static_cast<std::uint8_t>(flags[tet] | hit * kInside);
  }
  return inside;
}

// The first marked face of these with both sides in conflict, or -1.
Face Triangulation::marked_inside(std::span<const Index> tets) const {
  for (const Index tet : tets) {
    if ((flags_[tet] & kMarks) == 0) continue;
    for (int i = 0; i < 4; ++i)
      if (marked(tet, i) && (flags_[neighbours_[tet][i] >> 2] & kInside)) return 4 * tet + i;
  }
  return -1;
}

void Triangulation::collect_border(Cavity& cavity) const {
  const std::size_t room = 4 * cavity.tets.size();
  cavity.border.resize(room);
  cavity.outside.resize(room);
  Face *border = cavity.border.data(), *outside = cavity.outside.data();
  const std::uint8_t* flags = flags_.data();
  std::size_t n = 0;
  for (const Index tet : cavity.tets) {
    const std::array<Face, 4>& neighbours = neighbours_[tet];
    for (int i = 0; i < 4; ++i) {
      border[n] = 4 * tet + i;
      outside[n] = neighbours[i];
      n += (flags[neighbours[i] >> 2] & kInside) == 0;
    }
  }
  cavity.border.resize(n);
  cavity.outside.resize(n);
}

template Face Triangulation::search<false>(const Vec3&, Index, Index, Cavity&, const Everywhere&) const;
template Face Triangulation::search<false>(const Vec3&, Index, Index, Cavity&, const Part&) const;
template Index Triangulation::walk(const Vec3&, Index, const Everywhere&) const;
template Index Triangulation::walk(const Vec3&, Index, const Part&) const;

void Triangulation::reserve_slots(std::size_t wanted) {
  if (!slots_.enough(wanted))
    resize_slots(std::max(slots_.next + wanted, std::min(corners_.size() / 4 * 5, kMostSlots)));
}

void Triangulation::resize_slots(std::size_t size) {
  if (size > kMostSlots)
    throw Failure("kernel", "too_many_points", "There are too many points for one triangulation.");
  corners_.resize(size);
  neighbours_.resize(size);
  tags_.resize(size);
  flags_.resize(size);
  slots_.end = static_cast<Index>(size);
}

Index Triangulation::insert(const Vec3& p, Cavity& cavity) {
  const Index vertex = vertex_count();
  points_.push_back(p);
  vertex_tet_.push_back(-1);
  reserve_slots(cavity.border.size());
  fill(vertex, cavity, slots_);
  return vertex;
}

// Replaces the cavity by the star of `vertex`.
void Triangulation::fill(Index vertex, Cavity& cavity, Slots& slots) {
  const std::size_t count = cavity.border.size(), old = cavity.tets.size();
  const int corner_count = collect(vertex, cavity);
  cavity.created.resize(count);
  for (std::size_t k = 0; k < count; ++k) cavity.created[k] = k < old ? cavity.tets[k] : slots.take();
  for (std::size_t k = count; k < old; ++k) {
    corners_[cavity.tets[k]].fill(free_slot);
    slots.free.push_back(cavity.tets[k]);
  }
  if (corner_count <= kLocalCorners)
    link(cavity);
  else
    link_many(cavity);
  vertex_tet_[vertex] = cavity.created[0];
}

// Reads what stands behind the border faces, before the slots are filled again, and numbers the corners of
// the border: vertex_tet_ holds ~number until link() sets it again.  Returns how many numbers there are.
int Triangulation::collect(Index vertex, Cavity& cavity) {
  const std::size_t count = cavity.border.size();
  cavity.made.resize(count);
  Index* vertex_tet = vertex_tet_.data();
  Index next = 1;  // 0 is the ghost's
  const auto local = [&](Index v) {
    if (v < 0) [[unlikely]]
      return std::uint16_t{0};
    const Index at = vertex_tet[v];
    const bool fresh = at >= 0;
    const Index number = fresh ? next : ~at;
    vertex_tet[v] = ~number;
    next += fresh;
    return static_cast<std::uint16_t>(number);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const Index tet = cavity.border[k] >> 2;
    const int i = cavity.border[k] & 3;
    const Tet& c = corners_[tet];
    const int* f = kFaceCorners[i];
    Tet v = {c[f[0]], c[f[1]], c[f[2]], vertex};
    const unsigned mark = flags_[tet] >> i & 1u;
    Cavity::Made& m = cavity.made[k];
    m.tag = tags_[tet];
    if (c[3] == ghost && i != 3) [[unlikely]] {  // turn the ghost to the end
      if (i == 1)
        v = {v[0], v[1], ghost, vertex};
      else
        v = {v[2], v[0], ghost, vertex};
      m.corners = {v[1], v[0], vertex, ghost};
      m.marks = static_cast<std::uint8_t>(mark << 2);
    } else {
      m.corners = v;
      m.marks = static_cast<std::uint8_t>(mark << 3);
    }
    m.local = {local(v[0]), local(v[1]), local(v[2])};
  }
  return next;
}

// Fills the slots.  Neighbours among the created: each border edge has a face on either side, which sees it
// in opposite direction; the table holds, at [from][to], the new triangle of that edge and the vertex.
void Triangulation::link(Cavity& cavity) {
  const std::size_t count = cavity.created.size();
  cavity.edge_faces.resize(kLocalCorners * kLocalCorners);
  Face* edge = cavity.edge_faces.data();
  for (std::size_t k = 0; k < count; ++k) {
    const Cavity::Made& m = cavity.made[k];
    const auto [a, b, c] = m.local;
    const auto opposite = opposite_corners(m.corners);
    const Face face = 4 * cavity.created[k];
    edge[kLocalCorners * b + c] = face + opposite[0];
    edge[kLocalCorners * c + a] = face + opposite[1];
    edge[kLocalCorners * a + b] = face + opposite[2];
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Cavity::Made& m = cavity.made[k];
    const auto [a, b, c] = m.local;
    const auto opposite = opposite_corners(m.corners);
    std::array<Face, 4>& neighbours = place(cavity, k);
    neighbours[opposite[0]] = edge[kLocalCorners * c + b];
    neighbours[opposite[1]] = edge[kLocalCorners * a + c];
    neighbours[opposite[2]] = edge[kLocalCorners * b + a];
  }
}

// The corners that lie opposite the three edges of the border face, and the new vertex.
inline std::array<std::uint8_t, 4> Triangulation::opposite_corners(const Tet& corners) {
  if (corners[3] == ghost) [[unlikely]]
    return {1, 0, 3, 2};
  return {0, 1, 2, 3};
}

// Writes created[k] but for the neighbours among the created, which it returns for the caller to fill in.
inline std::array<Face, 4>& Triangulation::place(const Cavity& cavity, std::size_t k) {
  const Cavity::Made& m = cavity.made[k];
  const Index tet = cavity.created[k];
  const int apex = opposite_corners(m.corners)[3];
  corners_[tet] = m.corners;
  tags_[tet] = m.tag;
  flags_[tet] = m.marks;
  const Face outside = cavity.outside[k];
  neighbours_[tet][apex] = outside;
  neighbours_[outside >> 2][outside & 3] = 4 * tet + apex;
  for (int j = 0; j < 4; ++j)
    if (j != apex && m.corners[j] != ghost) vertex_tet_[m.corners[j]] = tet;
  return neighbours_[tet];
}

// As link(), for cavities with more corners than the table has: by sorting the edges.
void Triangulation::link_many(Cavity& cavity) {
  std::vector<std::pair<std::array<Index, 2>, Face>> edges;
  edges.reserve(3 * cavity.created.size());
  for (std::size_t k = 0; k < cavity.created.size(); ++k) {
    place(cavity, k);
    const Tet& corners = cavity.made[k].corners;
    const int apex = opposite_corners(corners)[3];
    for (int i = 0; i < 4; ++i) {
      if (i == apex) continue;
      std::array<Index, 2> edge{};
      int n = 0;
      for (int j = 0; j < 4; ++j)
        if (j != i && j != apex) edge[n++] = corners[j];
      if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
      edges.push_back({edge, 4 * cavity.created[k] + i});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size(); k += 2) {
    const Face f = edges[k].second, g = edges[k + 1].second;
    neighbours_[f >> 2][f & 3] = g;
    neighbours_[g >> 2][g & 3] = f;
  }
}

}  // namespace dm
