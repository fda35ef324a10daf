#include "optimisation/optimise.h"

#include <numeric>

#include "base/parallel.h"
#include "optimisation/collapse.h"
#include "optimisation/flips.h"
#include "optimisation/rescue.h"
#include "optimisation/smoothing.h"
#include "optimisation/spatial_order.h"
#include "optimisation/sweep.h"

namespace dm {
namespace {

constexpr int kSweeps = 3;           // over all points
constexpr int kMostSweeps = 5;       // while the mean is below
constexpr double kMeanAngle = 51;    // degrees
constexpr double kSharpFlip = 35;    // degrees: elements below it are tried in the first round of cheap flips
constexpr double kMeanFlip = 43;     // in the others
constexpr int kWorstRounds = 8;      // over the elements below the target
constexpr double kSingle = 1e-3;     // rounding of a badness in single precision
constexpr std::size_t kPiece = 256;  // elements that one thread takes at a time

class Optimiser {
 public:
  Optimiser(VolumeMesh& mesh, const Geometry& geometry, const OptimiseOptions& options, Context& context)
      : mesh_(mesh),
        geometry_(geometry),
        smoothers_(std::max(1, context.threads), Smoother(mesh_, geometry)),
        flippers_(std::max(1, context.threads), Flipper(mesh_)),
        contractor_(mesh_, geometry),
        rescuer_(mesh_, smoothers_[0], flippers_[0], contractor_, geometry),
        context_(context) {
    target_ = badness_at(options.target_angle);
  }

  OptimiseReport run() {
    for (int i = 0; i < kSweeps || (i < kMostSweeps && mean_angle() < kMeanAngle); ++i) {
      i == 0 ? flip(kSharpFlip, FlipGoal::worst) : flip(kMeanFlip, FlipGoal::mean);
      sweep();
    }
    mesh_.start_clock();
    for (int round = 0; round < kWorstRounds; ++round)
      if (!cure_worst(round)) break;
    set_range(mesh_.first_extremes(), report_.min_before, report_.max_before);
    set_range(extremes(), report_.min_after, report_.max_after);
    mesh_.finish();
    return report_;
  }

 private:
  // An element whose badness is below both of what is there already cannot make them worse.
  AngleCosines extremes() const {
    AngleCosines all;
    for (Index t = 0; t < mesh_.slot_count(); ++t) {
      if (mesh_.removed(t)) continue;
      const double reach = mesh_.bad(t) + kSingle;
      if (reach > all.sharp - 1.0 / 3 || reach > kBluntWeight * (1.0 / 3 - all.blunt))
        all.include(mesh_.cosines(mesh_.tet(t)));
    }
    return all;
  }
  // Of the smallest angles of every eighth element, degrees.
  double mean_angle() const {
    double sum = 0;
    Index count = 0;
    for (Index t = 0; t < mesh_.slot_count(); t += 8)
      if (!mesh_.removed(t)) sum += std::acos(mesh_.cosines(mesh_.tet(t)).sharp), ++count;
    return sum / std::max(count, 1) * 180 / std::numbers::pi;
  }
  static void set_range(const AngleCosines& cosines, double& min, double& max) {
    min = std::acos(cosines.sharp) * 180 / std::numbers::pi;
    max = std::acos(cosines.blunt) * 180 / std::numbers::pi;
  }
  // Sweeps and flips make up nine tenths of the work.
  double next_fraction() { return std::min(0.9, part_++ * 0.9 / (2 * kSweeps)); }

