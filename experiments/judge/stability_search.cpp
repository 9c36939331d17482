#include "experiments/judge/stability_search.hpp"

#include <algorithm>
#include <cmath>

namespace driftless::judge {
namespace {

/// Takes part in a run now and then: ends it if the energy runs away, and averages the last half.
class Watch {
 public:
  Watch(System& system, std::uint64_t steps)
      : steps_(steps),
        every_(std::max<std::uint64_t>(1, steps / 500)),
        energy_(system.total_energy()) {}

  void look(System& system, std::uint64_t step) {
    if (step % every_ != 0 && step != steps_) return;
    const double energy = system.total_energy();
    if (!(std::abs(energy - energy_) <= std::abs(energy_))) {
      throw StepFailure(FailureCause::energy_runaway, {});
    }
    if (2 * step <= steps_) return;
    ++samples_;
    kinetic_ += system.kinetic_energy();
    internal_ += system.internal_energy();
  }

  double kinetic() const { return kinetic_ / static_cast<double>(samples_); }
  double internal() const { return internal_ / static_cast<double>(samples_); }

 private:
  std::uint64_t steps_, every_, samples_ = 0;
  double energy_, kinetic_ = 0, internal_ = 0;
};

}  // namespace

Bracket find_bracket(const std::function<std::string(double)>& failure, const StepRange& range) {
  Bracket bracket;
  const auto stable_at = [&](double step) {
    auto cause = failure(step);
    if (cause.empty()) {
      bracket.stable = step;
      return true;
    }
    bracket.unstable = step;
    bracket.cause = std::move(cause);
    return false;
  };
  double step = range.start;
  if (stable_at(step)) {
    while (step < range.highest) {
      step = std::min(2 * step, range.highest);
      if (!stable_at(step)) break;
    }
  } else {
    while (step > range.lowest) {
      step = std::max(step / 4, range.lowest);
      if (stable_at(step)) break;
    }
  }
  if (bracket.stable == 0 || std::isinf(bracket.unstable)) return bracket;
  while (bracket.unstable > range.factor * bracket.stable) {
    stable_at(std::sqrt(bracket.stable * bracket.unstable));
  }
  return bracket;
}

std::string instability(const Method& method, const Options& options, const StabilityStart& start,
                        double time_step) {
  System system = start.system;
  const auto integrator = method.make(options);
  const auto steps = std::max<std::uint64_t>(
      100, static_cast<std::uint64_t>(std::ceil(start.duration / time_step)));
  Watch watch(system, steps);
  try {
    for (std::uint64_t step = 1; step <= steps; ++step) {
      system.set_step(step);
      integrator->step(system, time_step);
      watch.look(system, step);
    }
  } catch (const StepFailure& failure) {
    return to_string(failure.cause());
  }
  const auto off = [](double value, double exact) {
    return std::abs(value - exact) > tolerated_deviation * exact;
  };
  if (off(watch.internal(), start.internal_energy)) return "wrong internal energy";
  if (off(watch.kinetic(), start.kinetic_energy)) return "wrong kinetic temperature";
  return {};
}

}  // namespace driftless::judge
