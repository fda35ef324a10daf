// The edge length wanted on the boundary: a part of h, and less where the boundary turned out to need it.
//
// The size field knows nothing of what goes wrong when its sizes are laid on the surface: a strip narrower
// than its triangles, a bend that they cut off.  Such places become caps: a length wanted at a point, growing
// from there at a fixed rate.  Where CAD curves lie off their faces, triangles as small as the gap would turn
// over: such places become floors, which win over caps.  Cost of at(): the size field's, plus a walk in a
// tree of the places when there are any, pruned by the least length below a node.
#pragma once

#include <vector>

#include "base/box_tree.h"
#include "sizing/size_field.h"

namespace dm {

class LengthField {
 public:
  LengthField(const SizeField& size, double edge_ratio) : size_(size), edge_ratio_(edge_ratio) {}

  double at(const Vec3& p) const { return at_between(p, 0, HUGE_VAL); }  // thread-safe
  // at(p) where that lies between the two, at less cost; elsewhere any length beyond the same one.
  // Thread-safe.
  double at_between(const Vec3& p, double low, double high) const;
  double without_caps(const Vec3& p) const { return edge_ratio_ * size_.at(p); }  // thread-safe
  double largest() const { return edge_ratio_ * size_.largest(); }
  // Asks for `length` at p; no effect where it is not wanted shorter.  Takes effect with apply_caps().
  void add_cap(const Vec3& p, double length);
  // Asks for no less than `length` at p.  Takes effect with apply_caps().
  void add_floor(const Vec3& p, double length) { floors_.add(p, -length); }
  // Rebuilds the trees.  Returns the boxes in which lengths may have changed.
  std::vector<Box> apply_caps();

 private:
  static constexpr double kGrowth = 0.5;  // with distance: steeper than the size field's, to save elements

  // Values at points, each growing with distance.
  class Places {
   public:
    void add(const Vec3& p, double value);
    void build();
    // The lowest of all values at p, or `most` if that is lower; or any below `enough`.
    double lowest(const Vec3& p, double most, double enough = -HUGE_VAL) const;

   private:
    struct Place {
      Vec3 point;
      double value;
    };
    std::vector<Place> places_;  // in the order of the tree's leaves
    BoxTree tree_;               // of the points
    std::vector<double> least_;  // value below each of its nodes
  };

  const SizeField& size_;
  double edge_ratio_;
  Places caps_, floors_;    // floors with the opposite sign
  std::vector<Box> reach_;  // of caps that are not applied yet
};

}  // namespace dm
