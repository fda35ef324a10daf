#include "boundary/partition.h"

#include <algorithm>
#include <map>
#include <set>

#include "boundary/winding.h"

namespace dm {

namespace {

class Partition {
 public:
  Partition(LabelledTriangulation& mesh, Context& context)
      : mesh_(mesh), tets_(mesh.tets), complex_(mesh.boundary), context_(context) {}

  Replaced run(const std::vector<Index>& missing) {
    collect_faces_at_points();
    measure_windings();
    find_near(missing);
    for (const Index t : missing) {
      if (!complex_.alive(t)) continue;
      touch(complex_.corners(t));
      complex_.remove(t);
    }
    tag_rooms();
    empty_impossible_contacts();
    replaced_.triangles = drop_labels_inside() + label_interfaces();
    drop_repeated_labels();
    complex_.drop_bare_segments();
    free_bare_points();
    std::vector<Index>& points = replaced_.points;
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return std::move(replaced_);
  }

 private:
  // CAD faces at every boundary point, before any triangle is removed.
  void collect_faces_at_points() {
    faces_at_.resize(tets_.vertex_count());
    for (Index t = 0; t < complex_.slot_count(); ++t) {
      if (!complex_.alive(t)) continue;
      for (const Index v : complex_.corners(t)) {
        auto& list = faces_at_[v];
        if (std::find(list.begin(), list.end(), complex_.face(t)) == list.end())
          list.push_back(complex_.face(t));
        solids_of_[complex_.face(t)] = complex_.solids(t);
      }
    }
    for (const auto& [face, solids] : solids_of_) meeting_.insert(std::minmax(solids[0], solids[1]));
  }

  void measure_windings() {
    std::map<Index, std::vector<Triangle>> outside;  // of a solid: its surface
    for (Index t = 0; t < complex_.slot_count(); ++t) {
      if (!complex_.alive(t)) continue;
      const auto [behind, front] = complex_.solids(t);
      const auto [a, b, c] = complex_.corners(t);
      if (behind != 0) outside[behind].push_back({a, b, c});
      if (front != 0) outside[front].push_back({a, c, b});
    }
    for (auto& [solid, triangles] : outside)
      windings_.emplace_back(solid, WindingNumber(tets_.points(), std::move(triangles)));
  }

