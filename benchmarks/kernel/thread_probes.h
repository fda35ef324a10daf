// What a second thread can gain on this machine at all: pure arithmetic and pure memory access.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace dm::benchmark {

// A chain of multiplications that no cache or memory can slow down.
inline std::uint64_t arithmetic_probe(int seed) {
  std::uint64_t x = 88172645463325252u + static_cast<std::uint64_t>(seed);
  for (int i = 0; i < 200000000; ++i) x = x * 6364136223846793005u + 1442695040888963407u;
  return x;
}

// Reads at places that depend on one another, far beyond any cache.
inline std::uint64_t memory_probe(int seed) {
  constexpr std::size_t size = std::size_t{1} << 24;
  static const std::vector<std::uint64_t> numbers(size, 1);
  std::uint64_t x = static_cast<std::uint64_t>(seed) + 1, sum = 0;
  for (int i = 0; i < 4000000; ++i) {
    x = x * 6364136223846793005u + numbers[x >> 40 & (size - 1)];
    sum += x;
  }
  return sum;
}

// Wall-clock time of `threads` equal pieces of work one after another over that of all at once.
inline double speed_up(const std::function<std::uint64_t(int)>& work, int threads) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::uint64_t> results(static_cast<std::size_t>(threads));
  work(0);
  const auto begin = Clock::now();
  for (int i = 0; i < threads; ++i) results[static_cast<std::size_t>(i)] += work(i);
  const auto middle = Clock::now();
  std::vector<std::thread> helpers;
  for (int i = 0; i < threads; ++i)
    helpers.emplace_back([&, i] { results[static_cast<std::size_t>(i)] += work(i); });
  for (std::thread& helper : helpers) helper.join();
  const auto end = Clock::now();
  volatile std::uint64_t keep = results[0];
  (void)keep;
  return std::chrono::duration<double>(middle - begin) / std::chrono::duration<double>(end - middle);
}

}  // namespace dm::benchmark
