#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/bench/bench.hpp"
#include "experiments/bench/roofline.hpp"

namespace driftless {

/// How the time of a step grows: with the size of a system, with threads, with what a scene has.
struct ScalingPlan {
  std::vector<std::size_t> particles;  ///< one thread and all
  Sampling sampling = {};
  std::vector<std::size_t> thread_particles;  ///< these on every number of threads
  std::vector<unsigned> threads;              ///< from 1 on
  std::size_t terms_particles = 24000;
  std::size_t cached_particles = 3000;  ///< where the arithmetic is not kept waiting by memory
  std::size_t triad_bytes = 0;          ///< of each of the triad's three arrays
};
ScalingPlan scaling_plan(bool quick);

/// What the limits are computed from and the limits themselves, of one kernel on some threads.
struct LimitRow {
  std::string kernel;
  unsigned threads = 1;
  double bandwidth = 0;   ///< bytes a second that a triad moves
  double arithmetic = 0;  ///< ns of noise and arithmetic per particle and step, shared by threads
  double memory = 0;      ///< ns that the bytes of a step take at that bandwidth
};

/// Both kernels on one thread and on as many as given, without the naive reference; on one thread
/// with the stages.
std::vector<KernelRow> bench_sizes(std::size_t particles, const std::vector<unsigned>& threads,
                                   const Sampling& sampling);
/// Both kernels on one thread and on the most of the plan; the floor of arithmetic from the row of
/// `cached_particles` on one thread. Throws std::invalid_argument where that row is missing.
std::vector<LimitRow> bench_limits(const ScalingPlan& plan, const std::vector<KernelRow>& sizes);

/// Measures everything and prints it as it comes; the JSON of the tables: `sizes`, `threads`,
/// `terms`, `limits`, `traffic`.
nlohmann::json run_scaling(const ScalingPlan& plan);

nlohmann::json to_json(const LimitRow& row);

}  // namespace driftless
