#include "experiments/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace driftless {

Progress::Progress(std::string things, std::size_t count, double predicted_cost, bool quiet)
    : things_(std::move(things)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      cells_(count),
      cost_(predicted_cost),
      start_(std::chrono::steady_clock::now()),
      shown_(start_) {}

Progress::~Progress() {
  if (!quiet_ && terminal_) fmt::print(stderr, "\r\033[K");
}

std::string Progress::time_left() const {
  if (cost_done_ <= 0) return "";
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const auto seconds = static_cast<long>(elapsed.count() * (cost_ - cost_done_) / cost_done_);
  return fmt::format(", about {}:{:02} left", seconds / 60, seconds % 60);
}

void Progress::renew(bool always) {
  if (quiet_ || !terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!always && now - shown_ < std::chrono::milliseconds(250)) return;
  shown_ = now;
  fmt::print(stderr, "\r\033[K{} {} of {} done, {} runs under way{}{}", things_, done_, cells_,
             running_, failed_ == 0 ? "" : fmt::format(", {} failed", failed_), time_left());
  std::fflush(stderr);
}

void Progress::replica_started() {
  const std::lock_guard lock(mutex_);
  ++running_;
  renew(false);
}

void Progress::replica_finished(double predicted_cost) {
  const std::lock_guard lock(mutex_);
  --running_;
  cost_done_ += predicted_cost;
  renew(false);
}

void Progress::cell_finished(const std::string& name, const std::string& status) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (status != "ok" && status != "not_applicable") ++failed_;
  if (!quiet_ && !terminal_) {
    fmt::print(stderr, "[{}/{}{}] {}: {}\n", done_, cells_, time_left(), name, status);
  }
  renew(true);
}

void Progress::cells_resumed(std::size_t cells) {
  if (cells == 0) return;
  done_ += cells;
  say(fmt::format("{} of {} {} are finished already", cells, cells_, things_));
}

void Progress::say(const std::string& line) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  fmt::print(stderr, "{}{}\n", terminal_ ? "\r\033[K" : "", line);
}

}  // namespace driftless
