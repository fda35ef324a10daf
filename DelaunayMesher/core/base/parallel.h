// Loops on several threads, in no particular order.
//
// The calling thread works, too, and polls: between its items (or within them) and, when it has no more,
// every 20 ms until the others have none, so that cancelling waits for no other thread's item.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/context.h"

namespace dm {

// Calls work(thread, item, stop) for every item in 0..count-1; the calling thread is thread 0, and calls
// poll() while it waits for others.  The first failure, also of poll(), sets `stop` and ends all threads
// before it is thrown on.
template <class Work, class Poll>
void for_all(int threads, int count, Work work, Poll poll) {
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  threads = std::max(1, std::min(threads, count));
  std::exception_ptr error;
  const auto guard = [&](auto call) {
    try {
      call();
    } catch (...) {
      if (!stop.exchange(true)) error = std::current_exception();
    }
  };
  const auto run = [&](int thread) {
    guard([&] {
      for (int item = next++; item < count && !stop; item = next++) work(thread, item, stop);
    });
  };
  std::mutex mutex;
  std::condition_variable ended;
  std::size_t ends = 0;
  std::vector<std::thread> others;
  try {
    others.reserve(threads);
    for (int i = 1; i < threads; ++i)
      others.emplace_back([&, i] {
        run(i);
        const std::lock_guard lock(mutex);
        ++ends;
        ended.notify_one();
      });
  } catch (const std::exception&) {  // no more threads, or no memory for them: those that run do all the work
  }
  run(0);
  std::unique_lock lock(mutex);
  while (!ended.wait_for(lock, std::chrono::milliseconds(20), [&] { return ends == others.size(); }))
    if (!stop) guard(poll);
  lock.unlock();
  for (std::thread& other : others) other.join();
  if (error) std::rethrow_exception(error);
}

// Calls work(thread, item); thread 0 polls after each of its items.
template <class Work>
void for_all(int count, Context& context, double fraction, Work work) {
  const auto poll = [&] { context.poll(fraction); };
  const auto work_and_poll = [&](int thread, int item, const std::atomic<bool>&) {
    work(thread, item);
    if (thread == 0) poll();
  };
  for_all(context.threads, count, work_and_poll, poll);
}

}  // namespace dm
