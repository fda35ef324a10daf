#include "boundary/weld.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace dm {

namespace {

constexpr double kClose = 0.3;  // distance of points that become one, over the mean length of their edges

class Welder {
 public:
  Welder(const LabelledTriangulation& mesh, const Plc& plc)
      : tets_(mesh.tets), complex_(mesh.boundary), plc_(plc), to_(mesh.tets.vertex_count()) {}

  bool run(const std::vector<Index>& points, SurfaceMesh& welded) {
    may_weld_.assign(to_.size(), 0);
    for (const Index v : points) may_weld_[v] = !complex_.triangles_at(v).empty();
    do {
      welded = {};
      std::iota(to_.begin(), to_.end(), 0);
      if (!join()) return false;
    } while (!make_triangles(welded));
    make_segments(welded);
    number_points(welded);
    return true;
  }

 private:
  struct Pair {
    double length;
    Index a, b;
  };

  // Pairs joined by an edge of a tetrahedron, closest first.
  bool join() {
    std::vector<Pair> pairs;
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t) || tets_.is_ghost(t)) continue;
      const Tet& v = tets_.corners(t);
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
          const auto [a, b] = std::minmax(v[i], v[j]);
          if (!may_weld_[a] || !may_weld_[b]) continue;
          const double length = distance(tets_.point(a), tets_.point(b));
          if (length < kClose * std::min(mean_edge(a), mean_edge(b))) pairs.push_back({length, a, b});
        }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
      return std::tie(x.length, x.a, x.b) < std::tie(y.length, y.a, y.b);
    });
    bool any = false;
    for (const Pair& pair : pairs) any |= join_groups(pair);
    for (Index& v : to_) v = find(v);
    return any;
  }

  Index find(Index v) const {
    while (to_[v] != v) v = to_[v];
    return v;
  }

  // The point of the lowest dimension stays, of which a group has one: groups do not grow along a curve.
  bool join_groups(const Pair& pair) {
    Index a = find(pair.a), b = find(pair.b);
    if (a == b) return false;
    const int da = complex_.entity(a).dimension, db = complex_.entity(b).dimension;
    if (std::tie(db, b) < std::tie(da, a)) std::swap(a, b);
    if (da == 0 && db == 0) return false;
    for (const Index v : {pair.a, pair.b})
      if (distance(tets_.point(v), tets_.point(a)) > kClose * mean_edge(v)) return false;
    to_[b] = a;
    return true;
  }

  double mean_edge(Index v) const {
    double sum = 0;
    int count = 0;
    for (const Index t : complex_.triangles_at(v))
      for (const Index w : complex_.corners(t))
        if (w != v) sum += distance(tets_.point(v), tets_.point(w)), ++count;
    return sum / count;
  }

  // Triangles with the same corners become one, or none.  False when no CAD face has the two solids that are
  // left on its sides; their points will stay apart.
  bool make_triangles(SurfaceMesh& welded) {
    std::map<Triangle, std::vector<Index>> stacks;
    for (Index t = 0; t < complex_.slot_count(); ++t) {
      if (!complex_.alive(t)) continue;
      Triangle key = corners(t);
      std::sort(key.begin(), key.end());
      if (key[0] != key[1] && key[1] != key[2]) stacks[key].push_back(t);
    }
    for (const auto& [key, stack] : stacks) {
      Index behind = 0, front = 0;
      net_solids(key, stack, behind, front);
      if (behind == front) continue;
      const Index face = face_between(stack, behind, front);
      if (face < 0) {
        for (const Index t : stack)
          for (const Index v : complex_.corners(t)) may_weld_[v] = 0;
        return false;
      }
      Triangle q = key;
      if (plc_.face_solids[face][0] != behind) std::swap(q[1], q[2]);
      welded.triangles.push_back(q);
      welded.triangle_face.push_back(face);
    }
    return true;
  }

  Triangle corners(Index t) const {
    const auto [a, b, c] = complex_.corners(t);
    return {to_[a], to_[b], to_[c]};
  }

  // The solids on both sides of coincident triangles: those that do not cancel.
  void net_solids(const Triangle& key, const std::vector<Index>& stack, Index& behind, Index& front) const {
    std::map<Index, int> balance;
    for (const Index t : stack) {
      const auto [b, f] = complex_.solids(t);
      const int sign = is_even(key, corners(t)) ? 1 : -1;
      balance[b] += sign;
      balance[f] -= sign;
    }
    for (const auto& [solid, count] : balance) {
      if (count > 0) behind = solid;
      if (count < 0) front = solid;
    }
  }

  static bool is_even(const Triangle& key, const Triangle& q) {
    for (int i = 0; i < 3; ++i)
      if (q[i] == key[0]) return q[(i + 1) % 3] == key[1];
    return false;
  }

  // One of the stack's if it has these solids on its sides, whichever way round; else any.
  Index face_between(const std::vector<Index>& stack, Index a, Index b) const {
    const auto separates = [&](Index f) {
      const auto& s = plc_.face_solids[f];
      return (s[0] == a && s[1] == b) || (s[0] == b && s[1] == a);
    };
    for (const Index t : stack)
      if (separates(complex_.face(t))) return complex_.face(t);
    for (Index f = 0; f < static_cast<Index>(plc_.face_solids.size()); ++f)
      if (separates(f)) return f;
    return -1;
  }

  void make_segments(SurfaceMesh& welded) const {
    std::vector<Segment> sides;
    for (const auto& [a, b, c] : welded.triangles)
      for (const auto& [p, q] : {Segment{a, b}, Segment{b, c}, Segment{c, a}})
        sides.push_back({std::min(p, q), std::max(p, q)});
    std::sort(sides.begin(), sides.end());
    std::map<Segment, Index> edges;
    for (const auto& [key, edge] : complex_.segments()) {
      const auto [a, b] = BoundaryComplex::segment_of_key(key);
      const Segment s{std::min(to_[a], to_[b]), std::max(to_[a], to_[b])};
      if (s[0] == s[1] || !std::binary_search(sides.begin(), sides.end(), s)) continue;
      const auto [it, is_new] = edges.try_emplace(s, edge);
      if (!is_new) it->second = std::min(it->second, edge);
    }
    for (const auto& [segment, edge] : edges) {
      welded.segments.push_back(segment);
      welded.segment_edge.push_back(edge);
    }
  }

  // Points that have a triangle, in their order.
  void number_points(SurfaceMesh& welded) const {
    std::vector<Index> number(to_.size(), -1);
    for (const Triangle& q : welded.triangles)
      for (const Index v : q) number[v] = 0;
    for (Index v = 0; v < static_cast<Index>(number.size()); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<Index>(welded.points.size());
      welded.points.push_back(tets_.point(v));
      welded.point_entity.push_back(complex_.entity(v));
    }
    for (Triangle& q : welded.triangles)
      for (Index& v : q) v = number[v];
    for (Segment& s : welded.segments)
      for (Index& v : s) v = number[v];
  }

  const Triangulation& tets_;
  const BoundaryComplex& complex_;
  const Plc& plc_;
  std::vector<Index> to_;       // by point: the one that it becomes
  std::vector<char> may_weld_;  // by point
};

}  // namespace

bool weld_points(const LabelledTriangulation& mesh, const Plc& plc, const std::vector<Index>& points,
                 SurfaceMesh& welded) {
  return Welder(mesh, plc).run(points, welded);
}

}  // namespace dm
