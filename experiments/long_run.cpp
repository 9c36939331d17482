#include "experiments/long_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "experiments/checkpoint.hpp"
#include "experiments/location.hpp"

namespace driftless {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t most_ids_named = 5;

std::string failure_text(const StepFailure& failure, std::uint64_t step, double time) {
  std::string text =
      fmt::format("{} in step {} (time {:.6g})", to_string(failure.cause()), step, time);
  const auto& ids = failure.ids();
  for (std::size_t i = 0; i < std::min(ids.size(), most_ids_named); ++i) {
    text += fmt::format("{}{}", i == 0 ? ", particles " : ", ", ids[i]);
  }
  return text + (ids.size() > most_ids_named ? " and others" : "");
}

Counters sum(const Counters& a, const Counters& b) {
  return {a.pair_evaluations + b.pair_evaluations, a.random_numbers + b.random_numbers,
          a.solver_iterations + b.solver_iterations};
}

Counters difference(const Counters& a, const Counters& b) {
  return {a.pair_evaluations - b.pair_evaluations, a.random_numbers - b.random_numbers,
          a.solver_iterations - b.solver_iterations};
}

json identity_of(const LongRunPlan& plan, const std::vector<Observation>& observations) {
  json identity = plan.identity;
  identity["time_step"] = plan.time_step;
  identity["first_step"] = plan.first;
  // In words: where two runs differ a person is told the path.
  for (const auto& observation : observations) {
    identity[observation.name] = {{"steps between samples", observation.every},
                                  {"steps before the first sample", observation.from},
                                  {"settings", observation.observer->settings()}};
  }
  return identity;
}

/// The checkpoint to go on from; nothing if there is none.
std::optional<Checkpoint> find_checkpoint(const LongRunPlan& plan, const json& identity,
                                          const std::filesystem::path& path) {
  if (path.empty()) return std::nullopt;
  auto kept = read_checkpoint(path, identity);
  if (kept && kept->step > plan.last) {
    Location(path.string())
        .refuse(fmt::format("is the checkpoint after step {} (time {:.12g}), beyond the end of "
                            "this run after step {} (time {:.12g}); allowed is a later end, or "
                            "another file",
                            kept->step, static_cast<double>(kept->step) * plan.time_step, plan.last,
                            static_cast<double>(plan.last) * plan.time_step));
  }
  return kept;
}

/// One run with what it has to keep.
class Run {
 public:
  Run(System& system, Integrator& integrator, const LongRunPlan& plan,
      const std::vector<Observation>& observations, const std::filesystem::path& path)
      : system_(system),
        integrator_(integrator),
        plan_(plan),
        observations_(observations),
        path_(path),
        identity_(identity_of(plan, observations)),
        step_(plan.first),
        counted_from_(system.counters()) {}

  /// Takes up the checkpoint, if there is one, or looks at the start.
  void begin() {
    auto kept = find_checkpoint(plan_, identity_, path_);
    if (kept) {
      take_up(std::move(*kept));
    } else {
      observe();
    }
    if (plan_.progress) plan_.progress->begin(step_, plan_.last);
    if (plan_.progress && kept) plan_.progress->checkpoint_written(step_);
    begun_at_ = kept_at_ = Clock::now();
    written_ = kept.has_value();
  }

  void advance() {
    while (step_ < plan_.last) {
      do_step();
      observe();
      written_ = false;
      if (plan_.progress) plan_.progress->reached(step_);
      // Who interrupts a young run loses no more of it than a few seconds, or a third.
      const std::chrono::duration<double> since = Clock::now() - kept_at_,
                                          before = kept_at_ - begun_at_;
      if (since.count() >= std::min(plan_.checkpoint_every, 5 + before.count() / 2)) keep();
    }
    if (!written_) keep();
  }

  std::uint64_t step() const { return step_; }
  Counters counters() const {
    return sum(counted_before_, difference(system_.counters(), counted_from_));
  }

 private:
  void do_step() {
    const std::uint64_t next = step_ + 1;
    begin_step(system_, integrator_, next);
    try {
      integrator_.step(system_, plan_.time_step);
    } catch (const StepFailure& failure) {
      throw LongRunFailure(failure, next, static_cast<double>(next) * plan_.time_step);
    }
    step_ = next;
  }

  void observe() {
    for (const auto& observation : observations_) {
      if (step_ < observation.from || (step_ - observation.from) % observation.every != 0) continue;
      observation.observer->sample(system_, step_);
    }
  }

  void take_up(Checkpoint kept) {
    system_.set_state(std::move(kept.state));
    integrator_.load(kept.integrator);
    for (const auto& observation : observations_) {
      observation.observer->load(kept.observers.at(observation.name));
    }
    step_ = kept.step;
    counted_before_ = kept.counters;
  }

  void keep() {
    if (!path_.empty()) {
      Checkpoint checkpoint{identity_,          step_,      system_.state(),
                            integrator_.save(), counters(), json::object()};
      for (const auto& observation : observations_) {
        checkpoint.observers[observation.name] = observation.observer->save();
      }
      write_checkpoint(path_, checkpoint);
      if (plan_.progress) plan_.progress->checkpoint_written(step_);
    }
    written_ = true;
    kept_at_ = Clock::now();
  }

  System& system_;
  Integrator& integrator_;
  const LongRunPlan& plan_;
  const std::vector<Observation>& observations_;
  const std::filesystem::path& path_;
  json identity_;
  std::uint64_t step_;
  Counters counted_from_, counted_before_;
  Clock::time_point begun_at_, kept_at_;
  bool written_ = false;
};

}  // namespace

LongRunFailure::LongRunFailure(const StepFailure& failure, std::uint64_t step, double time)
    : std::runtime_error(failure_text(failure, step, time)),
      cause_(failure.cause()),
      step_(step),
      time_(time) {}

LongRunEnd long_run(System& system, Integrator& integrator, const LongRunPlan& plan,
                    const std::vector<Observation>& observations,
                    const std::filesystem::path& checkpoint, unsigned threads) {
  system.set_threads(threads);
  Run run(system, integrator, plan, observations, checkpoint);
  run.begin();
  LongRunEnd end;
  end.resumed_after = run.step();
  run.advance();
  end.counters = run.counters();
  return end;
}

void check_checkpoint(const LongRunPlan& plan, const std::vector<Observation>& observations,
                      const std::filesystem::path& checkpoint) {
  find_checkpoint(plan, identity_of(plan, observations), checkpoint);
}

}  // namespace driftless
