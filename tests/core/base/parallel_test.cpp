#include "base/parallel.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <new>

using namespace dm;

namespace {

constexpr int kAlways = -1;
thread_local int allocations = kAlways;  // that succeed on this thread

}  // namespace

void* operator new(std::size_t size) {
  void* memory = allocations == 0 ? nullptr : std::malloc(size);
  if (!memory) throw std::bad_alloc();
  if (allocations > 0) --allocations;
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("every item is done once, whatever the number of threads") {
  for (const int threads : {1, 2, 5}) {
    std::vector<std::atomic<int>> done(100);
    const auto work = [&](int thread, int item, const std::atomic<bool>&) {
      CHECK(thread < threads);
      ++done[item];
    };
    for_all(threads, 100, work, [] {});
    for (const auto& times : done) CHECK(times == 1);
  }
}

TEST_CASE("the calling thread polls while another one works, and a failed poll stops that") {
  // Two items, one on each thread: the calling thread's ends when the other one's runs.
  std::atomic<bool> started{false};
  int polls = 0;
  const auto poll = [&] {
    if (++polls == 3) throw Cancelled();
  };
  const auto work = [&](int thread, int, const std::atomic<bool>& stop) {
    const auto wait_for = [](const std::atomic<bool>& flag) {
      for (int i = 0; i < 5000 && !flag; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return flag.load();
    };
    if (thread == 0) {
      CHECK(wait_for(started));
    } else {
      started = true;
      CHECK(wait_for(stop));
    }
  };
  CHECK_THROWS_AS(for_all(2, 2, work, poll), Cancelled);
  CHECK(polls == 3);
}

TEST_CASE("a failure on another thread is thrown on the calling one") {
  const auto work = [](int, int item, const std::atomic<bool>&) {
    if (item == 7) throw Failure("check", "check", "seven");
  };
  CHECK_THROWS_AS(for_all(3, 20, work, [] {}), Failure);
}

TEST_CASE("without memory for threads, those that there are do all the work") {
  for (int granted = 0; granted < 8; ++granted) {
    std::vector<std::atomic<int>> done(50);
    const auto work = [&](int, int item, const std::atomic<bool>&) { ++done[item]; };
    allocations = granted;
    for_all(5, 50, work, [] {});
    allocations = kAlways;
    for (const auto& times : done) CHECK(times == 1);
  }
}
