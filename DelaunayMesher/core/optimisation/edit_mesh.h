// The mesh while it is being optimised: adjacency that can be edited locally, and the badness of every
// element.
//
// Works in place on the tetrahedra of a VolumeMesh.  Removed tetrahedra leave free slots that later ones use
// again; finish() closes the gaps.  Faces of the boundary triangulation are marked.  All changes of
// connectivity go through replace(): a set of tetrahedra gives way to another one with the same outer faces,
// but for those that boundary flips, splits and contractions change together with their triangles.
// Precondition: check_volume_mesh(mesh).  After finish() it holds again.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/volume_mesh.h"
#include "optimisation/quality.h"

namespace dm {

struct IndexHash {
  template <std::size_t n>
  std::size_t operator()(const std::array<Index, n>& key) const {
    std::uint64_t h = 0;
    for (const Index i : key) h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15ULL;
    return h ^ (h >> 29);
  }
};

inline Triangle sorted(Triangle t) {
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  if (t[1] > t[2]) std::swap(t[1], t[2]);
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  return t;
}
inline Segment sorted(const Segment& s) { return {std::min(s[0], s[1]), std::max(s[0], s[1])}; }

class EditMesh {
 public:
  explicit EditMesh(VolumeMesh& mesh);
  void finish();

  static constexpr int kMaxReplace = 64;  // tetrahedra of one replacement, old and new each
  static constexpr Index kRemoved = -1;
  enum ChangeKind {
    kTet,
    kLink,
    kPoint,
    kVertexTet,
    kFreed,
    kTaken,
    kGrown,
    kNewPoint,
    kTriangle,
    kNewTriangle,
    kSegment,
    kNewSegment
  };

  Index slot_count() const { return static_cast<Index>(mesh_.tets.size()); }
  bool removed(Index tet) const { return mesh_.tets[tet][0] == kRemoved; }
  const Tet& tet(Index t) const { return mesh_.tets[t]; }
  Index neighbour(Index t, int face) const { return mesh_.neighbours[t][face]; }
  bool marked(Index t, int face) const { return marks_[t] >> face & 1; }
  Index solid(Index t) const { return mesh_.tet_solid[t]; }
  Index vertex_tet(Index v) const { return vertex_tet_[v]; }  // -1: isolated
  Index vertex_count() const { return static_cast<Index>(mesh_.points.size()); }
  const Vec3& point(Index v) const { return mesh_.points[v]; }
  Entity entity(Index v) const { return mesh_.point_entity[v]; }
  bool interior(Index v) const { return mesh_.point_entity[v].dimension == 3; }
  double bad(Index t) const { return bad_[t]; }
  int corner_index(Index t, Index v) const {
    const Tet& c = mesh_.tets[t];
    return c[0] == v ? 0 : c[1] == v ? 1 : c[2] == v ? 2 : 3;
  }
  double compute_bad(const Tet& t) const { return badness(cosines(t)); }
  AngleCosines cosines(const Tet& t) const {
    return angle_cosines(point(t[0]), point(t[1]), point(t[2]), point(t[3]));
  }

  // The tetrahedra at v, in an order given by the data alone.  The span is valid until the next call.
  std::span<const Index> star(Index v);
  // Is v a boundary point at which parts of the mesh touch that share no face there?  star() finds one of
  // them only, so such a point must stay.
  bool pinched(Index v) const { return pinched_[v] != 0; }
  // Lists all stars at once, which makes star() cheap until the next replace().
  void list_stars();
  // Extreme angles of the mesh as it was given.
  const AngleCosines& first_extremes() const { return first_extremes_; }
  // CAD faces the boundary point v lies on, sorted; empty for interior points.
  std::span<const Index> faces_of(Index v) const {
    return {point_faces_.data() + face_start_[v],
            static_cast<std::size_t>(face_start_[v + 1] - face_start_[v])};
  }
  // Do all three points lie on one CAD face?  No interior triangle may be made of them.
  bool on_one_face(Index a, Index b, Index c) const;

  // A clock that goes on with every change after start_clock(), and when something in the star of v last
  // changed: what failed there later than that fails again.  A trial counts when it is kept.
  void start_clock() { changed_.assign(mesh_.points.size(), ++clock_); }
  Index now() const { return clock_; }
  Index last_change(Index v) const { return changed_[v]; }
  Index last_change(const Tet& t) const {
    return std::max({changed_[t[0]], changed_[t[1]], changed_[t[2]], changed_[t[3]]});
  }

