// Sites on the boundary: a new vertex on a CAD face or edge replaces the labelled triangles that it swallows
// by the star of itself.  Ask (propose), then act (commit).
#pragma once

#include <unordered_map>
#include <vector>

#include "refinement/angle_test.h"
#include "refinement/constrained_cavity.h"

namespace dm {

enum class SiteVerdict { ok, outside_cavity, other_boundary, not_a_disc, segment };

class BoundarySite {
 public:
  BoundarySite(LabelledTriangulation& mesh, const RadiusBound& bound, double target)
      : mesh_(mesh), bound_(bound), target_(target) {}

  // A site p for labelled triangle t, or for segment (a, b) when t is -1.  `hint`: a tetrahedron near p.
  SiteVerdict propose(const Vec3& p, Index hint, Index t, Index a, Index b);
  double quality() const { return sharpness_; }           // of the last proposal that was ok
  Segment swallowed_segment() const { return segment_; }  // after the verdict `segment`

  const Cavity& cavity() const { return cavity_; }
  bool is_ball() const { return dm::is_ball(mesh_.tets, cavity_); }

  // Inserts the last proposal that was ok; returns the tetrahedra made.
  const std::vector<Index>& commit();

 private:
  struct RingEdge {
    Index a, b, face;
  };
  bool collect_patch(Index t, Index a, Index b);
  bool collect_ring();
  bool ring_separates_regions();
  bool swallowed(Index t) const;
  bool is_flat_on(Index u, Index w) const;
  bool is_own_segment(Index a, Index b) const;

  LabelledTriangulation& mesh_;
  const RadiusBound& bound_;
  double target_, sharpness_ = -1;
  Vec3 site_;
  Index face_ = -1;  // CAD face of a triangle site
  Segment own_{-1, -1}, segment_{-1, -1};
  Cavity cavity_;
  std::vector<Index> swallowed_, patch_;
  std::vector<RingEdge> ring_;
  std::vector<Face> border_;  // of the cavity, sorted
};

}  // namespace dm
