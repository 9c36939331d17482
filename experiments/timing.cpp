#include "experiments/timing.hpp"

#include <time.h>

#include <algorithm>
#include <memory>

namespace driftless {
namespace {

constexpr int rounds = 7;
constexpr double slice = 0.012;  // seconds of a cell in a round

double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A running system that starts anew where it fails.
class Runner {
 public:
  explicit Runner(const TimedCell& cell) : cell_(cell) { restart(); }

  /// Seconds per step over `steps` steps; 0 if one failed.
  double time(std::uint64_t steps) {
    const double start = processor_seconds();
    try {
      for (std::uint64_t n = 0; n < steps; ++n) {
        begin_step(*system_, *integrator_, ++step_);
        integrator_->step(*system_, cell_.time_step);
      }
    } catch (const StepFailure&) {
      restart();
      return 0;
    }
    return (processor_seconds() - start) / static_cast<double>(steps);
  }

 private:
  void restart() {
    system_ = std::make_unique<System>(cell_.prepared->start(0));
    integrator_ = find_method(cell_.choice->name)->make(cell_.choice->options);
    step_ = 0;
  }

  TimedCell cell_;
  std::unique_ptr<System> system_;
  std::unique_ptr<Integrator> integrator_;
  std::uint64_t step_ = 0;
};

double quantile(std::vector<double> sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

}  // namespace

std::vector<StepCost> time_cells(const std::vector<TimedCell>& cells) {
  std::vector<Runner> runners;
  std::vector<std::uint64_t> steps;
  for (const auto& cell : cells) {
    auto& runner = runners.emplace_back(cell);
    runner.time(1);  // caches and the first evaluation are not what a long run pays
    const double once = runner.time(2);
    steps.push_back(once > 0 ? std::max<std::uint64_t>(2, static_cast<std::uint64_t>(slice / once))
                             : 2);
  }
  std::vector<std::vector<double>> measured(cells.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t n = 0; n < cells.size(); ++n) {
      if (const double seconds = runners[n].time(steps[n]); seconds > 0) {
        measured[n].push_back(seconds);
      }
    }
  }
  std::vector<StepCost> costs(cells.size());
  for (std::size_t n = 0; n < cells.size(); ++n) {
    auto& values = measured[n];
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    costs[n] = {quantile(values, 0.5), 0.5 * (quantile(values, 0.75) - quantile(values, 0.25))};
  }
  return costs;
}

}  // namespace driftless
