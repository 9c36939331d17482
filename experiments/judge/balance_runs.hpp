#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/judge/examination.hpp"
#include "experiments/judge/reversal.hpp"
#include "experiments/judge/two_body/bench.hpp"

/// What the examination `balance` runs: ensembles of isolated pairs and of small fluids.
namespace driftless::judge {

/// The pairs of moments whose reversal is looked at, and after which time, in the order of a
/// record's vector: "K, K^2 after 0.4".
std::vector<std::string> pair_reversal_columns();
std::vector<std::string> fluid_reversal_columns();

/// S[P](t) of pairs that start in a cloud: {"copies", "failed", "times", "relative", "error",
/// "fall": {"from", "to", "depth", "error"}}; after a failure that no copy is to blame for, or
/// where more than a fifth of the copies fail, {"failure": {"cause", "step", "time"}, "failed"}.
nlohmann::json run_entropy_course(const Candidate& candidate, const two_body::Bench& bench,
                                  double time_step, std::size_t copies, std::uint64_t seed);

/// Stationary pairs looked at forwards and backwards: {"copies", "failed", "reversal": a Scatter's
/// record, "transitions": [[counts]]} or {"failure", "failed"}.
nlohmann::json run_pair_reversal(const Candidate& candidate, const two_body::Bench& bench,
                                 double time_step, std::size_t copies, std::uint64_t seed);

/// The same of small ideal fluids, without transitions.
nlohmann::json run_fluid_reversal(const Candidate& candidate, const FluidParameters& fluid,
                                  double time_step, std::size_t replicas, std::uint64_t seed);

}  // namespace driftless::judge
