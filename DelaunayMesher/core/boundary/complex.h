// The labelled boundary complex: which triangles and segments stand for which CAD face and edge.
//
// Idea: labels are carried through every change of the boundary and never guessed from geometry, so thin
// walls and touching solids cannot be confused.  Plain arrays; a vertex keeps the list of its triangles.
// Coordinates live in the triangulation: functions that need them take the point array.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "base/tet_geometry.h"
#include "surfaces/surface_mesh.h"

namespace dm {

inline constexpr int kMaxFan = 64;  // triangles at one edge of a non-manifold junction

class BoundaryComplex {
 public:
  struct LabelledTriangle {
    Triangle corners;
    Index face;  // CAD face, -1 once removed
  };
  using Fan = std::array<Index, kMaxFan>;

  BoundaryComplex(const SurfaceMesh& surface, std::vector<std::array<Index, 2>> face_solids);

  Index slot_count() const { return static_cast<Index>(triangles_.size()); }
  bool alive(Index t) const { return triangles_[t].face >= 0; }
  const Triangle& corners(Index t) const { return triangles_[t].corners; }
  Index face(Index t) const { return triangles_[t].face; }
  // Solids behind and in front of the right-hand normal of triangle t.
  const std::array<Index, 2>& solids(Index t) const { return face_solids_[triangles_[t].face]; }

  bool on_boundary(Index v) const {
    return v < static_cast<Index>(entities_.size()) && entities_[v].dimension < 3;
  }
  Entity entity(Index v) const;
  void set_entity(Index v, Entity entity);

  std::span<const Index> triangles_at(Index v) const { return incident_[v]; }
  // Triangles at edge (a, b); returns their number.  Throws Failure when they are more than kMaxFan.
  int triangles_at(Index a, Index b, Fan& fan) const;
  Index find(Index a, Index b, Index c) const;  // the labelled triangle with these corners, or -1
  bool has_edge(Index a, Index b) const;
  Index segment(Index a, Index b) const;  // CAD edge of segment (a, b), or -1
  bool is_segment(Index a, Index b) const { return segment(a, b) >= 0; }
  const std::unordered_map<std::uint64_t, Index>& segments() const { return segments_; }
  static std::uint64_t key(Index a, Index b);  // of an edge, whatever its direction
  static Segment segment_of_key(std::uint64_t key) {
    return {static_cast<Index>(key >> 32), static_cast<Index>(key & 0xffffffff)};
  }

  // Dihedral angle of the input below which a segment's own angle is not held against a tetrahedron.
  void set_acute(Index a, Index b);
  bool is_acute(Index a, Index b) const;
  bool has_acute() const { return !acute_.empty(); }
  const std::unordered_map<std::uint64_t, char>& acute_segments() const { return acute_; }

  Index add(Index a, Index b, Index c, Index face);
  void remove(Index t);
  // Replaces segment (a, b) by (a, v) and (v, b); v becomes a point of its CAD edge.
  void split_segment(Index a, Index b, Index v);
  // Forgets the segments that are an edge of no triangle any more.
  void drop_bare_segments();

 private:
  std::vector<LabelledTriangle> triangles_;
  std::vector<std::array<Index, 2>> face_solids_;
  std::vector<Entity> entities_;
  std::vector<std::vector<Index>> incident_;
  std::unordered_map<std::uint64_t, Index> segments_;
  std::unordered_map<std::uint64_t, char> acute_;
};

// Corner of triangle t that is neither a nor b.
Index opposite_corner(const BoundaryComplex& complex, Index t, Index a, Index b);

// Flip of the edge (a, b) between two triangles of one CAD face to (c, d): ask, then act.
struct EdgeFlip {
  Index a, b, c, d;     // triangles (a, b, c) and (b, a, d) become (c, a, d) and (d, b, c)
  Index first, second;  // the two triangles to be removed
};
// False when (a, b) is a segment, not between two triangles of one face, (c, d) exists, or a normal would
// turn.
bool can_flip(const BoundaryComplex& complex, const std::vector<Vec3>& points, Index a, Index b,
              EdgeFlip& flip);
// Are the angles after the flip acceptable: smallest above min(25 degrees, 0.8 of before)?
bool flip_keeps_angles(const std::vector<Vec3>& points, const EdgeFlip& flip);
// Returns the two new triangles.
std::array<Index, 2> do_flip(BoundaryComplex& complex, const EdgeFlip& flip);
// Is (a, b) locally Delaunay on the surface (sum of opposite angles at most 180 degrees)?
bool flip_improves(const std::vector<Vec3>& points, const EdgeFlip& flip);

// Circumcentre and circumradius of a triangle in space.
Sphere circumcircle(const Vec3& a, const Vec3& b, const Vec3& c);

// Sum over all invariants of the complex; throws Failure("boundary", ...).
void check_complex(const BoundaryComplex& complex);

}  // namespace dm
