#include "kernel/triangulation.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "kernel/predicates.h"

namespace dm {

void Triangulation::set_marked(Index tet, int i, bool on) {
  const auto bit = static_cast<std::uint8_t>(1 << i);
  flags_[tet] = static_cast<std::uint8_t>(on ? flags_[tet] | bit : flags_[tet] & ~bit);
}

std::size_t Triangulation::bytes() const {
  const auto held = [](const auto& array) { return array.capacity() * sizeof(array[0]); };
  return held(points_) + held(corners_) + held(neighbours_) + held(tags_) + held(flags_) + held(vertex_tet_) +
         held(free_) + held(numbers_);
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

bool Triangulation::finite_conflict(const Tet& tet, const Vec3& p, Index number) const {
  const int sign = insphere(points_[tet[0]], points_[tet[1]], points_[tet[2]], points_[tet[3]], p);
  if (sign != 0) return sign > 0;
  return tie_conflict(tet, p, number);
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
  return is_ghost(tet) ? ghost_conflict(tet, p, number) : finite_conflict(corners_[tet], p, number);
}

bool Triangulation::in_conflict(Index tet, const Vec3& p) const { return conflict(tet, p, vertex_count()); }

Index Triangulation::locate(const Vec3& p, Index hint) const { return walk(p, hint); }

// Visibility walk: it cannot cycle in a Delaunay triangulation, for every step lowers the power of p.  A
// tetrahedron that contains p and has it for no corner is in conflict, so the walk ends.
Index Triangulation::walk(const Vec3& p, Index hint) const {
  Index tet = is_ghost(hint) ? neighbours_[hint][3] >> 2 : hint;
  Face entered = -1;
  for (;;) {
    if (is_ghost(tet)) return tet;
    const Tet& c = corners_[tet];
    const Vec3 &a = points_[c[0]], &b = points_[c[1]], &d = points_[c[2]], &e = points_[c[3]];
    const filter::Seen seen = filter::see(a, b, d, e, p);
    const double power = seen.power();
    if (power > 0 && power * power > seen.power_error2()) return tet;
    const double error2 = seen.volume_error2();
    int out = -1;
    double lowest = 0;
    for (int i = 0; i < 4; ++i)
      if (seen.volume[i] < lowest && 4 * tet + i != entered && seen.volume[i] * seen.volume[i] > error2)
        lowest = seen.volume[i], out = i;
    if (out < 0) {
      const std::array<const Vec3*, 4> corner = {&a, &b, &d, &e};
      for (int i = 0; i < 4 && out < 0; ++i) {
        if (seen.volume[i] * seen.volume[i] > error2 || 4 * tet + i == entered) continue;
        auto replaced = corner;
        replaced[i] = &p;
        if (orient3d(*replaced[0], *replaced[1], *replaced[2], *replaced[3]) < 0) out = i;
      }
    }
    if (out < 0) {
      if (a == p || b == p || d == p || e == p) return -1;
      return tet;
    }
    entered = neighbours_[tet][out];
    tet = entered >> 2;
  }
}

Face Triangulation::find_cavity(const Vec3& p, Index start, bool stop_at_marks, Cavity& cavity) const {
  cavity.tets.clear();
  cavity.border.clear();
  if (!in_conflict(start, p)) return -1;
  return search(p, vertex_count(), start, stop_at_marks, cavity);
}

// Depth-first search over the tetrahedra in conflict.  cavity.created holds the tetrahedra found outside,
// whose stamps have to be removed.
Face Triangulation::search(const Vec3& p, Index number, Index start, bool stop_at_marks,
                           Cavity& cavity) const {
  cavity.tets.clear();
  cavity.border.clear();
  cavity.created.clear();
  cavity.tets.push_back(start);
  flags_[start] |= kInside;
  Face stopped = -1;
  for (std::size_t done = 0; done < cavity.tets.size() && stopped < 0; ++done) {
    const Index tet = cavity.tets[done];
    for (int i = 0; i < 4; ++i) {
      const Index next = neighbours_[tet][i] >> 2;
      std::uint8_t& flags = flags_[next];
      if ((flags & kStamps) == 0) {
        if (conflict(next, p, number)) {
          flags |= kInside;
          cavity.tets.push_back(next);
        } else {
          flags |= kOutside;
          cavity.created.push_back(next);
        }
      }
      if (flags & kOutside) {
        cavity.border.push_back(4 * tet + i);
      } else if (stop_at_marks && marked(tet, i)) {
        stopped = 4 * tet + i;
        break;
      }
    }
  }
  for (const Index tet : cavity.tets) flags_[tet] &= 15;
  for (const Index tet : cavity.created) flags_[tet] &= 15;
  cavity.created.clear();
  return stopped;
}

Index Triangulation::insert(const Vec3& p, Cavity& cavity) {
  const Index vertex = vertex_count();
  points_.push_back(p);
  vertex_tet_.push_back(-1);
  fill(vertex, cavity);
  return vertex;
}

// Replaces the cavity by the star of `vertex`.
void Triangulation::fill(Index vertex, Cavity& cavity) {
  struct Made {
    Tet corners;
    Face outside;
    std::uint16_t tag;
    std::uint8_t marks;
  };
  std::vector<Made> made;
  const std::size_t count = cavity.border.size();
  made.reserve(count);
  for (const Face face : cavity.border) {
    const Index tet = face >> 2;
    const int i = face & 3;
    const Tet& c = corners_[tet];
    const int* f = kFaceCorners[i];
    Made m{{c[f[0]], c[f[1]], c[f[2]], vertex}, neighbours_[tet][i], tags_[tet], 0};
    if (is_ghost(tet) && i != 3) {  // turn the ghost to corner 3, the vertex to corner 2
      const int g = i == 1 ? 2 : 1;
      m.corners = {m.corners[(g + 2) % 3], m.corners[(g + 1) % 3], vertex, ghost};
    }
    if (flags_[tet] >> i & 1) m.marks = static_cast<std::uint8_t>(is_ghost(tet) && i != 3 ? 4 : 8);
    made.push_back(m);
  }
  cavity.created.resize(count);
  std::size_t used = 0;
  for (std::size_t k = 0; k < count; ++k) {
    Index slot;
    if (used < cavity.tets.size()) {
      slot = cavity.tets[used++];
    } else if (!free_.empty()) {
      slot = free_.back();
      free_.pop_back();
    } else {
      slot = slot_count();
      corners_.emplace_back();
      neighbours_.emplace_back();
      tags_.emplace_back();
      flags_.emplace_back();
    }
    cavity.created[k] = slot;
  }
  for (; used < cavity.tets.size(); ++used) {
    corners_[cavity.tets[used]].fill(free_slot);
    free_.push_back(cavity.tets[used]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Index tet = cavity.created[k];
    const Made& m = made[k];
    corners_[tet] = m.corners;
    tags_[tet] = m.tag;
    flags_[tet] = m.marks;
    const Face face = 4 * tet + (m.corners[3] == ghost ? 2 : 3);
    neighbours_[tet][face & 3] = m.outside;
    neighbours_[m.outside >> 2][m.outside & 3] = face;
  }
  link(cavity);
}

// Neighbours of the created tetrahedra among themselves: the two on an edge of the border meet in the
// triangle of that edge and the new vertex.
void Triangulation::link(const Cavity& cavity) {
  std::vector<std::pair<std::array<Index, 2>, Face>> edges;
  edges.reserve(3 * cavity.created.size());
  for (const Index tet : cavity.created) {
    const Tet& c = corners_[tet];
    const int apex = c[3] == ghost ? 2 : 3;
    for (int i = 0; i < 4; ++i) {
      if (i == apex) continue;
      std::array<Index, 2> edge{};
      int n = 0;
      for (int j = 0; j < 4; ++j)
        if (j != i && j != apex) edge[n++] = c[j];
      if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
      edges.push_back({edge, 4 * tet + i});
    }
    for (const Index v : c) vertex_tet_[v + 1] = tet;
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0; k + 1 < edges.size(); k += 2) {
    const Face f = edges[k].second, g = edges[k + 1].second;
    neighbours_[f >> 2][f & 3] = g;
    neighbours_[g >> 2][g & 3] = f;
  }
}

}  // namespace dm
