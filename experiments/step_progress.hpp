#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace driftless {

/// Tells on standard error how far one long run is: a line that renews itself on a terminal, a line
/// per tenth of the run elsewhere. `interruption` may be called from any thread.
class StepProgress {
 public:
  StepProgress(double time_step, bool quiet);
  ~StepProgress();

  /// The run starts, or goes on, after `done` of `steps` steps.
  void begin(std::uint64_t done, std::uint64_t steps);
  void reached(std::uint64_t step);
  void checkpoint_written(std::uint64_t step) { kept_ = static_cast<std::int64_t>(step); }

  /// What is lost and kept if the run is broken off now, in one sentence.
  std::string interruption() const;

 private:
  void show(std::uint64_t step, std::chrono::steady_clock::time_point now);

  double time_step_;
  bool quiet_, terminal_;
  std::uint64_t first_ = 0, last_ = 0, tenth_ = 0;
  std::atomic<std::uint64_t> step_ = 0;
  std::atomic<std::int64_t> kept_ = -1;  ///< the step of the last checkpoint, or none
  std::chrono::steady_clock::time_point start_, shown_;
};

}  // namespace driftless
