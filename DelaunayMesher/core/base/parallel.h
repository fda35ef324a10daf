// Loops on several threads, in no particular order.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

#include "base/context.h"

namespace dm {

// Calls work(thread, item, stop) for every item in 0..count-1; the calling thread is thread 0.  The first
// failure sets `stop` and ends all threads before it is thrown on.
template <class Work>
void for_all(int threads, int count, Work work) {
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  threads = std::max(1, std::min(threads, count));
  std::exception_ptr error;
  const auto run = [&](int thread) {
    try {
      for (int item = next++; item < count && !stop; item = next++) work(thread, item, stop);
    } catch (...) {
      if (!stop.exchange(true)) error = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  try {
    for (int i = 1; i < threads; ++i) others.emplace_back(run, i);
  } catch (const std::system_error&) {  // the system has no more threads: those that run do all the work
  }
  run(0);
  for (std::thread& other : others) other.join();
  if (error) std::rethrow_exception(error);
}

// Calls work(thread, item); thread 0 polls after each of its items.
template <class Work>
void for_all(int count, Context& context, double fraction, Work work) {
  for_all(context.threads, count, [&](int thread, int item, const std::atomic<bool>&) {
    work(thread, item);
    if (thread == 0) context.poll(fraction);
  });
}

}  // namespace dm
