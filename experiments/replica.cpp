#include "experiments/replica.hpp"

#include <algorithm>
#include <cmath>

namespace driftless {

StepPlan::StepPlan(const Study& study, double time_step)
    : equilibrate(static_cast<std::uint64_t>(std::llround(study.equilibrate / time_step))),
      samples(static_cast<std::uint64_t>(std::llround(study.measure / study.sample_every))),
      steps_per_sample(driftless::steps_per_sample(study, time_step)) {}

ReplicaResult run_replica(const PreparedScene& prepared, const Study& study,
                          const MethodChoice& choice, double time_step, unsigned replica,
                          unsigned threads) {
  const StepPlan plan(study, time_step);
  const auto integrator = find_method(choice.name)->make(choice.options);
  System system = prepared.start(replica);
  system.set_threads(threads);
  ReplicaResult result;
  result.replica = replica;
  const auto advance = [&](std::uint64_t steps) {
    for (std::uint64_t n = 0; n < steps; ++n) {
      system.set_step(++result.steps);
      integrator->step(system, time_step);
    }
  };
  // An isolated system that has doubled its energy is broken, whether or not a number is.
  const double energy = system.total_energy();
  const auto check_energy = [&] {
    if (std::abs(system.total_energy() - energy) > std::abs(energy)) {
      throw StepFailure(FailureCause::energy_runaway, {});
    }
  };
  try {
    for (std::uint64_t done = 0; done < plan.equilibrate; done += plan.steps_per_sample) {
      advance(std::min(plan.steps_per_sample, plan.equilibrate - done));
      check_energy();
    }
    Sampler sampler(prepared, system, replica, plan.samples);
    for (std::uint64_t sample = 0; sample < plan.samples; ++sample) {
      advance(plan.steps_per_sample);
      check_energy();
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
