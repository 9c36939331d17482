#pragma once

#include <optional>
#include <string>

#include "experiments/observables.hpp"
#include "experiments/study.hpp"

namespace driftless {

/// Why and when a replica broke.
struct Failure {
  unsigned replica = 0;
  FailureCause cause = FailureCause::non_finite;
  std::uint64_t step = 0;
  double time = 0;
};

/// One run of one method at one step: its record, or how it failed.
struct ReplicaResult {
  unsigned replica = 0;
  std::optional<Failure> failure;
  Record record;      ///< empty after a failure
  Counters counters;  ///< of the whole run
  std::uint64_t steps = 0;
};

/// Durations of a study in whole steps of a given size.
struct StepPlan {
  std::uint64_t equilibrate, samples, steps_per_sample;

  StepPlan(const Study& study, double time_step);
  std::uint64_t steps() const { return equilibrate + samples * steps_per_sample; }
};

/// Runs one replica to its end or its failure. A pure function of its arguments, bit for bit, for
/// any number of threads.
ReplicaResult run_replica(const PreparedScene& prepared, const Study& study,
                          const MethodChoice& choice, double time_step, unsigned replica,
                          unsigned threads = 1);

}  // namespace driftless
