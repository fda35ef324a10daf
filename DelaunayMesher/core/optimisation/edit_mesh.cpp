#include "optimisation/edit_mesh.h"

#include <algorithm>
#include <optional>

#include "base/keep_rows.h"

namespace dm {
namespace {

Triangle face_corners(const Tet& tet, int face) {
  const auto& f = kFaceCorners[face];
  return {tet[f[0]], tet[f[1]], tet[f[2]]};
}

}  // namespace

EditMesh::EditMesh(VolumeMesh& mesh) : mesh_(mesh) {
  const std::size_t room = mesh.tets.capacity();
  bad_.reserve(room);
  marks_.reserve(room);
  stamp_.reserve(room);
  build_vertex_tets();
  build_point_faces();
  mark_boundary();
  bad_.resize(mesh.tets.size());
  for (std::size_t t = 0; t < bad_.size(); ++t) {
    const AngleCosines c = cosines(mesh.tets[t]);
    bad_[t] = badness(c);
    first_extremes_.include(c);
  }
  stamp_.assign(mesh.tets.size(), 0);
  find_pinched_points();
}

void EditMesh::build_vertex_tets() {
  vertex_tet_.assign(mesh_.points.size(), -1);
  for (Index t = 0; t < slot_count(); ++t)
    for (Index v : mesh_.tets[t]) vertex_tet_[v] = t;
}

void EditMesh::build_point_faces() {
  const std::size_t n = mesh_.points.size();
  face_start_.assign(n + 1, 0);
  for (const Triangle& t : mesh_.triangles)
    for (Index v : t) ++face_start_[v + 1];
  for (std::size_t v = 0; v < n; ++v) face_start_[v + 1] += face_start_[v];
  point_faces_.resize(face_start_[n]);
  std::vector<Index> end(face_start_.begin(), face_start_.end() - 1);
  for (std::size_t k = 0; k < mesh_.triangles.size(); ++k)
    for (Index v : mesh_.triangles[k]) point_faces_[end[v]++] = mesh_.triangle_face[k];
  Index out = 0;  // keep each face once per point
  for (std::size_t v = 0; v < n; ++v) {
    const auto first = point_faces_.begin() + face_start_[v], last = point_faces_.begin() + end[v];
    std::sort(first, last);
    const auto unique_last = std::unique(first, last);
    face_start_[v] = out;
    for (auto it = first; it != unique_last; ++it) point_faces_[out++] = *it;
  }
  face_start_[n] = out;
  point_faces_.resize(out);
}

// A face is marked where the neighbour is missing or of another solid; triangles embedded in one solid are
// rare, so they are looked for only when the count says that there are any.
void EditMesh::mark_boundary() {
  marks_.assign(mesh_.tets.size(), 0);
  std::size_t count = 0;
  for (Index t = 0; t < slot_count(); ++t)
    for (int i = 0; i < 4; ++i) {
      const Index n = mesh_.neighbours[t][i];
      if (n >= 0 && mesh_.tet_solid[n / 4] == mesh_.tet_solid[t]) continue;
      marks_[t] |= static_cast<std::uint8_t>(1 << i);
      if (n < t * 4) ++count;
    }
  if (count == mesh_.triangles.size()) return;
  std::unordered_set<Triangle, IndexHash> boundary;
  for (const Triangle& t : mesh_.triangles) boundary.insert(sorted(t));
  for (Index t = 0; t < slot_count(); ++t)
    for (int i = 0; i < 4; ++i)
      if (boundary.count(sorted(face_corners(mesh_.tets[t], i))))
        marks_[t] |= static_cast<std::uint8_t>(1 << i);
}

void EditMesh::list_stars() {
  star_start_.assign(mesh_.points.size() + 1, 0);
  for (const Tet& t : mesh_.tets)
    if (t[0] != kRemoved)
      for (Index v : t) ++star_start_[v + 1];
  for (std::size_t v = 0; v < mesh_.points.size(); ++v) star_start_[v + 1] += star_start_[v];
  star_tets_.resize(star_start_.back());
  std::vector<Index> end(star_start_.begin(), star_start_.end() - 1);
  for (Index t = 0; t < slot_count(); ++t)
    if (!removed(t))
      for (Index v : mesh_.tets[t]) star_tets_[end[v]++] = t;
  stars_listed_ = true;
}

void EditMesh::find_pinched_points() {
  std::vector<Index> count(mesh_.points.size(), 0);
  for (const Tet& t : mesh_.tets)
    for (Index v : t) ++count[v];
  pinched_.assign(mesh_.points.size(), 0);
  for (Index v = 0; v < vertex_count(); ++v)
    if (!interior(v)) pinched_[v] = static_cast<Index>(star(v).size()) != count[v];
}

std::span<const Index> EditMesh::star(Index v) {
  if (stars_listed_)
    return {star_tets_.data() + star_start_[v],
            static_cast<std::size_t>(star_start_[v + 1] - star_start_[v])};
  star_.clear();
  if (vertex_tet_[v] < 0) return {};
  ++stamp_value_;
  star_.push_back(vertex_tet_[v]);
  stamp_[vertex_tet_[v]] = stamp_value_;
  for (std::size_t k = 0; k < star_.size(); ++k) {
    const Index t = star_[k];
    const int own = corner_index(t, v);
    for (int i = 0; i < 4; ++i) {
      if (i == own) continue;
      const Index n = mesh_.neighbours[t][i];
      if (n < 0 || stamp_[n / 4] == stamp_value_) continue;
      stamp_[n / 4] = stamp_value_;
      star_.push_back(n / 4);
    }
  }
  return star_;
}

bool EditMesh::on_one_face(Index a, Index b, Index c) const {
  if (interior(a) || interior(b) || interior(c)) return false;
  for (Index f : faces_of(a)) {
    const auto fb = faces_of(b), fc = faces_of(c);
    if (std::find(fb.begin(), fb.end(), f) != fb.end() && std::find(fc.begin(), fc.end(), f) != fc.end())
      return true;
  }
  return false;
}

void EditMesh::list_boundary() {
  if (boundary_listed_) return;
  boundary_listed_ = true;
  for (std::size_t k = 0; k < mesh_.triangles.size(); ++k) {
    const auto [it, is_new] = triangle_of_.try_emplace(sorted(mesh_.triangles[k]), static_cast<Index>(k));
    if (!is_new) it->second = kTwice;
  }
  for (std::size_t k = 0; k < mesh_.segments.size(); ++k) {
    const auto [it, is_new] = segment_of_.try_emplace(sorted(mesh_.segments[k]), static_cast<Index>(k));
    if (!is_new) it->second = kTwice;
  }
}

Index EditMesh::find_triangle(Index a, Index b, Index c) {
  list_boundary();
  const auto it = triangle_of_.find(sorted({a, b, c}));
  return it == triangle_of_.end() ? -1 : it->second;
}

Index EditMesh::find_segment(Index a, Index b) {
  list_boundary();
  const auto it = segment_of_.find(sorted(Segment{a, b}));
  return it == segment_of_.end() ? -1 : it->second;
}

Index EditMesh::add_point(const Vec3& p, Entity entity, std::span<const Index> faces) {
  if (in_trial_) note(kNewPoint, vertex_count(), static_cast<Index>(point_faces_.size()));
  mesh_.points.push_back(p);
  mesh_.point_entity.push_back(entity);
  vertex_tet_.push_back(-1);
  pinched_.push_back(0);
  if (clock_ > 0) changed_.push_back(clock_);
  point_faces_.insert(point_faces_.end(), faces.begin(), faces.end());
  face_start_.push_back(static_cast<Index>(point_faces_.size()));
  stars_listed_ = false;
  return vertex_count() - 1;
}

void EditMesh::set_triangle(Index k, const Triangle& corners, Index face) {
  list_boundary();
  const Triangle& old = mesh_.triangles[k];
  if (in_trial_) {
    note(kTriangle, k, mesh_.triangle_face[k]);
    changes_.back().tet = {old[0], old[1], old[2], -1};
  }
  const auto it = triangle_of_.find(sorted(old));
  if (it != triangle_of_.end() && it->second == k) triangle_of_.erase(it);
  mesh_.triangles[k] = corners;
  mesh_.triangle_face[k] = face;
  if (corners[0] >= 0) triangle_of_[sorted(corners)] = k;
}

void EditMesh::set_segment(Index k, const Segment& ends) {
  list_boundary();
  const Segment& old = mesh_.segments[k];
  if (in_trial_) {
    note(kSegment, k);
    changes_.back().tet = {old[0], old[1], -1, -1};
  }
  const auto it = segment_of_.find(sorted(old));
  if (it != segment_of_.end() && it->second == k) segment_of_.erase(it);
  mesh_.segments[k] = ends;
  if (ends[0] >= 0) segment_of_[sorted(ends)] = k;
}

void EditMesh::add_triangle(const Triangle& corners, Index face) {
  list_boundary();
  if (in_trial_) note(kNewTriangle, 0);
  triangle_of_[sorted(corners)] = static_cast<Index>(mesh_.triangles.size());
  mesh_.triangles.push_back(corners);
  mesh_.triangle_face.push_back(face);
}

void EditMesh::add_segment(const Segment& ends, Index edge) {
  list_boundary();
  if (in_trial_) note(kNewSegment, 0);
  segment_of_[sorted(ends)] = static_cast<Index>(mesh_.segments.size());
  mesh_.segments.push_back(ends);
  mesh_.segment_edge.push_back(edge);
}

Index EditMesh::take_slot() {
  if (!free_.empty()) {
    const Index t = free_.back();
    free_.pop_back();
    if (in_trial_) note(kTaken, t), note_tet(t);
    return t;
  }
  mesh_.tets.emplace_back();
  mesh_.neighbours.emplace_back();
  mesh_.tet_solid.emplace_back();
  bad_.emplace_back();
  marks_.emplace_back();
  stamp_.emplace_back(0);
  if (in_trial_) {
    note(kGrown, slot_count() - 1);
    mesh_.tets.back()[0] = kRemoved;
    note_tet(slot_count() - 1);
  }
  return slot_count() - 1;
}

void EditMesh::mark_face(Index link) {
  if (in_trial_) note_tet(link / 4);
  marks_[link / 4] |= static_cast<std::uint8_t>(1 << link % 4);
}

// A tetrahedron that stays takes care of points that those beside it have left.
void EditMesh::expose(Index tet) {
  for (const Index v : mesh_.tets[tet]) {
    if (vertex_tet_[v] >= 0) continue;
    if (in_trial_) note(kVertexTet, v, -1);
    vertex_tet_[v] = tet;
  }
  note_change({&tet, 1});
}

// Faces that wait for a tetrahedron on their other side while a set of tetrahedra is replaced.
class EditMesh::OpenFaces {
 public:
  struct Open {
    Triangle key;  // sorted corners
    Index link;    // 4 * tet + face: of the neighbour outside the set, or of a new tetrahedron
    bool marked, outside;
  };

