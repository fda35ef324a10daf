// Trials (edit_mesh.h): each change is noted as it was, and taking back goes through the notes from the last
// one.
#include "optimisation/edit_mesh.h"

namespace dm {

void EditMesh::begin_trial() {
  in_trial_ = true;
  changes_.clear();
  touched_.clear();
  trial_before_ = {};
  trial_shortfall_ = 0;
  ++trial_;
}

void EditMesh::note(int kind, Index index, Index value) {
  Change change{};
  change.kind = kind;
  change.index = index;
  change.value = value;
  changes_.push_back(change);
}

void EditMesh::note_tet(Index t) {
  changes_.push_back(
      {kTet, t, mesh_.tet_solid[t], mesh_.tets[t], mesh_.neighbours[t], {}, bad_[t], marks_[t]});
  noted_.resize(mesh_.tets.size(), 0);
  if (noted_[t] == trial_) return;
  noted_[t] = trial_;
  touched_.push_back(t);
  if (removed(t)) return;
  trial_before_.include(cosines(mesh_.tets[t]));
  trial_shortfall_ += shortfall(bad_[t]);
}

void EditMesh::move_point(Index v, const Vec3& p, std::span<const Index> tets, std::span<const float> bad) {
  if (in_trial_) {
    for (const Index t : tets) note_tet(t);
    note(kPoint, v);
    changes_.back().point = mesh_.points[v];
  }
  mesh_.points[v] = p;
  for (std::size_t k = 0; k < tets.size(); ++k) bad_[tets[k]] = bad[k];
  note_change(tets);
}

void EditMesh::note_change(std::span<const Index> tets) {
  if (clock_ == 0 || in_trial_) return;
  ++clock_;
  for (const Index t : tets)
    if (t < slot_count() && !removed(t))
      for (const Index v : mesh_.tets[t]) changed_[v] = clock_;
}

AngleCosines EditMesh::trial_now() const {
  AngleCosines all;
  for (const Index t : touched_)
    if (t < slot_count() && !removed(t)) all.include(cosines(mesh_.tets[t]));
  return all;
}

double EditMesh::trial_shortfall() const {
  double sum = 0;
  for (const Index t : touched_)
    if (t < slot_count() && !removed(t)) sum += shortfall(bad_[t]);
  return sum;
}

Index EditMesh::trial_worst() const {
  Index worst = -1;
  for (const Index t : touched_)
    if (t < slot_count() && !removed(t) && (worst < 0 || bad_[t] > bad_[worst])) worst = t;
  return worst;
}

void EditMesh::end_trial(bool keep) {
  in_trial_ = false;
  keep ? note_change(touched_) : take_back();
}

void EditMesh::take_back() {
  stars_listed_ = false;
  for (auto change = changes_.rbegin(); change != changes_.rend(); ++change) {
    const auto& [kind, k, value, tet, neighbours, point, bad, marks] = *change;
    switch (kind) {
      case kTet:
        mesh_.tets[k] = tet;
        mesh_.neighbours[k] = neighbours;
        mesh_.tet_solid[k] = value;
        bad_[k] = bad;
        marks_[k] = marks;
        break;
      case kLink:
        mesh_.neighbours[k / 4][k % 4] = value;
        break;
      case kPoint:
        mesh_.points[k] = point;
        break;
      case kVertexTet:
        vertex_tet_[k] = value;
        break;
      case kFreed:
        free_.pop_back();
        break;
      case kTaken:
        free_.push_back(k);
        break;
      case kGrown:
        mesh_.tets.pop_back();
        mesh_.neighbours.pop_back();
        mesh_.tet_solid.pop_back();
        bad_.pop_back();
        marks_.pop_back();
        stamp_.pop_back();
        break;
      case kNewPoint:
        mesh_.points.pop_back();
        mesh_.point_entity.pop_back();
        vertex_tet_.pop_back();
        pinched_.pop_back();
        if (clock_ > 0) changed_.pop_back();
        face_start_.pop_back();
        point_faces_.resize(value);
        break;
      case kTriangle:
        set_triangle(k, {tet[0], tet[1], tet[2]}, value);
        break;
      case kNewTriangle:
        triangle_of_.erase(sorted(mesh_.triangles.back()));
        mesh_.triangles.pop_back();
        mesh_.triangle_face.pop_back();
        break;
      case kSegment:
        set_segment(k, {tet[0], tet[1]});
        break;
      case kNewSegment:
        segment_of_.erase(sorted(mesh_.segments.back()));
        mesh_.segments.pop_back();
        mesh_.segment_edge.pop_back();
        break;
    }
  }
}

}  // namespace dm
