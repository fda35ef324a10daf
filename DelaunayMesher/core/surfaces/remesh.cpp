#include "surfaces/remesh.h"

#include <algorithm>
#include <tuple>

#include "base/parallel.h"
#include "curves/curve_changes.h"
#include "curves/sample_curves.h"
#include "surfaces/crossings.h"
#include "surfaces/defects.h"
#include "surfaces/extract_patch.h"
#include "surfaces/remesh_patch.h"
#include "surfaces/repeated_points.h"

namespace dm {
namespace {

constexpr int kLastAttempt = 4;  // to sample the curves anew before all their old points are kept
constexpr int kLastRound = 4;
constexpr int kRescueRounds = 2;  // more, where points coincide, which no later stage can do with
constexpr int kNarrowRounds = 2;  // that look for narrow strips
constexpr int kCapRounds = 2;  // of smaller lengths where two faces cross, before the tessellation is taken
constexpr double kKeepRadius = 3;     // round a crossing, over half the wanted length
constexpr double kSmallLength = 0.1;  // over the largest: where gaps between curves and faces may matter
constexpr double kGaps = 8;           // least length over such a gap
constexpr double kRefined = 0.82;     // circumradius over length in tessellations that are refined

// How a face is meshed; faces whose triangles cross go from one to the next.
enum class FaceMode : std::int8_t {
  remeshed,
  refined,  // the tessellation with its boundary, and points inserted where triangles are too large
  as_given  // the tessellation
};

class SurfaceMesher {
 public:
  SurfaceMesher(const Plc& plc, const Geometry& geometry, const SizeField& size,
                const SurfaceOptions& options, Context& context)
      : plc_(plc),
        geometry_(geometry),
        lengths_(size, options.edge_ratio),
        options_(options),
        context_(context),
        patches_(plc.face_solids.size()),
        left_(plc.face_solids.size()),
        redo_(plc.face_solids.size(), 1),
        mode_(plc.face_solids.size(), FaceMode::remeshed),
        crossed_(plc.face_solids.size(), 0) {
    keep_.assign(plc.points.size(), 0);
  }

  SurfaceMesh run() {
    context_.begin("curves");
    find_floors();
    for (int attempt = 1, round = 1, last = kLastRound;; ++round) {
      resample(round == 1);
      if (round == 1) context_.begin("surfaces");
      remesh_faces();
      if (keep_left_points(attempt)) {
        ++attempt;
        continue;
      }
      separate_faces();
      SurfaceMesh mesh = assemble();
      if (round >= kLastRound && last == kLastRound && has_repeated_points(mesh))
        last = round + kRescueRounds;
      if (round < last && demand_repairs(mesh)) continue;
      join_repeated_points(mesh);
      return mesh;
    }
  }

 private:
  // Triangles smaller than the gap between a curve and its face cannot be laid out along the curve.
  void find_floors() {
    const PatchSource source(plc_, curves_);
    const double small = kSmallLength * lengths_.largest();
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Index a = plc_.triangles[t][i], b = plc_.triangles[t][(i + 1) % 3], f = plc_.triangle_face[t];
        const Vec3 middle = 0.5 * (plc_.points[a] + plc_.points[b]);
        if (std::min(lengths_.at(plc_.points[a]), lengths_.at(middle)) > small) continue;
        const Index s = source.find_segment(a, b);
        if (s < 0) continue;
        for (const Vec3& p : {plc_.points[a], geometry_.project_to_edge(plc_.segment_edge[s], middle)}) {
          const double gap = distance(p, geometry_.project_to_face(f, p));
          if (kGaps * gap > lengths_.at(p)) lengths_.add_floor(p, kGaps * gap);
        }
      }
    lengths_.apply_caps();
  }

  // Samples the curves; faces with a curve that changed are to be done again, the others take over the new
  // numbers of its points.
  void resample(bool first) {
    CurveSampling before = std::move(curves_);
    const CurveOptions curve_options{options_.jitter, keep_};
    curves_ = sample_curves(plc_, geometry_, lengths_, curve_options, context_);
    if (first) return;
    const CurveChanges changes(before, curves_, plc_.edge_count);
    for (const auto& [face, edge] : face_edges())
      if (changes.edge_changed(edge)) redo_[face] = 1;
    for (Index f = 0; f < face_count(); ++f) {
      if (redo_[f]) continue;
      for (Index& p : patches_[f].global) p = changes.new_number(p);
    }
  }

  using FaceEdge = std::pair<Index, Index>;