  // Tetrahedra that a missing triangle may pass through.
  void find_near(const std::vector<Index>& missing) {
    std::vector<Box> boxes;
    for (const Index t : missing) {
      boxes.emplace_back();
      for (const Index v : complex_.corners(t)) boxes.back().add(tets_.point(v));
    }
    const BoxTree tree(boxes);
    near_.assign(tets_.slot_count(), 0);
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t) || tets_.is_ghost(t)) continue;
      Box box;
      for (const Index v : tets_.corners(t)) box.add(tets_.point(v));
      near_[t] = overlaps_any(tree, boxes, box);
    }
  }

  static bool overlaps_any(const BoxTree& tree, const std::vector<Box>& boxes, const Box& box) {
    std::vector<Index> stack;
    if (!tree.empty()) stack.push_back(0);
    while (!stack.empty()) {
      const BoxTree::Node& node = tree.nodes()[stack.back()];
      stack.pop_back();
      if (!node.box.overlaps(box)) continue;
      if (node.count == 0) stack.insert(stack.end(), {node.first, node.first + 1});
      for (Index k = node.first; k < node.first + node.count; ++k)
        if (boxes[tree.order()[k]].overlaps(box)) return true;
    }
    return false;
  }

  // Rooms between labelled faces and away from missing ones: where the walls agree a room is of the solid
  // that they say, else of that whose surface winds round a place in it.
  void tag_rooms() {
    for (Index t = 0; t < tets_.slot_count(); ++t)
      if (!tets_.is_free(t)) tets_.set_tag(t, kUnknownSolid);
    std::vector<Index> room;
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t) || tets_.tag(t) != kUnknownSolid) continue;
      context_.poll(1);
      Index solid = find_room(t, room);
      if (solid < 0) solid = solid_round(largest(room));
      for (const Index tet : room)
        tets_.set_tag(tet, static_cast<std::uint16_t>(tets_.is_ghost(tet) ? 0 : solid));
    }
  }

  // Its tetrahedra are tagged as outside for now; one that a missing triangle may pass through is a room of
  // its own.  Returns the solid that all walls say, or -1.
  Index find_room(Index start, std::vector<Index>& room) {
    Index solid = -1;
    bool agree = true;
    const auto claim = [&](Index says) {
      agree &= solid < 0 || solid == says;
      solid = says;
    };
    room.assign(1, start);
    tets_.set_tag(start, 0);
    if (near_[start]) return -1;
    for (std::size_t k = 0; k < room.size(); ++k) {
      const Index t = room[k];
      if (tets_.is_ghost(t)) claim(0);
      for (int i = 0; i < 4; ++i) {
        const Index n = tets_.neighbour(t, i) / 4;
        if (!tets_.marked(t, i)) {
          if (near_[n] || tets_.tag(n) != kUnknownSolid) continue;
          tets_.set_tag(n, 0);
          room.push_back(n);
        } else if (!tets_.is_ghost(t)) {
          const Index label = label_of(mesh_, t, i);
          claim(complex_.solids(label)[corner_in_front(tets_.corners(t), i, complex_.corners(label))]);
        }
      }
    }
    return agree ? solid : -1;
  }

  Index largest(const std::vector<Index>& room) const {
    Index found = room[0];
    double most = -1;
    for (const Index t : room) {
      if (tets_.is_ghost(t)) continue;
      const auto [a, b, c, d] = tets_.corners(t);
      const Vec3& p = tets_.point(a);
      const double volume = std::abs(dot(area_vector(p, tets_.point(b), tets_.point(c)), tets_.point(d) - p));
      if (volume > most) most = volume, found = t;
    }
    return found;
  }

  Index solid_round(Index t) const {
    const auto [a, b, c, d] = tets_.corners(t);
    const Vec3 middle = 0.25 * (tets_.point(a) + tets_.point(b) + tets_.point(c) + tets_.point(d));
    Index solid = 0;
    double most = 0.5;
    for (const auto& [number, winding] : windings_) {
      const double w = winding.at(middle);
      if (w > most) most = w, solid = number;
    }
    return solid;
  }

  bool can_meet(Index a, Index b) const { return a == b || meeting_.contains(std::minmax(a, b)); }

  // Where solids meet that no CAD face separates, the tetrahedron between them is left out of both.
  void empty_impossible_contacts() {
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t) || tets_.is_ghost(t) || tets_.tag(t) == 0 || !can_meet(tets_.tag(t), 0)) continue;
      for (int i = 0; i < 4; ++i)
        if (!can_meet(tets_.tag(t), tets_.tag(tets_.neighbour(t, i) / 4))) {
          tets_.set_tag(t, 0);
          break;
        }
    }
  }

  // A label whose two sides do not agree with it stands for nothing any more.
  Index drop_labels_inside() {
    Index dropped = 0;
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t) || tets_.is_ghost(t)) continue;
      for (int i = 0; i < 4; ++i) {
        if (!tets_.marked(t, i)) continue;
        const Index label = label_of(mesh_, t, i);
        const auto [behind, front] = complex_.solids(label);
        const bool in_front = corner_in_front(tets_.corners(t), i, complex_.corners(label));
        const Index here = tets_.tag(t), beyond = tets_.tag(tets_.neighbour(t, i) / 4);
        if (here == (in_front ? front : behind) && beyond == (in_front ? behind : front)) continue;
        set_marked_both(tets_, 4 * t + i, false);
        touch(complex_.corners(label));
        complex_.remove(label);
        ++dropped;
      }
    }
    return dropped;
  }

  Index label_interfaces() {
    Index made = 0;
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t) || tets_.is_ghost(t)) continue;
      for (int i = 0; i < 4; ++i) {
        const Index n = tets_.neighbour(t, i) / 4;
        if (tets_.marked(t, i) || tets_.tag(n) == tets_.tag(t)) continue;
        add_label(t, i);
        ++made;
      }
    }
    return made;
  }

  void add_label(Index t, int i) {
    const Tet& v = tets_.corners(t);
    const Triangle corners{v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3]};
    const Index here = tets_.tag(t), beyond = tets_.tag(tets_.neighbour(t, i) / 4);
    const Index face = best_face(corners, here, beyond);
    const bool want_front = solids_of_[face][1] == here;
    Triangle q = corners;
    if (corner_in_front(v, i, q) != want_front) std::swap(q[1], q[2]);
    complex_.add(q[0], q[1], q[2], face);
    touch(q);
    set_marked_both(tets_, 4 * t + i, true);
  }

  // The CAD face between these solids that most of the corners lie on; any face between them as a last
  // resort.
  Index best_face(const Triangle& corners, Index here, Index beyond) const {
    const auto separates = [&](Index f) {
      const auto& s = solids_of_.at(f);
      return (s[0] == here && s[1] == beyond) || (s[0] == beyond && s[1] == here);
    };
    std::map<Index, int> votes;
    for (const Index v : corners)
      for (const Index f : faces_at_[v])
        if (separates(f)) ++votes[f];
    if (votes.empty())
      for (const auto& [f, solids] : solids_of_)
        if (separates(f)) votes[f] = 1;
    if (votes.empty())
      throw Failure("boundary", "leak", "two solids meet here where no CAD face separates them",
                    tets_.point(corners[0]), complex_.entity(corners[0]));
    return std::max_element(votes.begin(), votes.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  // Of two labels with the same corners only one is found from the tetrahedra.
  void drop_repeated_labels() {
    for (Index t = 0; t < complex_.slot_count(); ++t) {
      if (!complex_.alive(t)) continue;
      const auto [a, b, c] = complex_.corners(t);
      const Face f = find_face(tets_, a, b, c);
      if (f < 0 || !tets_.marked(f / 4, f % 4) || complex_.find(a, b, c) != t) complex_.remove(t);
    }
  }

  // Points that lie inside a solid now, where it overlaps itself.
  void free_bare_points() {
    for (Index v = 0; v < static_cast<Index>(faces_at_.size()); ++v)
      if (complex_.on_boundary(v) && complex_.triangles_at(v).empty()) complex_.set_entity(v, {3, 0});
  }

  void touch(const Triangle& corners) {
    replaced_.points.insert(replaced_.points.end(), corners.begin(), corners.end());
  }

  LabelledTriangulation& mesh_;
  Triangulation& tets_;
  BoundaryComplex& complex_;
  Context& context_;
  std::vector<std::vector<Index>> faces_at_;
  std::map<Index, std::array<Index, 2>> solids_of_;
  std::set<std::pair<Index, Index>> meeting_;  // pairs of solids (0: none) that a CAD face separates
  std::vector<std::pair<Index, WindingNumber>> windings_;  // of solids
  Replaced replaced_;
  std::vector<char> near_;  // by tetrahedron
};

}  // namespace

Replaced partition_solids(LabelledTriangulation& mesh, const std::vector<Index>& missing, Context& context) {
  return Partition(mesh, context).run(missing);
}

}  // namespace dm
