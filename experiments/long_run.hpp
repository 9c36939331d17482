#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/step_progress.hpp"
#include "integrators/integrator.hpp"

namespace driftless {

/// What looks at a system while it runs and accumulates what it sees.
class Observer {
 public:
  virtual ~Observer() = default;

  /// Looks at the system as it is after `step` steps; leaves it as it is.
  virtual void sample(System& system, std::uint64_t step) = 0;
  /// What distinguishes it from others of its kind: a checkpoint of other settings is refused.
  virtual nlohmann::json settings() const { return nlohmann::json::object(); }
  /// All that it has accumulated. What it writes to a file of its own has been written by then.
  virtual nlohmann::json save() = 0;
  /// Goes on from there. Throws InputError if a file of its own does not fit.
  virtual void load(const nlohmann::json& saved) = 0;
};

/// An observer and when it looks: after the steps from, from + every, ...
struct Observation {
  std::string name;  ///< in the checkpoint; unique in a run
  Observer* observer;
  std::uint64_t every = 1;
  std::uint64_t from = 0;
};

struct LongRunPlan {
  nlohmann::json identity;  ///< what makes it this run: scene, method, time step and seed
  double time_step = 0;
  std::uint64_t first = 0;           ///< steps that the system has done
  std::uint64_t last = 0;            ///< and has done at the end
  double checkpoint_every = 60;      ///< seconds of wall time at most; sooner in a young run
  StepProgress* progress = nullptr;  ///< told where the run is, if there is one
};

struct LongRunEnd {
  std::uint64_t resumed_after = 0;  ///< the step of the checkpoint that it went on from, or `first`
  Counters counters;                ///< of the whole run; a restart computes the forces once more
};

/// A step that could not be completed; the message names cause, step, time and particles.
class LongRunFailure : public std::runtime_error {
 public:
  LongRunFailure(const StepFailure& failure, std::uint64_t step, double time);
  FailureCause cause() const { return cause_; }
  std::uint64_t step() const { return step_; }
  double time() const { return time_; }

 private:
  FailureCause cause_;
  std::uint64_t step_;
  double time_;
};

/// Steps a system that has done `plan.first` steps until it has done `plan.last`, step n with the
/// noise of step n, and has observers look at it, the start included. State and observers are a
/// pure function of these, to the last bit: for any number of threads, and however often the run
/// was broken off, as long as `checkpoint` names the same file. That is written now and then and at
/// the end, and taken up where it exists; later ends go on from it. An empty path: no checkpoint.
///
/// Throws LongRunFailure; InputError if the checkpoint is of another run, lies beyond the end, or
/// cannot be written, or an observer's file.
LongRunEnd long_run(System& system, Integrator& integrator, const LongRunPlan& plan,
                    const std::vector<Observation>& observations,
                    const std::filesystem::path& checkpoint, unsigned threads);

/// Throws what long_run() would throw about a checkpoint before it does anything.
void check_checkpoint(const LongRunPlan& plan, const std::vector<Observation>& observations,
                      const std::filesystem::path& checkpoint);

}  // namespace driftless
