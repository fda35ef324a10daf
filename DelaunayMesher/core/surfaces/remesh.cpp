#include "surfaces/remesh.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <tuple>

#include "curves/sample_curves.h"
#include "surfaces/extract_patch.h"
#include "surfaces/remesh_patch.h"

namespace dm {
namespace {

constexpr int kLastAttempt = 4;  // to sample the curves anew before all their old points are kept

class SurfaceMesher {
 public:
  SurfaceMesher(const Plc& plc, const Geometry& geometry, const SizeField& size,
                const SurfaceOptions& options, Context& context)
      : plc_(plc), geometry_(geometry), size_(size), options_(options), context_(context) {}

  SurfaceMesh run() {
    CurveOptions curve_options{options_.edge_ratio, options_.jitter, {}};
    context_.begin("curves");
    for (int attempt = 1;; ++attempt) {
      curves_ = sample_curves(plc_, geometry_, size_, curve_options, context_);
      if (attempt == 1) context_.begin("surfaces");
      const PatchSource source(plc_, curves_);
      const std::vector<Index> left = remesh_faces(source);
      if (left.empty()) break;
      curve_options.keep.resize(plc_.points.size(), 0);
      keep_points(left, attempt, curve_options.keep);
    }
    separate_faces();
    return assemble();
  }

 private:
  // Marks old curve points as staying: the given ones, then all of their CAD edges, at last all there are,
  // with which no face can be in difficulty.
  void keep_points(const std::vector<Index>& left, int attempt, std::vector<char>& keep) const {
    for (Index p : left) keep[p] = 1;
    if (attempt == 1) return;
    std::vector<char> edges(plc_.edge_count, attempt >= kLastAttempt);
    for (std::size_t s = 0; s < plc_.segments.size(); ++s)
      if (keep[plc_.segments[s][0]] || keep[plc_.segments[s][1]]) edges[plc_.segment_edge[s]] = 1;
    for (std::size_t s = 0; s < plc_.segments.size(); ++s)
      if (edges[plc_.segment_edge[s]]) keep[plc_.segments[s][0]] = keep[plc_.segments[s][1]] = 1;
  }

  Index face_count() const { return static_cast<Index>(plc_.face_solids.size()); }

  // Returns the old curve points that some face could not do without.
  std::vector<Index> remesh_faces(const PatchSource& source) {
    const Index n = face_count();
    patches_.assign(n, {});
    std::vector<std::vector<Index>> left(n);
    std::vector<std::exception_ptr> errors(n);
    std::atomic<Index> next{0};
    std::atomic<bool> stop{false};
    std::atomic<double> done{0};
    auto work = [&](Context* context) {
      for (Index f = next++; f < n && !stop; f = next++) {
        try {
          patches_[f] = source.extract(f);
          const PatchPoll poll{context, &stop, &done};
          left[f] = PatchRemesher(patches_[f], f, geometry_, size_, options_, context_.seed, poll).run();
        } catch (...) {
          errors[f] = std::current_exception();
          stop = true;
        }
        done = static_cast<double>(std::min(next.load(), n)) / n;
      }
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < context_.threads; ++i) threads.emplace_back(work, nullptr);
    work(&context_);
    for (std::thread& t : threads) t.join();
    for (const std::exception_ptr& error : errors)
      if (error) std::rethrow_exception(error);
    std::vector<Index> all;
    for (const auto& points : left) all.insert(all.end(), points.begin(), points.end());
    return all;
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
      PatchRemesher(patch, face, geometry_, size_, options_, context_.seed, {}).split_at_middle(e);
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
  const SizeField& size_;
  const SurfaceOptions& options_;
  Context& context_;
  CurveSampling curves_;
  std::vector<FacePatch> patches_;
};

}  // namespace

SurfaceMesh mesh_surfaces(const Plc& plc, const Geometry& geometry, const SizeField& size,
                          const SurfaceOptions& options, Context& context) {
  return SurfaceMesher(plc, geometry, size, options, context).run();
}

}  // namespace dm
