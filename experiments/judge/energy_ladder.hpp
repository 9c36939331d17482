#pragma once

#include "experiments/judge/isolated_runs.hpp"

/// How the total energy of an isolated fluid drifts and walks, at several steps, and how often
/// internal energies run out.
namespace driftless::judge {

/// Runs of one scene at one step: {"time_step", "duration", "largest_change" of total energy
/// relative to its start, and what failures_record() says}. If at least two runs came to their end
/// and energy is not kept to rounding, also "drift" {"value", "error"}, in kT per particle and unit
/// time, and "walk" {"value", "error"}, in (kT)^2 per particle and unit time; 1.96 errors make an
/// interval of 95 %. The first half a unit of time is left out of these.
nlohmann::json energy_rung(const Candidate& candidate, const PreparedScene& scene, unsigned runs,
                           double time_step, double duration);

/// What a scene's rungs, from the coarsest to the finest, say of total energy: that it is kept, or
/// the orders of drift and walk in the step. `name` is the scene's in sentences.
std::vector<Finding> energy_findings(const std::string& name,
                                     const std::vector<nlohmann::json>& rungs);

/// The share of runs in which an internal energy ran out, or which failed otherwise.
Finding positivity_finding(const std::string& name, const std::vector<nlohmann::json>& rungs);

/// The interval of 95 % of a share of which so many of so many were seen (Clopper and Pearson,
/// Biometrika 26, 404 (1934)).
struct ShareInterval {
  double lower = 0, upper = 1;
};
ShareInterval share_interval(unsigned seen, unsigned of);

}  // namespace driftless::judge
