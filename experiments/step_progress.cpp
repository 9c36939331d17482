#include "experiments/step_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace driftless {

StepProgress::StepProgress(double time_step, bool quiet)
    : time_step_(time_step), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

StepProgress::~StepProgress() {
  if (!quiet_ && terminal_) fmt::print(stderr, "\r\033[K");
}

void StepProgress::begin(std::uint64_t done, std::uint64_t steps) {
  first_ = done;
  last_ = steps;
  step_ = done;
  tenth_ = steps == 0 ? 0 : 10 * done / steps;
  start_ = shown_ = std::chrono::steady_clock::now();
  if (quiet_ || done == 0 || done == steps) return;
  fmt::print(stderr, "{}goes on from the checkpoint after step {} of {}\n",
             terminal_ ? "\r\033[K" : "", done, steps);
}

void StepProgress::reached(std::uint64_t step) {
  step_ = step;
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  const std::uint64_t tenth = 10 * step / last_;
  if (terminal_ ? now - shown_ < std::chrono::milliseconds(250) : tenth == tenth_) return;
  tenth_ = tenth;
  show(step, now);
}

void StepProgress::show(std::uint64_t step, std::chrono::steady_clock::time_point now) {
  shown_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double each = elapsed / static_cast<double>(step - first_);
  const auto left = static_cast<long>(each * static_cast<double>(last_ - step));
  fmt::print(stderr, "{}step {} of {}, time {:.6g}, {:.3g} ms a step, about {}:{:02} left{}",
             terminal_ ? "\r\033[K" : "", step, last_, static_cast<double>(step) * time_step_,
             1e3 * each, left / 60, left % 60, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

std::string StepProgress::interruption() const {
  const std::uint64_t step = step_;
  const std::int64_t kept = kept_;
  if (kept < 0) return fmt::format("interrupted after step {}; there is no checkpoint yet", step);
  return fmt::format(
      "interrupted after step {}; the same command run again goes on from the checkpoint after "
      "step {}",
      step, kept);
}

}  // namespace driftless
