#include "boundary/partition.h"

#include <algorithm>
#include <map>

namespace dm {

namespace {

constexpr std::uint16_t kUnknown = 0xffff;

class Partition {
 public:
  explicit Partition(LabelledTriangulation& mesh) : mesh_(mesh), tets_(mesh.tets), complex_(mesh.boundary) {}

  Index run(const std::vector<Index>& missing) {
    collect_faces_at_points();
    for (const Index t : missing)
      if (complex_.alive(t)) complex_.remove(t);
    claim();
    spread();
    empty_impossible_contacts();
    const Index replaced = drop_labels_inside() + label_interfaces();
    drop_repeated_labels();
    complex_.drop_bare_segments();
    return replaced;
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
  }

  // Tetrahedra on labelled faces take the solid that the label says; the majority where labels disagree.
  void claim() {
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t)) continue;
      tets_.set_tag(t, tets_.is_ghost(t) ? 0 : kUnknown);
      if (tets_.is_ghost(t)) queue_.push_back(t);
    }
    for (Index t = 0; t < tets_.slot_count(); ++t) {
      if (tets_.is_free(t) || tets_.is_ghost(t) || !tets_.marks(t)) continue;
      std::array<Index, 4> claims;
      int n = 0;
      for (int i = 0; i < 4; ++i) {
        if (!tets_.marked(t, i)) continue;
        const Index label = label_of(mesh_, t, i);
        const bool front = corner_in_front(tets_.corners(t), i, complex_.corners(label));
        claims[n++] = complex_.solids(label)[front ? 1 : 0];
      }
      std::sort(claims.begin(), claims.begin() + n);
      tets_.set_tag(t, static_cast<std::uint16_t>(claims[n / 2]));
      queue_.push_back(t);
    }
  }

  void spread() {
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      const Index t = queue_[k];
      for (int i = 0; i < 4; ++i) {
        const Index n = tets_.neighbour(t, i) / 4;
        if (tets_.marked(t, i) || tets_.tag(n) != kUnknown) continue;
        tets_.set_tag(n, tets_.tag(t));
        queue_.push_back(n);
      }
    }
    for (Index t = 0; t < tets_.slot_count(); ++t)
      if (!tets_.is_free(t) && tets_.tag(t) == kUnknown) tets_.set_tag(t, 0);
  }

  bool can_meet(Index a, Index b) const {
    return a == b || std::any_of(solids_of_.begin(), solids_of_.end(), [&](const auto& entry) {
             const auto& s = entry.second;
             return (s[0] == a && s[1] == b) || (s[0] == b && s[1] == a);
           });
  }

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

  LabelledTriangulation& mesh_;
  Triangulation& tets_;
  BoundaryComplex& complex_;
  std::vector<std::vector<Index>> faces_at_;
  std::map<Index, std::array<Index, 2>> solids_of_;
  std::vector<Index> queue_;
};

}  // namespace

Index partition_solids(LabelledTriangulation& mesh, const std::vector<Index>& missing) {
  return Partition(mesh).run(missing);
}

}  // namespace dm