  // Pairs of face and CAD edge, sorted; made when first needed, as are the points of edges.
  const std::vector<FaceEdge>& face_edges() {
    if (!face_edges_.empty() || plc_.segments.empty()) return face_edges_;
    const PatchSource source(plc_, curves_);
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Index s = source.find_segment(plc_.triangles[t][i], plc_.triangles[t][(i + 1) % 3]);
        if (s >= 0) face_edges_.emplace_back(plc_.triangle_face[t], plc_.segment_edge[s]);
      }
    std::sort(face_edges_.begin(), face_edges_.end());
    face_edges_.erase(std::unique(face_edges_.begin(), face_edges_.end()), face_edges_.end());
    return face_edges_;
  }

  std::pair<std::vector<FaceEdge>::const_iterator, std::vector<FaceEdge>::const_iterator> edges_of_face(
      Index face) {
    const std::vector<FaceEdge>& all = face_edges();
    return {std::lower_bound(all.begin(), all.end(), FaceEdge{face, -1}),
            std::lower_bound(all.begin(), all.end(), FaceEdge{face + 1, -1})};
  }

  const std::vector<Index>& points_of_edge(Index edge) {
    if (edge_points_.empty()) {
      edge_points_.resize(plc_.edge_count);
      for (std::size_t s = 0; s < plc_.segments.size(); ++s)
        for (const Index p : plc_.segments[s]) edge_points_[plc_.segment_edge[s]].push_back(p);
    }
    return edge_points_[edge];
  }

  // Where faces could not do without old curve points, marks these as staying: the points, then all of their
  // CAD edges, at last all there are, with which no face can be in difficulty.
  bool keep_left_points(int attempt) {
    std::vector<Index> left;
    for (const auto& points : left_) left.insert(left.end(), points.begin(), points.end());
    if (left.empty()) return false;
    const auto keep = [&](Index p) { keep_[p] = std::max<char>(keep_[p], 1); };
    for (Index p : left) keep(p);
    if (attempt == 1) return true;
    std::vector<char> edges(plc_.edge_count, attempt >= kLastAttempt);
    for (std::size_t s = 0; s < plc_.segments.size(); ++s)
      if (keep_[plc_.segments[s][0]] || keep_[plc_.segments[s][1]]) edges[plc_.segment_edge[s]] = 1;
    for (std::size_t s = 0; s < plc_.segments.size(); ++s)
      if (edges[plc_.segment_edge[s]])
        for (const Index p : plc_.segments[s]) keep(p);
    return true;
  }

  Index face_count() const { return static_cast<Index>(plc_.face_solids.size()); }

  void remesh_face(const PatchSource& source, Index f, const PatchPoll& poll) {
    patches_[f] = source.extract(f);
    left_[f].clear();
    if (patches_[f].triangle_slots() == 0) return;  // absorbed, or of a solid that is meshed apart
    PatchRemesher remesher(patches_[f], f, geometry_, lengths_, options_, context_.seed, poll);
    if (mode_[f] == FaceMode::refined) remesher.split_across_bends();
    if (mode_[f] != FaceMode::remeshed) remesher.insert_samples();
    if (mode_[f] == FaceMode::refined) remesher.refine(kRefined);
    if (mode_[f] == FaceMode::remeshed) left_[f] = remesher.run();
  }

  // Does the faces that are to be done.
  void remesh_faces() {
    const PatchSource source(plc_, curves_);
    const Index n = face_count();
    std::atomic<Index> finished{0};
    std::atomic<double> done{0};
    const auto remesh = [&](int thread, Index f, const std::atomic<bool>& stop) {
      if (redo_[f]) remesh_face(source, f, {thread == 0 ? &context_ : nullptr, &stop, &done});
      done = static_cast<double>(++finished) / n;
    };
    for_all(context_.threads, n, remesh, [&] { context_.poll(done); });
    redo_.assign(n, 0);
  }

  // Where the mesh has defects, asks for smaller lengths, for old curve points, at last for the tessellation.
  // True when some face is to be done again.
  bool demand_repairs(const SurfaceMesh& mesh) {
    if (++narrow_rounds_ <= kNarrowRounds)
      for (const Defect& d : find_narrow_places(mesh, plc_, lengths_))
        if (!crosses_in_tessellation(d.face)) lengths_.add_cap(d.place, d.length);
    std::vector<Box> changed = lengths_.apply_caps();
    if (changed.empty()) {  // crossings cost more to find: only when nothing else is to be done
      repair_crossings(find_crossing_defects(mesh, lengths_, context_));
      changed = lengths_.apply_caps();
    }
    redo_in(changed);
    return std::find(redo_.begin(), redo_.end(), 1) != redo_.end();
  }

