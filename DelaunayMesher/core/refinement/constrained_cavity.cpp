#include "refinement/constrained_cavity.h"

#include <algorithm>

#include "kernel/predicates.h"

namespace dm {

namespace {

constexpr std::size_t kNear = 256;  // tetrahedra looked at by conflict_near

// After so many looks at tetrahedra of cavities that were none (some seconds), only small ones are tried:
// where the boundary crosses itself there may be no end of large ones.
constexpr std::size_t kPatience = 20'000'000, kSmall = 200;

bool sees(const Triangulation& tets, const Vec3& p, Face f) {
  const Tet& v = tets.corners(f / 4);
  const auto& q = kFaceCorners[f % 4];
  return orient3d(tets.point(v[q[0]]), tets.point(v[q[1]]), tets.point(v[q[2]]), p) > 0;
}

}  // namespace

bool is_ball(const Triangulation& tets, const Cavity& cavity) {
  std::vector<Index> all, border;
  for (const Index t : cavity.tets)
    for (const Index v : tets.corners(t)) all.push_back(v);
  for (const Face f : cavity.border)
    for (const int c : kFaceCorners[f % 4]) border.push_back(tets.corners(f / 4)[c]);
  for (auto* list : {&all, &border}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  // Euler's formula for the border of a ball: F = 2 V - 4.
  return all.size() == border.size() && cavity.border.size() + 4 == 2 * border.size();
}

bool ConstrainedSearch::find_cavity(const Vec3& p, Index start, Cavity& cavity) {
  const std::size_t before = wasted_;
  const bool found = search(p, start, cavity);
  if (found) wasted_ = before;
  return found;
}

bool ConstrainedSearch::search(const Vec3& p, Index start, Cavity& cavity) {
  cavity.border.clear();
  cavity.outside.clear();
  cavity.tets.clear();
  if (!tets_.in_conflict(start, p) || !collect(p, start, cavity)) return false;
  while (drop_unseen(p, cavity)) {
    if (!is_inside(start) || (wasted_ >= kPatience && cavity.tets.size() > kSmall)) return false;
    keep_connected(start, cavity);
  }
  return collect_border(cavity) && is_ball(tets_, cavity);
}

bool ConstrainedSearch::collect(const Vec3& p, Index start, Cavity& cavity) {
  const std::size_t most = wasted_ < kPatience ? tets_.slot_count() : kSmall;
  stamp_.resize(tets_.slot_count(), 0);
  ++epoch_;
  cavity.tets.push_back(start);
  stamp_[start] = 2 * epoch_ + 1;
  for (std::size_t k = 0; k < cavity.tets.size(); ++k) {
    if (cavity.tets.size() > most) return false;
    ++wasted_;
    const Index t = cavity.tets[k];
    for (int i = 0; i < 4; ++i) {
      const Index n = tets_.neighbour(t, i) / 4;
      if (tets_.marked(t, i) || stamp_[n] >= 2 * epoch_) continue;
      const bool conflict = tets_.in_conflict(n, p);
      stamp_[n] = 2 * epoch_ + conflict;
      if (conflict) cavity.tets.push_back(n);
    }
  }
  return true;
}

// Takes tetrahedra with a border face that p does not see out of the cavity; false when there is none.
bool ConstrainedSearch::drop_unseen(const Vec3& p, Cavity& cavity) {
  bool dropped = false;
  wasted_ += cavity.tets.size();
  for (const Index t : cavity.tets)
    for (int i = 0; i < 4 && is_inside(t); ++i) {
      const bool border = tets_.marked(t, i) || !is_inside(tets_.neighbour(t, i) / 4);
      if (!border || sees(tets_, p, 4 * t + i)) continue;
      stamp_[t] = 2 * epoch_;
      dropped = true;
    }
  return dropped;
}

// What is left of the cavity round `start`.
void ConstrainedSearch::keep_connected(Index start, Cavity& cavity) {
  std::vector<Index> inside;
  for (const Index t : cavity.tets)
    if (is_inside(t)) inside.push_back(t);
  ++epoch_;
  for (const Index t : inside) stamp_[t] = 2 * epoch_;  // seen, not yet reached
  cavity.tets.assign(1, start);
  stamp_[start] = 2 * epoch_ + 1;
  for (std::size_t k = 0; k < cavity.tets.size(); ++k)
    for (int i = 0; i < 4; ++i) {
      const Index n = tets_.neighbour(cavity.tets[k], i) / 4;
      if (tets_.marked(cavity.tets[k], i) || stamp_[n] != 2 * epoch_) continue;
      stamp_[n] = 2 * epoch_ + 1;
      cavity.tets.push_back(n);
    }
}

bool ConstrainedSearch::collect_border(Cavity& cavity) const {
  for (const Index t : cavity.tets)
    for (int i = 0; i < 4; ++i) {
      const Face g = tets_.neighbour(t, i);
      const bool inner = is_inside(g / 4);
      if (inner && tets_.marked(t, i)) return false;
      if (inner) continue;
      cavity.border.push_back(4 * t + i);
      cavity.outside.push_back(g);
    }
  return true;
}

double nearest_corner2(const Triangulation& tets, const Cavity& cavity, const Vec3& p) {
  double nearest2 = HUGE_VAL;
  for (const Face f : cavity.border)
    for (const int c : kFaceCorners[f % 4]) {
      const Index v = tets.corners(f / 4)[c];
      if (v != Triangulation::ghost) nearest2 = std::min(nearest2, norm2(tets.point(v) - p));
    }
  return nearest2;
}

Index conflict_near(const Triangulation& tets, const Vec3& p, Index hint) {
  std::vector<Index> near{hint};
  for (std::size_t k = 0; k < near.size() && k < kNear; ++k) {
    if (tets.in_conflict(near[k], p)) return near[k];
    for (int i = 0; i < 4; ++i) {
      const Index n = tets.neighbour(near[k], i) / 4;
      if (std::find(near.begin(), near.end(), n) == near.end()) near.push_back(n);
    }
  }
  return -1;
}

}  // namespace dm
