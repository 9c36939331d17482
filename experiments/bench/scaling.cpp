#include "experiments/bench/scaling.hpp"

#include <algorithm>
#include <stdexcept>

#include "experiments/bench/bench_run.hpp"

namespace driftless {
namespace {

/// Both of the runs together would not fit into a small machine's memory.
constexpr std::size_t most_at_once = 1'000'000;

void measure(std::vector<KernelRow>& rows, const BenchKernel& kernel, const BenchStart& start,
             const std::vector<unsigned>& threads, const Sampling& sampling) {
  std::vector<std::unique_ptr<BenchRun>> runs;
  std::vector<Contestant> contestants;
  const std::size_t particles = start.state.size();
  for (const unsigned count : threads) {
    auto& run =
        *runs.emplace_back(std::make_unique<BenchRun>(kernel.library(), start.fluid, start));
    run.system().set_threads(count);
    contestants.push_back({[&run] { run.advance(); }, particles});
  }
  const auto measured = time_in_turns(contestants, sampling);
  for (std::size_t n = 0; n < runs.size(); ++n) {
    if (!measured[n].failure.empty()) throw std::runtime_error(measured[n].failure);
    KernelRow row{kernel.name, particles, threads[n], measured[n].nanoseconds};
    if (threads[n] == 1) row.stages = stages_of(*runs[n]);
    row.bytes = bytes_per_particle(runs[n]);
    rows.push_back(row);
  }
}

}  // namespace

ScalingPlan scaling_plan(bool quick) {
  ScalingPlan plan;
  plan.particles = {1000, 3000, 10'000, 30'000, 100'000, 300'000};
  plan.thread_particles = {3000, 24'000};
  if (!quick) {
    plan.particles.insert(plan.particles.end(), {1'000'000, 3'000'000, 10'000'000});
    plan.thread_particles.push_back(192'000);
  }
  plan.sampling = {.samples = quick ? 5U : 9U, .seconds = 0.05, .least_steps = 1, .most = 3};
  for (unsigned count = 1; count < usable_processors(); count *= 2) plan.threads.push_back(count);
  plan.threads.push_back(usable_processors());
  plan.triad_bytes = quick ? beyond_the_cache() / 2 : beyond_the_cache();
  return plan;
}

std::vector<KernelRow> bench_sizes(std::size_t particles, const std::vector<unsigned>& threads,
                                   const Sampling& sampling) {
  const BenchStart start = bench_start(particles);
  std::vector<KernelRow> rows;
  for (const BenchKernel& kernel : bench_kinds) {
    if (particles <= most_at_once) {
      measure(rows, kernel, start, threads, sampling);
    } else {
      for (const unsigned count : threads) measure(rows, kernel, start, {count}, sampling);
    }
  }
  return rows;
}

std::vector<LimitRow> bench_limits(const ScalingPlan& plan, const std::vector<KernelRow>& sizes) {
  const BenchStart start = bench_start(plan.cached_particles);
  System system(start.fluid, start.box, start.state, Noise(bench_seed, 0));
  std::size_t pairs = 0;
  system.for_each_pair([&](const auto&) { ++pairs; });
  const double pairs_per_particle =
      static_cast<double>(pairs) / static_cast<double>(plan.cached_particles);
  std::vector<unsigned> threads = {1};
  if (plan.threads.back() > 1) threads.push_back(plan.threads.back());
  std::vector<LimitRow> limits;
  for (const unsigned count : threads) {
    const double bandwidth = triad_bandwidth(plan.triad_bytes, count);
    for (const BenchKernel& kernel : bench_kinds) {
      const auto cached = std::find_if(sizes.begin(), sizes.end(), [&](const KernelRow& row) {
        return row.kernel == kernel.name && row.threads == 1 &&
               row.particles == plan.cached_particles;
      });
      if (cached == sizes.end()) throw std::invalid_argument("no row for the arithmetic's floor");
      const double floor = 1e9 * (cached->stages.noise + cached->stages.arithmetic);
      limits.push_back({kernel.name, count, bandwidth, floor / count,
                        1e9 * bytes_per_step(kernel.name, pairs_per_particle) / bandwidth});
    }
  }
  return limits;
}

}  // namespace driftless