  // Two faces that cross get smaller lengths there.  A face that crosses itself is blamed alone and gets the
  // old points of its curves back thereabouts: between curves that all but touch, the tessellation's points
  // face each other, and chords between others cross.  What does not help is followed by the tessellation.
  // Faces of solids that merely touch cannot be told apart by smaller triangles: they are left to recovery.
  void repair_crossings(std::vector<Defect> crossings) {
    std::erase_if(crossings, [&](const Defect& d) { return !share_solid(d.face, d.other); });
    if (!crossings.empty()) crosses_in_tessellation(crossings[0].face);  // refuses what is hopeless
    std::vector<char> crosses(face_count(), 0), crosses_itself(face_count(), 0);
    for (const Defect& d : crossings) crosses_itself[d.face] |= d.face == d.other;
    for (const Defect& d : crossings) crosses[d.face] |= crosses_itself[d.face] || !crosses_itself[d.other];
    for (Index f = 0; f < face_count(); ++f)
      if (crosses[f] && (crosses_itself[f] ? ++crossed_[f] > 1 : ++crossed_[f] > kCapRounds)) escalate(f);
    for (const Defect& d : crossings) {
      if (!crosses[d.face] || mode_[d.face] != FaceMode::remeshed) continue;
      if (crosses_itself[d.face])
        keep_near(d);
      else
        lengths_.add_cap(d.place, d.length);
    }
  }

  bool share_solid(Index f, Index g) const {
    const auto &a = plc_.face_solids[f], &b = plc_.face_solids[g];
    const auto in_b = [&](Index solid) { return solid != 0 && (solid == b[0] || solid == b[1]); };
    return in_b(a[0]) || in_b(a[1]);
  }

  void escalate(Index f) {
    if (mode_[f] == FaceMode::as_given || crosses_in_tessellation(f)) return;
    mode_[f] = mode_[f] == FaceMode::remeshed ? FaceMode::refined : FaceMode::as_given;
    redo_[f] = 1;
    const auto [first, last] = edges_of_face(f);
    for (auto e = first; e != last; ++e)
      for (const Index p : points_of_edge(e->second)) keep_[p] = 2;
  }

  // Keeps the old curve points of the defect's face near it.
  void keep_near(const Defect& d) {
    const double radius2 = kKeepRadius * kKeepRadius * d.length * d.length;
    const auto [first, last] = edges_of_face(d.face);
    for (auto e = first; e != last; ++e)
      for (const Index p : points_of_edge(e->second))
        if (keep_[p] != 2 && norm2(plc_.points[p] - d.place) < radius2) keep_[p] = 2, redo_[d.face] = 1;
  }

  // Smaller triangles are of no use to such a face.
  bool crosses_in_tessellation(Index face) {
    if (input_crosses_.empty()) check_input();
    return input_crosses_[face];
  }

  // Which faces cross in the tessellation.  Where there are many times more crossings than triangles,
  // a face lies over itself or another one, and no mesh can follow it.
  void check_input() {
    input_crosses_.assign(face_count(), 0);
    const std::size_t most = kMostCrossings * plc_.triangles.size();
    const auto pairs = find_crossings(plc_.points, plc_.triangles, context_, most);
    for (const auto& pair : pairs)
      for (const Index t : pair) input_crosses_[plc_.triangle_face[t]] = 1;
    if (pairs.size() < most) return;
    const auto& [s, t] = pairs[pairs.size() / 2];
    const Index f = plc_.triangle_face[s], g = plc_.triangle_face[t];
    throw Failure("surfaces", "self_intersection", "faces cross over and over and cannot be meshed",
                  plc_.points[plc_.triangles[s][0]], {2, f}, f == g ? Entity{} : Entity{2, g});
  }

