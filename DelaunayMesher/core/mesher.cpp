#include "mesher.h"

#include <chrono>
#include <cstdio>

#include "base/memory.h"
#include "boundary/recovery.h"
#include "boundary/volumes.h"
#include "plc/entity_names.h"
#include "refinement/carve.h"
#include "refinement/extract.h"
#include "refinement/refine.h"
#include "surfaces/absorb.h"
#include "surfaces/remesh.h"

namespace dm {

namespace {

class StageClock {
 public:
  explicit StageClock(MeshResult& result) : result_(result) {}
  void stop(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    result_.seconds.emplace_back(stage, std::chrono::duration<double>(now - start_).count());
    start_ = now;
  }

 private:
  MeshResult& result_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void record(MeshResult& result, const RecoveryReport& recovery, const RefineReport& refinement) {
  auto& s = result.statistics;
  const auto add = [&](const char* name, double value) { s.emplace_back(name, value); };
  add("boundary_missing_at_start", recovery.missing_at_start);
  add("boundary_layer_points", recovery.layer_points);
  add("boundary_flips", recovery.flips);
  add("boundary_replaced", recovery.replaced);
  add("boundary_splits", recovery.segment_splits + recovery.triangle_splits);
  add("refinement_sites", static_cast<double>(refinement.sites));
  add("refinement_tries", static_cast<double>(refinement.tries));
  add("refinement_relaxed", static_cast<double>(refinement.relaxed));
  add("refinement_constrained", static_cast<double>(refinement.constrained));
  add("refinement_encroached", static_cast<double>(refinement.encroached));
  add("refinement_boundary_splits",
      static_cast<double>(refinement.triangle_splits + refinement.segment_splits));
  add("refinement_boundary_flips", static_cast<double>(refinement.flips));
  add("refinement_slivers", static_cast<double>(refinement.slivers));
}

void record(MeshResult& result, const OptimiseReport& optimisation) {
  const auto add = [&](const char* name, std::int64_t count) {
    result.statistics.emplace_back(name, static_cast<double>(count));
  };
  add("optimisation_smoothed", optimisation.smoothed);
  add("optimisation_flipped", optimisation.flipped);
  add("optimisation_collapsed", optimisation.collapsed);
  add("optimisation_rescued", optimisation.rescued);
}

std::string absorbed_warning(const Absorbed& absorbed) {
  return "far smaller than the elements, and taken together with what lies beside them: " +
         entity_names(absorbed.faces, absorbed.edges, absorbed.vertices) +
         "; a size given to them, or a minimum size, keeps them";
}

// Counts are written "1 place(s)": Python adds up those of several PLCs before it chooses singular or plural
// (errors.in_number).
std::string left_out_warning(const std::vector<Vec3>& places, Index solids) {
  const Vec3& p = places[0];
  char place[100];
  std::snprintf(place, sizeof place, "near (%.6g, %.6g, %.6g)", p.x, p.y, p.z);
  std::string text = std::to_string(places.size()) +
                     " element(s) without volume had to be left out where faces touch, " + place;
  if (solids > 1) text += "; if solids are to be joined there, cut the part with Boolean Fragments";
  return text;
}

void warn(MeshResult& result, const RecoveryReport& recovery, const RefineReport& refinement) {
  if (recovery.replaced)
    result.warnings.push_back(
        std::to_string(recovery.replaced) +
        " boundary triangle(s) could not be recovered and had to be replaced by others between the "
        "same nodes: faces touch, cross or meet at narrow angles there (" +
        entity_names(recovery.unrecovered_faces) + ")");
  if (refinement.constrained)
    result.warnings.push_back("in " + std::to_string(refinement.constrained) +
                              " place(s) the mesh is constrained by the boundary instead of Delaunay");
}

}  // namespace

MeshResult make_mesh(const Plc& given, GeometryRecords records, const MesherOptions& options,
                     Context& context) {
  MeshResult result;
  StageClock clock(result);
  context.begin("plc");
  check_plc(given, context);
  const Geometry geometry(given, std::move(records));
  context.poll(0);
  Absorbed absorbed;
  const Plc plc = absorb_small_features(given, geometry, options.size, context, absorbed);
  if (absorbed.any()) result.warnings.push_back(absorbed_warning(absorbed));
  clock.stop("plc");

  context.begin("sizing");
  const SizeField size(plc, geometry, options.size, context);
  result.warnings.insert(result.warnings.end(), size.warnings().begin(), size.warnings().end());
  refuse_sizes(options.limit, size);
  result.statistics.emplace_back("predicted_tetrahedra", size.predicted_tetrahedra());
  clock.stop("sizing");

  SurfaceMesh surface = mesh_surfaces(plc, geometry, size, {}, context);
  refuse_boundary(options.limit, surface, plc);
  result.surface_volumes = surface_volumes(surface, plc);
  clock.stop("surfaces");

  RecoveryReport recovery;
  LabelledTriangulation labelled =
      recover_boundary(std::move(surface), plc, geometry, size, context, recovery);
  clock.stop("boundary");

  RefineReport refinement;
  mark_acute_segments(labelled, kAcuteAngle);
  refine(labelled, geometry, size, {.target_angle = options.target_angle, .limit = options.limit}, context,
         refinement);
  const Index carved = carve_flat_tets(labelled);
  return_freed_memory();
  result.mesh = extract_volume_mesh(std::move(labelled), options.optimise);
  return_freed_memory();
  record(result, recovery, refinement);
  warn(result, recovery, refinement);
  clock.stop("refinement");

  if (options.optimise) {
    record(result, optimise(result.mesh, geometry, {}, context));
    clock.stop("optimisation");
  }
  const std::vector<Vec3> left_out = leave_out_flat_tets(result.mesh);
  result.tet_volumes = tet_volumes(result.mesh, plc.solid_count);
  result.statistics.emplace_back("flat_tetrahedra_left_out", carved + left_out.size());
  if (!left_out.empty()) result.warnings.push_back(left_out_warning(left_out, plc.solid_count));
  if (options.order == 2) {
    result.second_order = make_second_order(result.mesh, geometry, context);
    clock.stop("order");
  }
  result.below_target = certify(result.mesh, plc.face_solids, size, options.target_angle, context);
  clock.stop("certificate");
  return result;
}

}  // namespace dm
