// Progress, cancel, seed and threads of one run, handed to every stage.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "base/failure.h"

namespace dm {

class Context {
 public:
  // report(stage, fraction of the stage in 0..1) returns false to cancel; it is called at most every 30 ms.
  using Report = std::function<bool(const char*, double)>;
  explicit Context(Report report = {}) : report_(std::move(report)) {}

  std::uint64_t seed = 1;
  int threads = 1;

  void begin(const char* stage) {
    stage_ = stage;
    fraction_ = 0;
    call();
  }
  // Call this at least once every few milliseconds of work.  Throws Cancelled.
  void poll(double fraction) {
    if (!report_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(30)) return;
    if (fraction > fraction_) fraction_ = fraction < 1 ? fraction : 1;
    call();
  }
  // poll() for loops with short steps: looks at the clock at every 256th call only.
  void tick(double fraction) {
    if ((++ticks_ & 255) == 0) poll(fraction);
  }

 private:
  void call() {
    last_ = std::chrono::steady_clock::now();
    if (report_ && !report_(stage_, fraction_)) throw Cancelled();
  }
  Report report_;
  const char* stage_ = "";
  double fraction_ = 0;
  unsigned ticks_ = 0;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace dm
