#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace driftless {

/// Tells on standard error how far a run is: one line that renews itself on a terminal, a line
/// per finished cell elsewhere. Time left follows from predicted costs. Safe to call from threads.
class Progress {
 public:
  /// `things` is what is counted: "cells".
  Progress(std::string things, std::size_t count, double predicted_cost, bool quiet);
  ~Progress();

  void replica_started();
  void replica_finished(double predicted_cost);
  /// `name` says which cell, `status` its status; all but "ok" and "not_applicable" are counted as
  /// failed.
  void cell_finished(const std::string& name, const std::string& status);
  /// Cells taken over from an earlier run.
  void cells_resumed(std::size_t cells);
  /// A line of its own.
  void say(const std::string& line);

 private:
  void renew(bool always);
  std::string time_left() const;

  std::mutex mutex_;
  std::string things_;
  bool quiet_, terminal_;
  std::size_t cells_, done_ = 0, running_ = 0, failed_ = 0;
  double cost_, cost_done_ = 0;
  std::chrono::steady_clock::time_point start_, shown_;
};

}  // namespace driftless
