// Remeshing of one face's patch by local operations in space, not in the (u, v) plane.
//
// Idea: the tessellation is only the map on which this happens.  Where it does not follow the surface its
// edges are split first.  The curve samples are put in its boundary, always in the longest edge: between fine
// samples and a coarse triangulation the curve's bulge would turn triangles over.  Old boundary points are
// collapsed away, short edges too; then triangles whose circumradius exceeds the wanted one get a point near
// their circumcentre (Chew 1993, on the surface; randomly displaced because exact centres leave slivers),
// largest first, with Lawson flips after every insertion; Laplacian smoothing weighted by the wanted size
// evens the result out. Each new point is projected on the exact surface; no operation may turn a triangle
// away from the surface's normal.
//
// Precondition: a patch from PatchSource::extract.  Postcondition: boundary = the sampled curves, except for
// the vertices that remesh_patch returns.  Cost: O(triangles) on surfaces that the tessellation resolves.
// Known limit: angles next to boundary points that lie closer together than the wanted size are not bounded.
#pragma once

#include <atomic>
#include <vector>

#include "base/context.h"
#include "curves/length_field.h"
#include "plc/geometry.h"
#include "surfaces/face_patch.h"
#include "surfaces/remesh.h"

namespace dm {

// Cancelling: only the calling thread may talk to the Context; the others watch the flag.
struct PatchPoll {
  Context* context = nullptr;
  const std::atomic<bool>* stop = nullptr;
  const std::atomic<double>* done = nullptr;
  void operator()() const {
    if (stop && stop->load(std::memory_order_relaxed)) throw Cancelled();
    if (context) context->poll(done ? done->load(std::memory_order_relaxed) : 0);
  }
};

class PatchRemesher {
 public:
  PatchRemesher(FacePatch& patch, Index face, const Geometry& geometry, const LengthField& lengths,
                const SurfaceOptions& options, std::uint64_t seed, PatchPoll poll);

  // All steps.  Returns the old boundary points (PLC points) that could not be removed.
  std::vector<Index> run();

  // The steps, each leaving a valid patch.
  void split_across_bends();
  void insert_samples();  // puts the pending samples in, coarse to fine, with Lawson flips in between
  void make_delaunay();   // Lawson flips over the whole patch
  // Collapses old boundary points; `aligned`: the least alignment of triangles that this may leave.
  void remove_dropped(double aligned);
  void collapse_short(double ratio);
  void refine(double radius_ratio);
  void smooth(int sweeps);
  void jitter();
  // Splits an edge at the projected middle whatever its length, if that folds nothing.
  bool split_at_middle(Index e);

 private:
  // Cosine of the largest angle between a triangle's normal and the surface's at its corners (a triangle
  // across the inside of a bend fails it); 0 for a degenerate triangle.
  double alignment(Index a, Index b, Index c) const {
    return alignment(points()[a], points()[b], points()[c], a, b, c);
  }
  double alignment(const Vec3& pa, const Vec3& pb, const Vec3& pc, Index a, Index b, Index c) const;
  double edge_ratio(Index a, Index b) const;  // length over the wanted one
  double radius_ratio(Index t) const;         // circumradius over the wanted edge length
  const std::vector<Vec3>& points() const { return patch_.points; }

  void start_vertices();
  void drop_doubtful_normals();
  // Puts v at p.  The normal's sign follows `hint` (near-degenerate surfaces have two sheets at hardly any
  // distance); a zero hint leaves it to the geometry.
  void set_vertex(Index v, const Vec3& p, const Vec3& hint);

  bool spans_bend() const;
  Vec3 rise(Index a, Index b) const;  // from the edge's middle to that of its arc
  Index highest_edge(Index t) const;
  bool split_arc(Index a, Index b);

  bool violates_delaunay(Index e) const;
  bool can_flip(Index e) const;
  void push_star(Index v);
  void lawson();

  bool remove_boundary_vertex(Index v, double aligned);
  bool flip_towards_ear(Index v, double aligned);
  bool is_smooth() const;
  // Worst new triangle, < 0: not allowed.
  double collapse_quality(Index e, Index gone, double max_ratio, double aligned) const;

  void enqueue(Index t);
  bool insert_near_centre(Index t);
  double wanted_points() const;
  bool split_longest(Index t);
  Index locate(Index t, const Vec3& p) const;
  bool may_insert(Index s, const Vec3& p, double length, double radius) const;
  void finish_insertion(Index v);

  Vec3 smoothed_position(Index v) const;
  double star_angle(Index v, const Vec3& p) const;  // cosine-like measure of the worst corner round v at p
  bool star_stays(Index v, const Vec3& p) const;

  FacePatch& patch_;
  const Index face_;
  const Geometry& geometry_;
  const LengthField& lengths_;
  const SurfaceOptions& options_;
  const std::uint64_t seed_;
  const PatchPoll poll_;
  const bool planar_;
  std::vector<Index> stack_;    // half-edges for lawson()
  std::size_t flip_tests_ = 0;  // edges that lawson() looked at
  struct Entry {
    Index triangle, stamp;
  };
  std::vector<std::vector<Entry>> buckets_;  // triangles to refine by the logarithm of their radius
  double refine_limit_ = 0;
  Index top_bucket_ = -1;
};

}  // namespace dm
