#include "order/repair.h"

#include <algorithm>
#include <unordered_set>

#include "base/tet_geometry.h"

namespace dm {
namespace {

constexpr double kSharpness = 30;   // of the smooth minimum
constexpr std::size_t kPasses = 2;  // over the kinds of nodes
constexpr int kRounds = 6;          // over the bad elements, for each kind of node
constexpr int kSteps = 6;           // per node and visit

// Tetrahedra at each corner.
class Stars {
 public:
  explicit Stars(const CurvedMesh& mesh) {
    Index points = 0;
    for (Index t = 0; t < mesh.tet_count(); ++t)
      for (Index v : mesh.corners(t)) points = std::max(points, v + 1);
    start_.assign(points + 1, 0);
    for (Index t = 0; t < mesh.tet_count(); ++t)
      for (Index v : mesh.corners(t)) ++start_[v + 1];
    for (Index v = 0; v < points; ++v) start_[v + 1] += start_[v];
    tets_.resize(start_[points]);
    std::vector<Index> end(start_.begin(), start_.end() - 1);
    for (Index t = 0; t < mesh.tet_count(); ++t)
      for (Index v : mesh.corners(t)) tets_[end[v]++] = t;
  }
  std::vector<Index> at(Index v) const { return {tets_.begin() + start_[v], tets_.begin() + start_[v + 1]}; }
  std::vector<Index> at_edge(Index a, Index b) const {
    std::vector<Index> common;
    std::set_intersection(tets_.begin() + start_[a], tets_.begin() + start_[a + 1], tets_.begin() + start_[b],
                          tets_.begin() + start_[b + 1], std::back_inserter(common));
    return common;
  }

 private:
  std::vector<Index> start_, tets_;
};

// One node that moves, with what follows it and the elements it touches.
struct Mover {
  Index node;
  double size;  // step lengths are relative to it
  std::vector<Index> elements;
  std::vector<Index> followers;  // middles of straight interior edges at a corner: they go half the way
};

class Repairer {
 public:
  Repairer(CurvedMesh& mesh, const Geometry& geometry, Context& context)
      : mesh_(mesh), geometry_(geometry), context_(context), stars_(mesh) {}

  std::vector<Index> run(std::vector<Index> bad) {
    constexpr std::array kinds = {&Repairer::move_interior_middles, &Repairer::move_interior_corners,
                                  &Repairer::slide_boundary_middles};
    for (std::size_t pass = 0; pass < kPasses * kinds.size(); ++pass) {
      const auto kind = kinds[pass % kinds.size()];
      for (int round = 0; round < kRounds && !bad.empty(); ++round) {
        bool moved = false;
        touched_ = bad;
        for (Index t : bad) {
          context_.poll(0.5);
          if (mesh_.ratio(t) < kGoodRatio) moved = (this->*kind)(t) || moved;
        }
        bad = still_bad();
        if (!moved) break;
      }
    }
    return straighten(bad);
  }

 private:
  bool move_interior_middles(Index t) { return move_middles(t, true); }
  bool slide_boundary_middles(Index t) { return move_middles(t, false); }

  bool move_middles(Index t, bool interior) {
    bool moved = false;
    for (int i = 0; i < 6; ++i) {
      const Index node = mesh_.middle(t, i);
      const int dimension = mesh_.entity(node).dimension;
      if (interior ? dimension != 3 : dimension != 2 && dimension != 1) continue;
      const Tet& c = mesh_.corners(t);
      const Index a = c[kTetEdges[i][0]], b = c[kTetEdges[i][1]];
      moved =
          climb({node, distance(mesh_.position(a), mesh_.position(b)), stars_.at_edge(a, b), {}}) || moved;
    }
    return moved;
  }
  bool move_interior_corners(Index t) {
    bool moved = false;
    for (Index v : mesh_.corners(t)) {
      if (!mesh_.interior(v)) continue;
      Mover mover{v, 0, stars_.at(v), {}};
      for (Index e : mover.elements)
        for (int i = 0; i < 6; ++i) {
          const Index a = mesh_.corners(e)[kTetEdges[i][0]], b = mesh_.corners(e)[kTetEdges[i][1]];
          if (a != v && b != v) continue;
          mover.size = std::max(mover.size, distance(mesh_.position(a), mesh_.position(b)));
          mover.followers.push_back(mesh_.middle(e, i));
        }
      std::sort(mover.followers.begin(), mover.followers.end());
      mover.followers.erase(std::unique(mover.followers.begin(), mover.followers.end()),
                            mover.followers.end());
      moved = climb(mover) || moved;
    }
    return moved;
  }

  // A step that helps the worst element may cost its neighbours: they are looked at again.
  std::vector<Index> still_bad() {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    std::erase_if(touched_, [&](Index t) { return mesh_.ratio(t) >= kGoodRatio; });
    return touched_;
  }

