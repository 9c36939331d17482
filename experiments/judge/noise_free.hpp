#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/judge/examination.hpp"
#include "experiments/judge/small_system.hpp"
#include "integrators/reference.hpp"

/// A method in the limit k -> 0, where the model is a set of ordinary differential equations,
/// against the reference solution of these.
namespace driftless::judge {

inline constexpr double noise_free_duration = 0.5;

/// What is compared at the end: largest difference over particles and components of positions,
/// velocities and internal energies; absolute difference of total energy, kinetic energy and
/// internal temperature 1/<1/theta>. Orders are of `norm`, the root mean square over particles of
/// the differences of positions, velocities and temperatures together.
enum class Difference {
  position,
  velocity,
  internal_energy,
  total_energy,
  kinetic_energy,
  internal_temperature,
  norm
};
inline constexpr std::array<std::string_view, 7> difference_names = {
    "positions",    "velocities",     "internal energies",
    "total energy", "kinetic energy", "internal temperature",
    "norm"};
using Differences = std::array<double, difference_names.size()>;

/// How often and how finely a case is run.
struct NoiseFreePlan {
  unsigned starts = 20;
  std::vector<int> steps = {200, 400, 800, 1600};  ///< of the duration, each twice the one before
  std::uint64_t seed = 1;
};
NoiseFreePlan noise_free_plan(const Conditions& conditions);

/// The reference of small_state(seed) after the duration, solved once in a process.
const State& noise_free_reference(const Terms& terms, std::uint64_t seed);

/// Every closure and heat form, first without a potential, then with one.
const std::vector<Terms>& noise_free_cases();

/// Runs one case from every start at every step. The record holds, per start, the differences at
/// every number of steps and those extrapolated to the step zero from every two steps that follow
/// each other; or `failure`, why and where a run broke.
nlohmann::json noise_free_record(const Method& method, const Options& options, const Terms& terms,
                                 const NoiseFreePlan& plan);

/// A number averaged over starts, with its standard error.
struct Averaged {
  double mean = 0, error = 0;
  unsigned starts = 0;
  double half_width() const;  ///< of the 95 % interval
  double certain() const;     ///< half width of the interval that is left in 6 of 10^7 cases
};

/// The differences at the runs of so many steps, by the place in the plan.
Averaged noise_free_difference(const nlohmann::json& record, Difference which, std::size_t place);
/// The same extrapolated to the step zero from the two finest steps.
Averaged noise_free_limit(const nlohmann::json& record, Difference which);
/// Least-squares slope of log difference against log step, one of each start. No starts if the
/// differences are of rounding or of the reference's own error.
Averaged noise_free_order(const nlohmann::json& record, Difference which);
/// The same of the extrapolated differences: they vanish at least to the second order where a
/// method converges, and stay what they are where it tends to something else.
Averaged noise_free_limit_order(const nlohmann::json& record, Difference which);

/// What the records of a method's cases, by Terms::name(), say; `plan` as they were made.
Conclusion conclude_noise_free(const Method& method, const Options& options,
                               const NoiseFreePlan& plan, const Records& records);

}  // namespace driftless::judge
