#include "experiments/replica.hpp"

#include <algorithm>
#include <cmath>

namespace driftless {

namespace {

/// An isolated system that has doubled its energy is broken, whether or not a number is. One with a
/// bath may warm up to it and fluctuate: it is broken at ten times what that could explain.
class EnergyGuard {
 public:
  EnergyGuard(const PreparedScene& prepared, System& system)
      : start_(system.energy_with_surroundings()), allowed_(std::abs(start_)) {
    if (!prepared.fluid().isothermal()) return;
    // 40 k T: the kinetic energy of a single degree exceeds that once in exp(40) looks.
    allowed_ += 10 * prepared.thermal_kinetic_energy() + 40 * prepared.energy_unit();
    bath_ = true;
  }
  /// Throws StepFailure.
  void check(System& system) const {
    const double gain = system.energy_with_surroundings() - start_;
    if ((bath_ ? gain : std::abs(gain)) > allowed_) {
      throw StepFailure(FailureCause::energy_runaway, {});
    }
  }

 private:
  double start_, allowed_;
  bool bath_ = false;
};

}  // namespace

StepPlan::StepPlan(const Study& study, double time_step)
    : equilibrate(static_cast<std::uint64_t>(std::llround(study.equilibrate / time_step))),
      samples(static_cast<std::uint64_t>(std::llround(study.measure / study.sample_every))),
      steps_per_sample(driftless::steps_per_sample(study, time_step)) {}

ReplicaResult run_replica(const PreparedScene& prepared, const Study& study,
                          const MethodChoice& choice, double time_step, unsigned replica,
                          unsigned threads) {
  const StepPlan plan(study, time_step);
  const auto integrator = prepared.driven(find_method(choice.name)->make(choice.options), replica);
  System system = prepared.start(replica);
  system.set_threads(threads);
  ReplicaResult result;
  result.replica = replica;
  const auto advance = [&](std::uint64_t steps) {
    for (std::uint64_t n = 0; n < steps; ++n) {
      begin_step(system, *integrator, ++result.steps);
      integrator->step(system, time_step);
    }
  };
  const EnergyGuard guard(prepared, system);
  try {
    for (std::uint64_t done = 0; done < plan.equilibrate; done += plan.steps_per_sample) {
      advance(std::min(plan.steps_per_sample, plan.equilibrate - done));
      guard.check(system);
    }
    Sampler sampler(prepared, system, replica, plan.samples);
    for (std::uint64_t sample = 0; sample < plan.samples; ++sample) {
      advance(plan.steps_per_sample);
      guard.check(system);
      sampler.take(system, static_cast<double>(sample + 1) * study.sample_every);
    }
    result.record = std::move(sampler).finish();
  } catch (const StepFailure& failure) {
    result.failure = {replica, failure.cause(), result.steps,
                      static_cast<double>(result.steps) * time_step};
  }
  result.counters = system.counters();
  return result;
}

}  // namespace driftless
