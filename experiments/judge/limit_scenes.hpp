#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/judge/examination.hpp"
#include "model/fluid.hpp"

/// The systems whose equilibrium is known, and what methods make of them.
namespace driftless::judge {

/// Scenes that are shown together.
enum class Family { pairs, conducting, not_conducting, soft };

/// What is known of an observable of a scene.
struct LimitObservable {
  std::string name, words;  ///< "internal_energy_variance", "the variance of u"
  /// A resolution beyond it is no answer: at depth full and at depth quick.
  double tolerance = 0, quick_tolerance = 0;
  bool is_square = false;   ///< of a distance, and without bias
  bool is_relative = true;  ///< a share of the exact value; else a number of its own
};

/// A system with a known equilibrium, and the runs that a method is given in it. Every method gets
/// the same starts and the same noise; no two time steps share either.
///
/// Record of a run: {"runs", "failed", "failure": {"cause", "step", "time"} of the first that
/// failed, "observables": {name: {"value", "error", "degrees_of_freedom", "reference_error"}}}, the
/// value as deviation from the exact one, errors as standard errors.
struct LimitScene {
  Family family;
  std::string name;
  Fluid fluid;
  std::vector<double> time_steps;    ///< falling, in program units
  unsigned blocks = 1;               ///< of equally long runs at each step
  double cost_per_inverse_step = 0;  ///< predicted seconds of a block, times the time step
  /// `number` below time_steps.size() * blocks keys starts and noise.
  std::function<nlohmann::json(const Candidate&, double time_step, unsigned number)> run;
  /// Processor seconds per unit of simulated time, for every time step; 0 where none can be done.
  std::function<std::vector<double>(const Candidate&)> seconds_per_time = {};
};

/// The parts that limit_scenes puts together.
std::vector<LimitScene> pair_limit_scenes(const Conditions& conditions);
std::vector<LimitScene> fluid_limit_scenes(const Conditions& conditions);

/// Isolated pairs, the isolated ideal fluid with and without conduction, and a soft fluid, at heat
/// capacities phi/k of 100, 20 and 5 with both friction closures.
std::vector<LimitScene> limit_scenes(const Conditions& conditions);

/// Every observable that a scene of the family may have, in the order of reports.
const std::vector<LimitObservable>& limit_observables(Family family);

/// "isolated pairs", "ideal fluid", ...
std::string to_string(Family family);

}  // namespace driftless::judge
