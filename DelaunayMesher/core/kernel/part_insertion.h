// Insertion of a round of points, by several threads when it is large.
//
// Idea: part.h.  The parts are intervals of the Hilbert curve with equal numbers of points; points that
// cannot be inserted within their part wait for a second pass with shifted intervals, and what is left goes
// in serially. Parts, passes and the slots that each part may fill depend on the points alone, so the result
// is the same, byte for byte, for every number of threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "kernel/predicates.h"
#include "kernel/triangulation.h"

namespace dm {

class PartInsertion {
 public:
  // `codes`: position of every vertex on the curve, ascending within a round.
  PartInsertion(Triangulation& t, const std::vector<std::uint32_t>& codes, Context& context,
                Index parallel_from)
      : t_(t), codes_(codes), context_(context), parallel_from_(parallel_from) {}

  // Inserts the vertices begin .. end - 1, all earlier ones being in.
  void insert_round(Index begin, Index end);

 private:
  struct Task {
    Part part;
    std::vector<Index> vertices, left;
    Slots slots;
    PredicateCounters counters;
  };

  void insert_serially(const std::vector<Index>& vertices);
  std::vector<Index> insert_in_parts(std::vector<Index> vertices, Index inserted, bool shifted);
  std::vector<Task> make_tasks(const std::vector<Index>& vertices, Index known, bool shifted);
  void run(std::vector<Task>& tasks);
  void run(Task& task, bool calling_thread, const std::atomic<bool>& stop);
  Index first_tet(const Task& task) const;

  Triangulation& t_;
  const std::vector<std::uint32_t>& codes_;
  Context& context_;
  Index parallel_from_;
  std::vector<std::uint8_t> part_of_;
  Index hint_ = 0;
  Cavity cavity_;
};

}  // namespace dm