  void redo_in(const std::vector<Box>& boxes) {
    if (boxes.empty()) return;
    std::vector<Box> face_boxes(face_count());
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t)
      for (const Index p : plc_.triangles[t]) face_boxes[plc_.triangle_face[t]].add(plc_.points[p]);
    for (Index f = 0; f < face_count(); ++f)
      for (const Box& box : boxes) redo_[f] |= box.overlaps(face_boxes[f]);
  }

  // An edge across one face must be no edge of another face nor of a curve, and no triangle may be in two
  // faces; where they are (both ends on curves), a point in the middle separates them.
  void separate_faces() {
    struct Chord {
      Index a, b, face, edge;
      bool operator<(const Chord& o) const {
        return std::tie(a, b, face, edge) < std::tie(o.a, o.b, o.face, o.edge);
      }
    };
    std::vector<Chord> chords;
    for (const Segment& s : curves_.segments)
      chords.push_back({std::min(s[0], s[1]), std::max(s[0], s[1]), -1, -1});
    for (Index f = 0; f < face_count(); ++f) {
      const FacePatch& patch = patches_[f];
      for (Index e = 0; e < static_cast<Index>(patch.vertex.size()); ++e) {
        if (!patch.alive(e / 3) || patch.twin[e] < e) continue;
        const Index a = patch.global[patch.origin(e)], b = patch.global[patch.target(e)];
        if (a >= 0 && b >= 0) chords.push_back({std::min(a, b), std::max(a, b), f, e});
      }
    }
    std::sort(chords.begin(), chords.end());
    std::vector<std::array<Index, 3>> split;  // face and the edge's ends in the patch
    for (std::size_t i = 0; i < chords.size();) {
      std::size_t j = i + 1;
      while (j < chords.size() && chords[j].a == chords[i].a && chords[j].b == chords[i].b) ++j;
      for (std::size_t k = i; j > i + 1 && k < j; ++k) {
        if (chords[k].face < 0) continue;
        const FacePatch& patch = patches_[chords[k].face];
        split.push_back({chords[k].face, patch.origin(chords[k].edge), patch.target(chords[k].edge)});
      }
      i = j;
    }
    for (const auto& [face, a, b] : split) {
      FacePatch& patch = patches_[face];
      const Index e = patch.find_edge(a, b);
      if (e < 0 || patch.twin[e] < 0) continue;
      PatchRemesher(patch, face, geometry_, lengths_, options_, context_.seed, {}).split_at_middle(e);
    }
  }

  SurfaceMesh assemble() const {
    SurfaceMesh mesh;
    std::vector<Index> number(curves_.points.size(), -1);
    for (std::size_t p = 0; p < curves_.points.size(); ++p) {
      if (curves_.role[p] != CurvePointRole::fixed) continue;
      number[p] = static_cast<Index>(mesh.points.size());
      mesh.points.push_back(curves_.points[p]);
      mesh.point_entity.push_back(curves_.entity[p]);
    }
    for (std::size_t s = 0; s < curves_.segments.size(); ++s)
      mesh.segments.push_back({number[curves_.segments[s][0]], number[curves_.segments[s][1]]});
    mesh.segment_edge = curves_.segment_edge;
    std::vector<Index> local;
    for (Index f = 0; f < face_count(); ++f) {
      const FacePatch& patch = patches_[f];
      local.assign(patch.points.size(), -1);
      for (Index t = 0; t < patch.triangle_slots(); ++t) {
        if (!patch.alive(t)) continue;
        Triangle triangle{};
        for (int i = 0; i < 3; ++i) {
          const Index v = patch.vertex[3 * t + i], g = patch.global[v];
          Index& id = g >= 0 ? number[g] : local[v];
          if (id < 0) {
            id = static_cast<Index>(mesh.points.size());
            mesh.points.push_back(patch.points[v]);
            mesh.point_entity.push_back({2, f});
          }
          triangle[i] = id;
        }
        mesh.triangles.push_back(triangle);
        mesh.triangle_face.push_back(f);
      }
    }
    return mesh;
  }

  const Plc& plc_;
  const Geometry& geometry_;
  LengthField lengths_;
  const SurfaceOptions& options_;
  Context& context_;
  CurveSampling curves_;
  std::vector<char> keep_;  // CurveOptions::keep
  // By face:
  std::vector<FacePatch> patches_;
  std::vector<std::vector<Index>> left_;  // old curve points that it could not do without
  std::vector<char> redo_;                // to be done
  std::vector<FaceMode> mode_;
  std::vector<Index> crossed_;  // rounds in which its triangles crossed
  std::vector<FaceEdge> face_edges_;
  std::vector<std::vector<Index>> edge_points_;
  int narrow_rounds_ = 0;
  std::vector<char> input_crosses_;  // in the tessellation; made when first needed
};

}  // namespace

SurfaceMesh mesh_surfaces(const Plc& plc, const Geometry& geometry, const SizeField& size,
                          const SurfaceOptions& options, Context& context) {
  return SurfaceMesher(plc, geometry, size, options, context).run();
}

}  // namespace dm
