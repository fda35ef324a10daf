// Changes to the triangles of a PLC, face by face: segments divided, sides flipped, points inside a face left
// out.
//
// Precondition: check_plc; collect() before anything is changed, load() before a face is.  Postcondition: the
// triangles cover the same faces; after finish() those left out are gone.  Cost: of a division
// or flip about the triangles at its ends, of a point left out those of the face.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "plc/plc.h"
#include "plc/segment_table.h"

namespace dm {

class PlcEditor {
 public:
  explicit PlcEditor(Plc& plc);

  const Vec3& at(Index p) const { return plc_.points[p]; }
  const std::vector<Index>& edges_of(Index p) const { return edges_of_[p]; }  // CAD edges of a point
  bool on_curve(Index p) const { return !edges_of_[p].empty(); }
  bool is_on(Index p, Index edge) const;
  bool share_edge(Index p, Index q) const;
  Index segment(Index a, Index b) const;  // -1 = none

  // The faces that will be edited.
  void collect(const std::vector<Index>& faces);
  // Makes one of them the face at hand; false if it is folded onto itself.
  bool load(Index face);

  const std::vector<Index>& triangles_of(Index face) const { return by_face_[face]; }
  const std::vector<Index>& triangles_round(Index p) const { return round_[p]; }  // of curves, of these faces
  const std::map<Segment, Index>& sides() const { return half_; }  // of the face at hand: -> triangle
  Segment side(Index t, int i) const { return {plc_.triangles[t][i], plc_.triangles[t][(i + 1) % 3]}; }
  bool has_side(Index a, Index b) const { return half_.contains({a, b}) || half_.contains({b, a}); }
  Index left_of(const Segment& side) const;  // triangle, -1 = none
  Index apex(Index t, const Segment& ends) const;

  // Divides a segment and all its triangles at a place, for the sake of the face at hand; the new point.
  Index divide(Index segment, const Vec3& place, Index face);
  // The triangles s and t on the two sides of a side become those of the other diagonal.
  void flip(const Segment& ends, Index s, Index t);
  // Moves p, inside the face at hand, to its neighbour q; false, and nothing done, if a triangle would turn
  // over.
  bool collapse(Index p, Index q);

  // Faces whose segments were divided for the sake of others since they were loaded.
  const std::set<Index>& divided_by_others() const { return divided_by_others_; }

  void finish();

 private:
  Vec3 area(const Triangle& v) const { return area_vector(at(v[0]), at(v[1]), at(v[2])); }
  bool has(Index t, Index p) const;
  bool is_tracked(Index p, Index t) const { return on_curve(p) || edited_[plc_.triangle_face[t]]; }
  void replace(Index t, const Triangle& v);
  void add_sides(Index t);
  void erase_sides(Index t);

  Plc& plc_;
  const SegmentTable table_;
  std::map<std::pair<Index, Index>, Index> divided_;  // what table_ does not know; -1 = no segment any more
  std::vector<std::vector<Index>> edges_of_, round_;  // by point
  std::vector<std::vector<Index>> by_face_;
  std::vector<char> edited_;  // by face
  std::map<Segment, Index> half_;
  std::set<Index> divided_by_others_;
};

}  // namespace dm
