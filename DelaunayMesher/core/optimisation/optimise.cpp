#include "optimisation/optimise.h"

#include "optimisation/collapse.h"
#include "optimisation/flips.h"
#include "optimisation/rescue.h"
#include "optimisation/smoothing.h"
#include "optimisation/spatial_order.h"

namespace dm {
namespace {

constexpr int kSweeps = 3;         // over all points
constexpr int kMostSweeps = 5;     // while the mean is below
constexpr double kMeanAngle = 51;  // degrees
constexpr double kSharpFlip = 35;  // degrees: elements below it are tried in the first round of cheap flips
constexpr double kMeanFlip = 43;   // in the others
constexpr int kWorstRounds = 12;   // over the elements below the target
constexpr int kPollEvery = 128;

class Optimiser {
 public:
  Optimiser(VolumeMesh& mesh, const Geometry& geometry, const OptimiseOptions& options, Context& context)
      : mesh_(mesh),
        geometry_(geometry),
        smoother_(mesh_, geometry),
        flipper_(mesh_),
        contractor_(mesh_, geometry),
        rescuer_(mesh_, smoother_, flipper_, contractor_, geometry),
        context_(context) {
    target_ = badness_at(options.target_angle);
  }

  OptimiseReport run() {
    for (int i = 0; i < kSweeps || (i < kMostSweeps && mean_angle() < kMeanAngle); ++i) {
      i == 0 ? flip(kSharpFlip, FlipGoal::worst) : flip(kMeanFlip, FlipGoal::mean);
      sweep();
    }
    for (int round = 0; round < kWorstRounds; ++round)
      if (!cure_worst(round)) break;
    set_range(mesh_.first_extremes(), report_.min_before, report_.max_before);
    set_range(extremes(), report_.min_after, report_.max_after);
    mesh_.finish();
    return report_;
  }

 private:
  AngleCosines extremes() const {
    AngleCosines all;
    for (Index t = 0; t < mesh_.slot_count(); ++t)
      if (!mesh_.removed(t)) all.include(mesh_.cosines(mesh_.tet(t)));
    return all;
  }
  // Of the smallest angles of the elements, degrees.
  double mean_angle() const {
    double sum = 0;
    Index count = 0;
    for (Index t = 0; t < mesh_.slot_count(); ++t)
      if (!mesh_.removed(t)) sum += std::acos(mesh_.cosines(mesh_.tet(t)).sharp), ++count;
    return sum / count * 180 / std::numbers::pi;
  }
  static void set_range(const AngleCosines& cosines, double& min, double& max) {
    min = std::acos(cosines.sharp) * 180 / std::numbers::pi;
    max = std::acos(cosines.blunt) * 180 / std::numbers::pi;
  }
  // Sweeps and flips make up nine tenths of the work.
  void poll(int part, double fraction) {
    if (++polls_ % kPollEvery == 0) context_.poll(std::min(0.9, (part + fraction) * 0.9 / (2 * kSweeps)));
  }

  void flip(double below, FlipGoal goal) {
    const double bound = badness_at(below);
    const int part = part_++;
    for (Index t = 0; t < mesh_.slot_count(); ++t) {
      if (mesh_.removed(t) || mesh_.bad(t) <= bound) continue;
      report_.flipped += flipper_.improve_blunt(t, goal);
      poll(part, static_cast<double>(t) / mesh_.slot_count());
    }
  }
  void sweep() {
    mesh_.list_stars();
    const int part = part_++;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      report_.smoothed += smoother_.smooth_soft(v, 1);
      poll(part, static_cast<double>(v) / mesh_.vertex_count());
    }
  }

  // Elements below the target: every kind of flip, then their points, then contraction.  Returns whether
  // another round may help.
  bool cure_worst(int round) {
    std::vector<Index> worst;
    for (Index t = 0; t < mesh_.slot_count(); ++t)
      if (!mesh_.removed(t) && mesh_.bad(t) > target_) worst.push_back(t);
    std::sort(worst.begin(), worst.end(), [&](Index a, Index b) {
      return mesh_.bad(a) != mesh_.bad(b) ? mesh_.bad(a) > mesh_.bad(b) : a < b;
    });
    std::int64_t changes = 0;
    for (std::size_t i = 0; i < worst.size(); ++i) {
      context_.poll(0.9 + 0.1 * (round + static_cast<double>(i) / static_cast<double>(worst.size())) /
                              kWorstRounds);
      changes += cure(worst[i], round);
    }
    return changes > 0;
  }
  bool cure(Index t, int round) {
    const auto pending = [&] { return !mesh_.removed(t) && mesh_.bad(t) > target_; };
    if (!pending()) return false;
    if (flipper_.improve(t)) return ++report_.flipped, true;
    if (round > 0 && flipper_.improve_boundary(t, geometry_)) return ++report_.flipped, true;
    bool changed = false;
    const Tet corners = mesh_.tet(t);
    for (Index v : corners) {
      if (!pending()) return changed;
      if (smoother_.smooth_worst(v, 3)) ++report_.smoothed, changed = true;
    }
    if (round > 0 && pending() && contractor_.collapse_best(t)) ++report_.collapsed, changed = true;
    if (round > 0 && pending() && rescuer_.rescue(t)) ++report_.rescued, changed = true;
    return changed;
  }

  EditMesh mesh_;
  const Geometry& geometry_;
  Smoother smoother_;
  Flipper flipper_;
  Contractor contractor_;
  Rescuer rescuer_;
  Context& context_;
  double target_ = 0;
  int part_ = 0;
  std::int64_t polls_ = 0;
  OptimiseReport report_;
};

}  // namespace

OptimiseReport optimise(VolumeMesh& mesh, const Geometry& geometry, const SizeField&,
                        const OptimiseOptions& options, Context& context) {
  context.begin("optimisation");
  sort_in_space(mesh);
  return Optimiser(mesh, geometry, options, context).run();
}

}  // namespace dm