  // Flips of the sharp elements are planned on all threads for the mesh as it is, then done one by one: as
  // planned if all their elements are still there, else planned anew, and then those of the new elements.
  void flip(double below, FlipGoal goal) {
    const double bound = badness_at(below), fraction = next_fraction();
    std::vector<Index> sharp;
    for (Index t = 0; t < mesh_.slot_count(); ++t)
      if (!mesh_.removed(t) && mesh_.bad(t) > bound) sharp.push_back(t);
    const auto piece = [&](int k) {
      return std::span<const Index>(sharp).subspan(k * kPiece, std::min(kPiece, sharp.size() - k * kPiece));
    };
    std::vector<std::vector<Flipper::Plan>> plans((sharp.size() + kPiece - 1) / kPiece);
    for_all(static_cast<int>(plans.size()), context_, fraction, [&](int thread, int k) {
      for (const Index t : piece(k)) {
        Flipper::Plan plan = flippers_[thread].plan_blunt(t, goal);
        if (plan.before_count > 0) plans[k].push_back(plan);
      }
    });
    std::vector<Index> fresh;
    std::vector<char> gone(mesh_.slot_count(), 0);
    const auto apply = [&](const Flipper::Plan& plan) {
      for (int i = 0; i < plan.before_count; ++i)
        if (plan.before[i] < static_cast<Index>(gone.size())) gone[plan.before[i]] = 1;
      const auto made = flippers_[0].apply(plan);
      fresh.insert(fresh.end(), made.begin(), made.end());
      report_.flipped += plan.before_count > 0;
    };
    for (const auto& list : plans) {
      context_.poll(fraction);
      for (const Flipper::Plan& plan : list) {
        const auto tets = std::span<const Index>(plan.before).first(plan.before_count);
        const bool valid = std::none_of(tets.begin(), tets.end(), [&](Index t) { return gone[t]; });
        if (valid)
          apply(plan);
        else if (!gone[plan.tet])
          apply(flippers_[0].plan_blunt(plan.tet, goal));
      }
    }
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      context_.tick(fraction);
      const Index t = fresh[i];
      if (!mesh_.removed(t) && mesh_.bad(t) > bound) apply(flippers_[0].plan_blunt(t, goal));
    }
  }
  void sweep() {
    mesh_.list_stars();
    const SweepOrder order(mesh_);
    const double fraction = next_fraction();
    std::vector<std::int64_t> moved(smoothers_.size(), 0);
    for (const SweepOrder::Stage& stage : order.stages())
      for_all(static_cast<int>(stage.size()), context_, fraction, [&](int thread, int k) {
        std::int64_t count = 0;
        for (const Index v : stage[k]) count += smoothers_[thread].smooth_soft(v, 1);
        moved[thread] += count;
      });
    report_.smoothed += std::accumulate(moved.begin(), moved.end(), std::int64_t{0});
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
    return changes > 0 || round <= Rescuer::kMostEffort;
  }
  bool pending(Index t) const { return !mesh_.removed(t) && mesh_.bad(t) > target_; }
  bool cure(Index t, int round) {
    if (!pending(t)) return false;
    bool changed = false;
    tet_failed_.resize(mesh_.slot_count(), 0);
    if (tet_failed_[t] < mesh_.last_change(mesh_.tet(t))) {
      changed = cure_by_steps(t, round > 0);
      if (!changed && round > 0) tet_failed_[t] = mesh_.now();
    }
    if (round > 0 && pending(t) && rescuer_.rescue(t, round - 1)) ++report_.rescued, changed = true;
    return changed;
  }
  // By changes that are better at once.
  bool cure_by_steps(Index t, bool all) {
    if (flippers_[0].improve(t)) return ++report_.flipped, true;
    if (all && flippers_[0].improve_boundary(t, geometry_)) return ++report_.flipped, true;
    bool changed = false;
    const Tet corners = mesh_.tet(t);
    for (Index v : corners) {
      if (!pending(t)) return changed;
      changed |= smooth_worst(v);
    }
    if (all && pending(t) && contractor_.collapse_best(t)) ++report_.collapsed, changed = true;
    return changed;
  }
  bool smooth_worst(Index v) {
    point_failed_.resize(mesh_.vertex_count(), 0);
    if (point_failed_[v] >= mesh_.last_change(v)) return false;
    if (smoothers_[0].smooth_worst(v, 3)) return ++report_.smoothed, true;
    point_failed_[v] = mesh_.now();
    return false;
  }

  EditMesh mesh_;
  const Geometry& geometry_;
  std::vector<Smoother> smoothers_;  // one for each thread
  std::vector<Flipper> flippers_;
  Contractor contractor_;
  Rescuer rescuer_;
  Context& context_;
  std::vector<Index> tet_failed_, point_failed_;  // when nothing helped, by the clock of the mesh
  double target_ = 0;
  int part_ = 0;
  OptimiseReport report_;
};

}  // namespace

OptimiseReport optimise(VolumeMesh& mesh, const Geometry& geometry, const OptimiseOptions& options,
                        Context& context) {
  context.begin("optimisation");
  sort_in_space(mesh);
  return Optimiser(mesh, geometry, options, context).run();
}

}  // namespace dm
