#include "kernel/part_insertion.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"

namespace dm {
namespace {

constexpr int kParts = 8;
constexpr double kSlotsPerPoint = 7.2;  // of a part; uniform points need 6.8

}  // namespace

void PartInsertion::insert_round(Index begin, Index end) {
  std::vector<Index> vertices(end - begin);
  std::iota(vertices.begin(), vertices.end(), begin);
  if (end - begin >= parallel_from_)
    for (const bool shifted : {false, true})
      if (!vertices.empty()) vertices = insert_in_parts(std::move(vertices), end, shifted);
  insert_serially(vertices);
}

void PartInsertion::insert_serially(const std::vector<Index>& vertices) {
  for (const Index v : vertices) {
    context_.tick(0);
    if (t_.vertex_tet_[v] >= 0) continue;  // one of the first four
    const Index start = t_.walk(t_.points_[v], hint_, Everywhere{});
    if (start < 0) continue;  // a duplicate
    t_.search<false>(t_.points_[v], t_.numbers_[v], start, cavity_, Everywhere{});
    t_.reserve_slots(cavity_.border.size());
    t_.fill(v, cavity_, t_.slots_);
    hint_ = cavity_.created[0];
  }
}

// Returns the vertices that have to wait.
std::vector<Index> PartInsertion::insert_in_parts(std::vector<Index> vertices, Index known, bool shifted) {
  std::vector<Task> tasks = make_tasks(vertices, known, shifted);
  run(tasks);
  vertices.clear();
  for (Task& task : tasks) {
    vertices.insert(vertices.end(), task.left.begin(), task.left.end());
    std::vector<Index>& free = t_.slots_.free;
    free.insert(free.end(), task.slots.free.begin(), task.slots.free.end());
    for (Index slot = task.slots.end; slot-- > task.slots.next;) {
      t_.corners_[slot].fill(Triangulation::free_slot);
      free.push_back(slot);
    }
    PredicateCounters& counters = predicate_counters();
    counters.orient_exact += task.counters.orient_exact;
    counters.insphere_exact += task.counters.insphere_exact;
    counters.insphere_perturbed += task.counters.insphere_perturbed;
  }
  hint_ = 0;
  while (t_.is_free(hint_)) ++hint_;
  return vertices;
}

// Cuts the curve at equal numbers of `vertices` (shifted by half a part), and hands every part its slots.
std::vector<PartInsertion::Task> PartInsertion::make_tasks(const std::vector<Index>& vertices, Index known,
                                                           bool shifted) {
  std::vector<std::uint32_t> cuts;
  for (int k = shifted ? 0 : 1; k < kParts; ++k) {
    const std::size_t at = vertices.size() * (2 * static_cast<std::size_t>(k) + shifted) / (2 * kParts);
    cuts.push_back(codes_[vertices[at]]);
  }
  const auto part = [&](Index v) {
    return static_cast<std::uint8_t>(std::upper_bound(cuts.begin(), cuts.end(), codes_[v]) - cuts.begin());
  };
  part_of_.resize(t_.points_.size());
  for (Index v = 0; v < known; ++v) part_of_[v] = part(v);
  std::vector<Task> tasks(cuts.size() + 1);
  for (std::size_t k = 0; k < tasks.size(); ++k)
    tasks[k].part = {part_of_.data(), static_cast<std::uint8_t>(k)};
  for (const Index v : vertices) tasks[part_of_[v]].vertices.push_back(v);
  std::size_t slots = static_cast<std::size_t>(t_.slots_.next);
  for (Task& task : tasks) {
    task.slots.next = static_cast<Index>(slots);
    slots += static_cast<std::size_t>(kSlotsPerPoint * static_cast<double>(task.vertices.size())) + 1000;
    task.slots.end = static_cast<Index>(slots);
  }
  if (slots > t_.corners_.size()) t_.resize_slots(slots);
  t_.slots_.next = static_cast<Index>(slots);
  return tasks;
}

void PartInsertion::run(std::vector<Task>& tasks) {
  const auto work = [&](int thread, int k, const std::atomic<bool>& stop) {
    run(tasks[k], thread == 0, stop);
  };
  for_all(context_.threads, static_cast<int>(tasks.size()), work, [&] { context_.poll(0); });
}

void PartInsertion::run(Task& task, bool calling_thread, const std::atomic<bool>& stop) {
  const PredicateCounters before = predicate_counters();
  Cavity cavity;
  Index hint = first_tet(task);
  for (const Index v : task.vertices) {
    if (stop) break;
    if (calling_thread) context_.tick(0);
    if (t_.vertex_tet_[v] >= 0) continue;  // one of the first four
    const Vec3& p = t_.points_[v];
    const Index start = hint < 0 ? Triangulation::kLeft : t_.walk(p, hint, task.part);
    if (start == -1) continue;  // a duplicate
    if (start < 0 || t_.search<false>(p, t_.numbers_[v], start, cavity, task.part) != -1 ||
        !task.slots.enough(cavity.border.size())) {
      task.left.push_back(v);
      continue;
    }
    t_.fill(v, cavity, task.slots);
    hint = cavity.created[0];
  }
  PredicateCounters& counters = predicate_counters();
  task.counters = {counters.orient_exact - before.orient_exact,
                   counters.insphere_exact - before.insphere_exact,
                   counters.insphere_perturbed - before.insphere_perturbed};
  counters = before;
}

// A finite tetrahedron of the part, or -1: near the middle of the part, away from its frontier, is the
// likeliest.
Index PartInsertion::first_tet(const Task& task) const {
  const Index first = task.vertices.empty() ? 0 : task.vertices.front();
  for (Index v = 0; v < first; ++v) {
    if (part_of_[v] != task.part.part) continue;  // not ours to read: another thread may write it
    const Index tet = t_.vertex_tet_[v];
    if (tet >= 0 && !t_.is_ghost(tet) && task.part(t_.corners_[tet])) return tet;
  }
  return -1;
}

}  // namespace dm
