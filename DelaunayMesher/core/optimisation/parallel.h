// A loop on several threads, in no particular order.
#pragma once

#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "base/context.h"

namespace dm {

// Calls work(thread, item) for every item in 0..count-1.  The calling thread is thread 0 and polls after each
// of its items; cancelling and failures end all threads before they are thrown on.
template <class Work>
void for_all(int count, Context& context, double fraction, Work work) {
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  const int threads = std::max(1, std::min(context.threads, count));
  std::vector<std::exception_ptr> errors(threads);
  const auto run = [&](int thread) {
    try {
      for (int item = next++; item < count && !stop; item = next++) {
        work(thread, item);
        if (thread == 0) context.poll(fraction);
      }
    } catch (...) {
      errors[thread] = std::current_exception();
      stop = true;
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(run, i);
  run(0);
  for (std::thread& helper : helpers) helper.join();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace dm
