// Lawson flips among the thin triangles of a CAD face, so that every one in a narrow strip has a side across.
//
// Elsewhere a pair of thin triangles is flipped for the larger angles; in a strip, between two curves nearer
// to each other than the tolerance, for the shorter side, judged by the places along the strip: in space
// triangles lie over one another where the curves' segments bulge further than the strip is wide.
// Precondition: the face is loaded in the editor.  Cost: constant per flip.
#pragma once

#include <array>
#include <set>
#include <vector>

#include "surfaces/plc_editor.h"
#include "surfaces/small_features.h"

namespace dm {

class StripFlips {
 public:
  // sharp: points of tips, whose fans may be flipped however high they are.
  StripFlips(const Plc& plc, const Geometry& geometry, const Tolerance& tolerance,
             const std::set<Index>& sharp, PlcEditor& editor)
      : plc_(plc), geometry_(geometry), tolerance_(tolerance), sharp_(sharp), editor_(editor) {}

  // Starts from these sides; each flip takes one of the steps.
  void run(std::vector<Segment> stack, std::size_t& steps);

  // Does a low triangle lie in a strip?
  bool is_in_strip(const Triangle& v) const;

 private:
  using Quad = std::array<Vec3, 4>;
  // Two curves nearer to each other than the tolerance; none if the width is 0.
  struct Strip {
    Index one = -1, other = -1;
    double width = 0;
  };

  const Vec3& at(Index p) const { return plc_.points[p]; }
  double height(Index a, Index b, Index c) const;
  bool may_flip(Index a, Index b, Index c, double heights) const;
  bool wants_flip(Index a, Index b, Index c, Index d) const;
  Strip strip_of(const std::array<Index, 4>& points) const;
  double width_between(Index one, Index other, const std::array<Index, 4>& points) const;
  Quad unrolled(const std::array<Index, 4>& points, const Strip& strip) const;

  const Plc& plc_;
  const Geometry& geometry_;
  const Tolerance& tolerance_;
  const std::set<Index>& sharp_;
  PlcEditor& editor_;
};

}  // namespace dm
