#pragma once

#include <memory>
#include <optional>

#include "experiments/bench/bench.hpp"
#include "experiments/bench/naive.hpp"

namespace driftless {

constexpr double bench_time_step = 0.01;
constexpr std::uint64_t bench_seed = 1;

/// A kind of step, in the library and in the naive reference.
struct BenchKernel {
  const char* name;
  const char* method;
  void (NaiveFluid::*naive_step)(double);

  const Method& library() const { return *find_method(method); }
};
inline constexpr BenchKernel bench_kinds[] = {
    {"force-parallel", "averaged-drift", &NaiveFluid::force_parallel_step},
    {"sequential", "shardlow-s1", &NaiveFluid::sequential_step}};

/// A method at work on a system.
class BenchRun {
 public:
  BenchRun(const Method& method, const Fluid& fluid, const BenchStart& start, bool frozen = false)
      : system_(fluid, start.box, start.state, Noise(bench_seed, 0), frozen),
        integrator_(method.make({})) {}

  void advance() {
    begin_step(system_, *integrator_, ++steps_);
    integrator_->step(system_, bench_time_step);
  }
  System& system() { return system_; }
  std::uint64_t steps() const { return steps_; }
  /// Of a counter, per step so far.
  double per_step(std::uint64_t count) const {
    return static_cast<double>(count) / static_cast<double>(steps_);
  }

 private:
  System system_;
  std::unique_ptr<Integrator> integrator_;
  std::uint64_t steps_ = 0;
};

/// Seconds of each stage per particle and step, of some more steps: looking at the clock takes
/// time. Of a run on one thread; of a few looks the one that other programs disturbed least.
StageSeconds stages_of(BenchRun& run);

/// Ends a run; the memory it held per particle, beyond the State itself. None where the allocator
/// does not tell.
std::optional<double> bytes_per_particle(std::unique_ptr<BenchRun>& run);

}  // namespace driftless