  // Smooth minimum of all coefficients, each relative to the largest of its element: a step can then help one
  // element while another one is still the worst.
  double soft_worst(const std::vector<Index>& elements) const {
    double sum = 0;
    for (Index t : elements) {
      const auto c = jacobian_coefficients(mesh_.nodes(t));
      double scale = 0;
      for (const double b : c) scale = std::max(scale, std::abs(b));
      for (const double b : c) sum += std::exp(-kSharpness * b / scale);
    }
    return -std::log(sum) / kSharpness;
  }
  double worst(const std::vector<Index>& elements) const {
    double w = 1;
    for (Index t : elements) w = std::min(w, mesh_.ratio(t));
    return w;
  }
  AngleRange angles(const std::vector<Index>& elements) const {
    AngleRange all{180, 0};
    for (Index t : elements) {
      const Tet& c = mesh_.corners(t);
      const AngleRange r = dihedral_range(mesh_.position(c[0]), mesh_.position(c[1]), mesh_.position(c[2]),
                                          mesh_.position(c[3]));
      all.min = std::min(all.min, r.min);
      all.max = std::max(all.max, r.max);
      // The angles of a tetrahedron and of its mirror image are the same.
      const Vec3& a = mesh_.position(c[0]);
      const Vec3 base = area_vector(a, mesh_.position(c[1]), mesh_.position(c[2]));
      if (dot(base, mesh_.position(c[3]) - a) <= 0) return {0, 180};
    }
    return all;
  }
  void place(const Mover& m, const Vec3& p) {
    const Vec3 step = p - mesh_.position(m.node);
    for (Index f : m.followers) mesh_.position(f) += 0.5 * step;
    mesh_.position(m.node) = p;
  }
  Vec3 gradient(const Mover& m, double base) {
    const double h = 1e-6 * m.size;
    const Vec3 from = mesh_.position(m.node);
    Vec3 g;
    for (int i = 0; i < 3; ++i) {
      Vec3 q = from;
      q[i] += h;
      place(m, q);
      g[i] = (soft_worst(m.elements) - base) / h;
    }
    place(m, from);
    return g;
  }

  // Steps while the worst ratio of the elements rises.  A corner must keep the angles of the straight
  // elements.
  bool climb(const Mover& m) {
    const Entity entity = mesh_.entity(m.node);
    const bool corner = mesh_.is_corner(m.node);
    bool moved = false;
    double now = soft_worst(m.elements);
    for (int step = 0; step < kSteps && worst(m.elements) < kGoodRatio; ++step) {
      const Vec3 direction = normalized(gradient(m, now)), from = mesh_.position(m.node);
      const AngleRange before = corner ? angles(m.elements) : AngleRange{};
      bool better = false;
      for (double s = 0.2; s > 0.002 && !better; s *= 0.5) {
        place(m, geometry_.project(entity, from + s * m.size * direction));
        const double trial = soft_worst(m.elements);
        const AngleRange after = corner ? angles(m.elements) : AngleRange{};
        better = trial > now + 1e-4 && after.min >= std::min(before.min, 20.0) &&
                 after.max <= std::max(before.max, 150.0);
        if (better) now = trial;
      }
      if (!better) {
        place(m, from);
        break;
      }
      moved = true;
    }
    if (moved) touched_.insert(touched_.end(), m.elements.begin(), m.elements.end());
    return moved;
  }

  std::vector<Index> straighten(const std::vector<Index>& bad) {
    std::vector<Index> straightened;
    for (std::size_t k = 0; k < bad.size(); ++k) {
      if (mesh_.ratio(bad[k]) > 0) continue;
      straighten_element(bad[k], straightened);
    }
    std::sort(straightened.begin(), straightened.end());
    straightened.erase(std::unique(straightened.begin(), straightened.end()), straightened.end());
    return straightened;
  }
  // The one edge that helps most; if none does, all six.  A straight edge can only spoil a neighbour whose
  // other edges bend: that one is straightened in turn.
  void straighten_element(Index start, std::vector<Index>& straightened) {
    std::vector<Index> pending{start};
    while (!pending.empty()) {
      const Index t = pending.back();
      pending.pop_back();
      if (mesh_.ratio(t) > 0 || straight_.contains(t)) continue;
      straightened.push_back(t);
      if (straighten_best_edge(t)) continue;
      straight_.insert(t);
      for (int i = 0; i < 6; ++i) {
        mesh_.position(mesh_.middle(t, i)) = mesh_.straight_middle(t, i);
        for (Index e : around(t, i))
          if (e != t && mesh_.ratio(e) <= 0) pending.push_back(e);
      }
    }
  }
  bool straighten_best_edge(Index t) {
    int best = -1;
    double best_ratio = 0;
    for (int i = 0; i < 6; ++i) {
      Vec3& middle = mesh_.position(mesh_.middle(t, i));
      const Vec3 curved = middle;
      middle = mesh_.straight_middle(t, i);
      const double ratio = worst(around(t, i));
      middle = curved;
      if (ratio <= best_ratio) continue;
      best = i;
      best_ratio = ratio;
    }
    if (best < 0) return false;
    mesh_.position(mesh_.middle(t, best)) = mesh_.straight_middle(t, best);
    return true;
  }
  std::vector<Index> around(Index t, int edge) const {
    const Tet& c = mesh_.corners(t);
    return stars_.at_edge(c[kTetEdges[edge][0]], c[kTetEdges[edge][1]]);
  }

  CurvedMesh& mesh_;
  const Geometry& geometry_;
  Context& context_;
  Stars stars_;
  std::vector<Index> touched_;
  std::unordered_set<Index> straight_;  // elements without a curved edge: those without volume stay so
};

}  // namespace

std::vector<Index> repair(CurvedMesh& mesh, const Geometry& geometry, std::vector<Index> bad,
                          Context& context) {
  if (bad.empty()) return {};
  return Repairer(mesh, geometry, context).run(std::move(bad));
}

}  // namespace dm
