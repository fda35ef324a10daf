#include "base/parallel.h"

#include <doctest/doctest.h>

using namespace dm;

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