  void add(const Open& face) { faces_[count_++] = face; }
  // The face with these corners, which no longer waits.
  std::optional<Open> take(const Triangle& key) {
    for (int k = 0; k < count_; ++k) {
      if (faces_[k].key != key) continue;
      const Open found = faces_[k];
      faces_[k] = faces_[--count_];
      return found;
    }
    return {};
  }
  const Open* begin() const { return faces_.data(); }
  const Open* end() const { return faces_.data() + count_; }

 private:
  std::array<Open, 4 * kMaxReplace> faces_;
  int count_ = 0;
};

void EditMesh::open_faces(std::span<const Index> tets, OpenFaces& open) {
  ++stamp_value_;
  for (const Index t : tets) stamp_[t] = stamp_value_;
  for (const Index t : tets)
    for (int i = 0; i < 4; ++i) {
      const Index n = mesh_.neighbours[t][i];
      if (n >= 0 && stamp_[n / 4] == stamp_value_) continue;
      open.add({sorted(face_corners(mesh_.tets[t], i)), n, marked(t, i), true});
    }
}

// A point that gets no new tetrahedron afterwards has left the mesh.
void EditMesh::remove_tets(std::span<const Index> tets) {
  if (in_trial_)
    for (const Index t : tets) note_tet(t);
  for (const Index t : tets) {
    for (const Index v : mesh_.tets[t])
      if (vertex_tet_[v] == t) {
        if (in_trial_) note(kVertexTet, v, t);
        vertex_tet_[v] = -1;
      }
    mesh_.tets[t][0] = kRemoved;
  }
  // Its own slots first: neighbours stay close in memory.
  for (auto it = tets.rbegin(); it != tets.rend(); ++it) {
    if (in_trial_) note(kFreed, *it);
    free_.push_back(*it);
  }
}

// Makes face i of the new tetrahedron t the neighbour of a face that waited for it.
void EditMesh::join(Index t, int i, Index link, bool marked, bool outside) {
  mesh_.neighbours[t][i] = link;
  if (link >= 0) {
    Index& back = mesh_.neighbours[link / 4][link % 4];
    if (in_trial_) note(kLink, link, back);
    back = 4 * t + i;
  }
  if (!marked) return;
  marks_[t] |= static_cast<std::uint8_t>(1 << i);
  if (!outside) mark_face(link);
}

std::span<const Index> EditMesh::replace(std::span<const Index> before, std::span<const Tet> after,
                                         std::span<const Index> solids, std::span<const Triangle> boundary) {
  const Index solid = mesh_.tet_solid[before[0]];
  const auto on_boundary = [&](const Triangle& key) {
    return std::any_of(boundary.begin(), boundary.end(), [&](const Triangle& t) { return sorted(t) == key; });
  };
  stars_listed_ = false;
  OpenFaces open;
  open_faces(before, open);
  remove_tets(before);
  created_.clear();
  for (std::size_t k = 0; k < after.size(); ++k) {
    const Index t = take_slot();
    created_.push_back(t);
    mesh_.tets[t] = after[k];
    mesh_.tet_solid[t] = solids.empty() ? solid : solids[k];
    bad_[t] = compute_bad(after[k]);
    marks_[t] = 0;
    for (int i = 0; i < 4; ++i) {
      const Triangle key = sorted(face_corners(after[k], i));
      if (const auto across = open.take(key))
        join(t, i, across->link, across->marked, across->outside);
      else
        open.add({key, 4 * t + i, on_boundary(key), false});
    }
    for (const Index v : after[k]) {
      if (in_trial_) note(kVertexTet, v, vertex_tet_[v]);
      vertex_tet_[v] = t;
    }
  }
  for (const auto& face : open) {  // new faces of the boundary
    if (face.link < 0) continue;
    if (face.outside) expose(face.link / 4);
    mark_face(face.link);
    mesh_.neighbours[face.link / 4][face.link % 4] = -1;
  }
  note_change(created_);
  return created_;
}

void EditMesh::close_boundary() {
  const auto is_there = [](const auto& corners) { return corners[0] >= 0; };
  keep_rows(mesh_.triangles, mesh_.triangle_face, is_there);
  keep_rows(mesh_.segments, mesh_.segment_edge, is_there);
}

void EditMesh::finish() {
  close_boundary();
  std::vector<Index> place(mesh_.tets.size(), -1);
  Index count = 0;
  for (Index t = 0; t < slot_count(); ++t)
    if (!removed(t)) place[t] = count++;
  for (Index t = 0; t < slot_count(); ++t) {
    if (place[t] < 0) continue;
    const Index to = place[t];
    mesh_.tets[to] = mesh_.tets[t];
    mesh_.tet_solid[to] = mesh_.tet_solid[t];
    for (int i = 0; i < 4; ++i) {
      const Index n = mesh_.neighbours[t][i];
      mesh_.neighbours[to][i] = n < 0 ? -1 : 4 * place[n / 4] + n % 4;
    }
  }
  mesh_.tets.resize(count);
  mesh_.neighbours.resize(count);
  mesh_.tet_solid.resize(count);
  std::vector<Index> point_place(mesh_.points.size(), -1);
  Index points = 0;
  for (Index v = 0; v < vertex_count(); ++v) {
    if (vertex_tet_[v] < 0) continue;
    mesh_.points[points] = mesh_.points[v];
    mesh_.point_entity[points] = mesh_.point_entity[v];
    point_place[v] = points++;
  }
  if (points == vertex_count()) return;
  mesh_.points.resize(points);
  mesh_.point_entity.resize(points);
  for (Tet& t : mesh_.tets)
    for (Index& v : t) v = point_place[v];
  for (Triangle& t : mesh_.triangles)
    for (Index& v : t) v = point_place[v];
  for (Segment& s : mesh_.segments)
    for (Index& v : s) v = point_place[v];
}

}  // namespace dm
