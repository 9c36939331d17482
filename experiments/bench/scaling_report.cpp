#include <fmt/format.h>

#include <cstdio>

#include "experiments/bench/bench_run.hpp"
#include "experiments/bench/bench_text.hpp"
#include "experiments/bench/scaling.hpp"

namespace driftless {
namespace {

std::string stage_text(const StageSeconds& stages) {
  if (stages.total() == 0) return "";
  return fmt::format("{:>7.1f} {:>7.1f} {:>10.1f} {:>8.1f} {:>11.1f}", 1e9 * stages.search,
                     1e9 * stages.noise, 1e9 * stages.arithmetic, 1e9 * stages.scatter,
                     1e9 * stages.integration);
}

constexpr const char* stage_names = " search   noise arithmetic  scatter integration";

std::vector<KernelRow> print_sizes(const std::vector<std::size_t>& particles,
                                   const std::vector<unsigned>& threads, const Sampling& sampling,
                                   const char* title) {
  print_line("\n{}\n{:<14} {:>9} {:>7}  {:>26}  {:>8}  {}\n", title, "kernel", "particles",
             "threads", "ns per particle-step", "bytes", stage_names);
  std::vector<KernelRow> all;
  for (const auto count : particles) {
    for (const auto& row : bench_sizes(count, threads, sampling)) {
      print_line("{:<14} {:>9} {:>7}  {:>26}  {:>8}  {}\n", row.kernel, row.particles, row.threads,
                 text(row.nanoseconds), bytes_text(row.bytes), stage_text(row.stages));
      all.push_back(row);
    }
  }
  return all;
}

std::vector<SceneRow> print_terms(const ScalingPlan& plan) {
  BenchPlan terms{{}, {1}, plan.sampling, plan.terms_particles};
  print_line("\nWhat terms cost ({} particles, one thread)\n{:<14} {:<14}  {:>26}  {:>8}  {}\n",
             plan.terms_particles, "scene", "kernel", "ns per particle-step", "bytes", stage_names);
  const auto rows = bench_scenes(terms);
  for (const auto& row : rows) {
    print_line("{:<14} {:<14}  {:>26}  {:>8}  {}\n", row.scene, row.kernel, text(row.nanoseconds),
               bytes_text(row.bytes), stage_text(row.stages));
  }
  return rows;
}

std::vector<LimitRow> print_limits(const ScalingPlan& plan, const std::vector<KernelRow>& sizes) {
  print_line("\nLimits\n{:<14} {:>7}  {:>14}  {:>26}  {:>26}\n", "kernel", "threads", "triad, GB/s",
             "noise and arithmetic, ns", "memory beyond caches, ns");
  const auto rows = bench_limits(plan, sizes);
  for (const auto& row : rows) {
    print_line("{:<14} {:>7}  {:>14.1f}  {:>26.1f}  {:>26.1f}\n", row.kernel, row.threads,
               1e-9 * row.bandwidth, row.arithmetic, row.memory);
  }
  return rows;
}

nlohmann::json traffic_json() {
  nlohmann::json all;
  for (const BenchKernel& kernel : bench_kinds) {
    for (const auto& part : step_traffic(kernel.name)) {
      all[kernel.name].push_back({{"part", part.part},
                                  {"bytes_in_order", part.in_order},
                                  {"bytes_per_pair", part.per_pair}});
    }
  }
  return all;
}

}  // namespace

nlohmann::json to_json(const LimitRow& row) {
  return {{"kernel", row.kernel},
          {"threads", row.threads},
          {"triad_bytes_per_second", row.bandwidth},
          {"arithmetic_ns_per_particle_step", row.arithmetic},
          {"memory_ns_per_particle_step", row.memory},
          {"bytes_per_particle_step", 1e-9 * row.memory * row.bandwidth}};
}

nlohmann::json run_scaling(const ScalingPlan& plan) {
  std::vector<unsigned> ends = {1};
  if (plan.threads.back() > 1) ends.push_back(plan.threads.back());
  const auto sizes =
      print_sizes(plan.particles, ends, plan.sampling, "Sizes (ns of the stages on one thread)");
  const auto threads = print_sizes(plan.thread_particles, plan.threads, plan.sampling, "Threads");
  const auto terms = print_terms(plan);
  const auto limits = print_limits(plan, sizes);
  return {{"sizes", all_to_json(sizes)},
          {"threads", all_to_json(threads)},
          {"terms", all_to_json(terms)},
          {"limits", all_to_json(limits)},
          {"cached_particles", plan.cached_particles},
          {"traffic", traffic_json()}};
}

}  // namespace driftless