  // A new point on these CAD faces (sorted), which no tetrahedron uses yet.
  Index add_point(const Vec3& p, Entity entity, std::span<const Index> faces);
  // Puts v at p; its tetrahedra, whose badness then is `bad`.
  void move_point(Index v, const Vec3& p, std::span<const Index> tets, std::span<const float> bad);
  // The boundary triangle with these corners, -1 if none; its CAD face; is (a, b) a segment of a CAD edge?
  // kTwice where CAD faces or edges lie on each other, which is an error of the CAD: nothing changes there.
  static constexpr Index kTwice = -2;
  Index find_triangle(Index a, Index b, Index c);
  const Triangle& triangle(Index k) const { return mesh_.triangles[k]; }
  Index triangle_face(Index k) const { return mesh_.triangle_face[k]; }
  Index find_segment(Index a, Index b);
  bool is_segment(Index a, Index b) { return find_segment(a, b) != -1; }
  Index segment_edge(Index k) const { return mesh_.segment_edge[k]; }
  const Segment& segment(Index k) const { return mesh_.segments[k]; }
  // Changes of the boundary; its tetrahedra are to be replaced along with it.  Corners -1 remove it.
  void set_triangle(Index k, const Triangle& corners, Index face);
  void set_segment(Index k, const Segment& ends);
  void add_triangle(const Triangle& corners, Index face);
  void add_segment(const Segment& ends, Index edge);
  // Puts `after` in the place of `before`.  Precondition: one solid, no marked inner face; same outer faces
  // but for those without neighbour: they may change, and the new ones are marked. Without `after` the outer
  // faces become boundary.  Returns the slots of the
  // new tetrahedra; the span is valid until the next call.
  std::span<const Index> replace(std::span<const Index> before, std::span<const Tet> after) {
    return replace(before, after, {}, {});
  }
  // The same for several solids, one for each new tetrahedron, with the new triangles of the boundary.
  std::span<const Index> replace(std::span<const Index> before, std::span<const Tet> after,
                                 std::span<const Index> solids, std::span<const Triangle> boundary);

  // A trial: all changes after begin_trial() are kept by end_trial(true) and taken back by end_trial(false).
  void begin_trial();
  void end_trial(bool keep);
  // Extreme angles of the tetrahedra that the trial has changed, before and now.
  const AngleCosines& trial_before() const { return trial_before_; }
  AngleCosines trial_now() const;
  // The sum of their shortfall().
  double trial_shortfall_before() const { return trial_shortfall_; }
  double trial_shortfall() const;
  Index trial_worst() const;  // of them, -1 if none is left

 private:
  void build_vertex_tets();
  void find_pinched_points();
  void build_point_faces();
  void mark_boundary();
  void list_boundary();
  class OpenFaces;
  void open_faces(std::span<const Index> tets, OpenFaces& open);
  void remove_tets(std::span<const Index> tets);
  void join(Index t, int i, Index link, bool marked, bool outside);
  Index take_slot();
  void mark_face(Index link);
  void expose(Index tet);
  void note_tet(Index t);
  void note(int kind, Index index, Index value = 0);
  void take_back();
  void note_change(std::span<const Index> tets);
  void close_boundary();

  VolumeMesh& mesh_;
  std::vector<double> bad_;
  std::vector<std::uint8_t> marks_;
  std::vector<char> pinched_;
  std::vector<Index> vertex_tet_, face_start_, point_faces_, free_, stamp_, star_, created_;
  std::vector<Index> star_start_, star_tets_;
  std::unordered_map<Triangle, Index, IndexHash> triangle_of_;  // by sorted corners; filled on first use
  std::unordered_map<Segment, Index, IndexHash> segment_of_;    // by sorted ends
  // What a trial has changed, as it was, in the order of the changes (edit_trial.cpp).
  struct Change {
    int kind;
    Index index, value;
    Tet tet;
    std::array<Index, 4> neighbours;
    Vec3 point;
    double bad;
    std::uint8_t marks;
  };
  bool in_trial_ = false;
  std::vector<Change> changes_;
  std::vector<Index> noted_, touched_;  // per tetrahedron the last trial that changed it; those of this one
  Index trial_ = 0;
  AngleCosines trial_before_;
  double trial_shortfall_ = 0;
  std::vector<Index> changed_;  // per point
  Index clock_ = 0;             // 0: not started
  bool stars_listed_ = false, boundary_listed_ = false;
  Index stamp_value_ = 0;
  AngleCosines first_extremes_;
};

}  // namespace dm
