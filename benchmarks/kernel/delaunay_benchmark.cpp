// Delaunay triangulation of point sets: this kernel and, where it is installed, CGAL in the same run.
// Usage: delaunay_benchmark [points] [threads] [runs] [set]
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "kernel/predicates.h"
#include "kernel/triangulation.h"
#include "point_sets.h"
#include "thread_probes.h"

#ifdef DM_WITH_CGAL
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#endif

using namespace dm;

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
// Of this thread: what a single-threaded run costs even when others use the machine.
double cpu_now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Timed {
  double seconds = 1e300;  // CPU time with one thread, wall-clock time with more
  std::size_t tets = 0;
};

Timed run_own(const std::vector<Vec3>& points, int threads, std::size_t& bytes) {
  Context context;
  context.threads = threads;
  const double start = threads == 1 ? cpu_now() : now();
  const Triangulation t(points, context);
  Timed timed{(threads == 1 ? cpu_now() : now()) - start, 0};
  for (Index i = 0; i < t.slot_count(); ++i) timed.tets += !t.is_free(i) && !t.is_ghost(i);
  bytes = t.bytes();
  return timed;
}

#ifdef DM_WITH_CGAL
Timed run_cgal(const std::vector<Vec3>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> p;
  for (const Vec3& v : points) p.emplace_back(v.x, v.y, v.z);
  const double start = cpu_now();
  const CGAL::Delaunay_triangulation_3<Kernel> t(p.begin(), p.end());
  return {cpu_now() - start, t.number_of_finite_cells()};
}
#else
Timed run_cgal(const std::vector<Vec3>&) { return {}; }
#endif

void compare(const char* name, const std::vector<Vec3>& points, int threads, int runs) {
  Timed own, cgal;
  std::size_t bytes = 0;
  predicate_counters() = {};
  for (int i = 0; i < runs; ++i) {  // alternating, so that other load hits both
    const Timed a = run_own(points, threads, bytes);
    if (a.seconds < own.seconds) own = a;
    const Timed b = run_cgal(points);
    if (b.seconds < cgal.seconds) cgal = b;
  }
  const auto& c = predicate_counters();
  std::printf("%-9s %9zu %10zu tets %7.3f s %6.2f Mtet/s %5.1f B/tet", name, points.size(), own.tets,
              own.seconds, own.tets / own.seconds * 1e-6, double(bytes) / own.tets);
  std::printf("  exact orient %.4f insphere %.4f ties %.4f per point",
              double(c.orient_exact) / runs / points.size(), double(c.insphere_exact) / runs / points.size(),
              double(c.insphere_perturbed) / runs / points.size());
  if (cgal.tets > 0)
    std::printf("  CGAL %10zu tets %7.3f s %6.2f Mtet/s  ratio %.2f", cgal.tets, cgal.seconds,
                cgal.tets / cgal.seconds * 1e-6, cgal.seconds / own.seconds);
  std::printf("\n");
  std::fflush(stdout);
}

void compare_threads(const std::vector<Vec3>& points, int threads, int runs) {
  using benchmark::speed_up;
  double own = 0, arithmetic = 0, memory = 0;
  std::size_t bytes = 0;
  for (int i = 0; i < runs; ++i) {
    arithmetic = std::max(arithmetic, speed_up(benchmark::arithmetic_probe, threads));
    memory = std::max(memory, speed_up(benchmark::memory_probe, threads));
    const double start = now();
    run_own(points, 1, bytes);
    const double one = now() - start;
    own = std::max(own, one / run_own(points, threads, bytes).seconds);
  }
  std::printf("%d threads, %zu points: speed-up %.2f; of pure arithmetic %.2f, of pure memory access %.2f\n",
              threads, points.size(), own, arithmetic, memory);
}

}  // namespace

int main(int argc, char** argv) {
  const int n = argc > 1 ? std::atoi(argv[1]) : 1000000;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const int runs = argc > 3 ? std::atoi(argv[3]) : 3;
  const std::string set = argc > 4 ? argv[4] : "all";
  const auto wanted = [&](const char* name) { return set == "all" || set == name; };
  if (wanted("uniform")) compare("uniform", benchmark::uniform(n), threads, runs);
  if (wanted("sphere")) compare("sphere", benchmark::sphere(n / 10), threads, runs);
  if (wanted("cylinder")) compare("cylinder", benchmark::cylinder(n / 10), threads, runs);
  if (wanted("clusters")) compare("clusters", benchmark::clusters(n), threads, runs);
  if (wanted("plate")) compare("plate", benchmark::plate(n / 10), threads, runs);
  if (threads > 1) compare_threads(benchmark::uniform(n), threads, runs);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("peak memory of the process %.0f MB\n", usage.ru_maxrss / 1024.0);
  return 0;
}
