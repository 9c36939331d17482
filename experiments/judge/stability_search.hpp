#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "experiments/judge/stability_scene.hpp"
#include "integrators/integrator.hpp"

/// The largest stable step of a method, by bisection.
namespace driftless::judge {

/// Steps that are tried: from `lowest` to `highest`, beginning at `start`, until the largest stable
/// and the smallest unstable one are within `factor`.
struct StepRange {
  double lowest, start, highest, factor;
};

/// What a search has found. The largest stable step is 0 if none is, the smallest unstable one
/// infinite if none is.
struct Bracket {
  double stable = 0;
  double unstable = std::numeric_limits<double>::infinity();
  std::string cause;  ///< of what happens at `unstable`
};

/// Finds where a run begins to fail: failure(step) is empty if it does not. Goes up from `start` by
/// factors of two as long as runs are stable, else down by factors of four, then bisects the
/// logarithm: a stable step beyond an unstable one does not count.
Bracket find_bracket(const std::function<std::string(double)>& failure, const StepRange& range);

/// How far temperatures may be off at the end of a stable run.
inline constexpr double tolerated_deviation = 0.2;

/// Why the run of a method from a start is not stable, empty if it is. It lasts 20 collision times,
/// but 100 steps at least, and is stable if no step fails, total energy never changes by as much as
/// it was, and over the last half the kinetic energy and the internal energy have, on average, the
/// values of the exact law to 20 %. Causes: those of StepFailure; "wrong internal energy", the more
/// telling if both are wrong; "wrong kinetic temperature".
std::string instability(const Method& method, const Options& options, const StabilityStart& start,
                        double time_step);

}  // namespace driftless::judge
