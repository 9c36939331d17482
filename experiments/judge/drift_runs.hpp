#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/judge/examination.hpp"

/// Runs of a soft fluid without conduction whose energy drifts, at several steps, frictions and
/// heat capacities.
namespace driftless::judge {

inline constexpr double usual_friction = 4.5, usual_capacity = 60, small_capacity = 6;
inline constexpr double usual_step = 0.05;

/// The runs of one part: where, and at which step.
struct DriftSetting {
  double heat_capacity, friction, time_step;
  /// Of small steps, for methods that heat up too fast for the usual ones.
  bool brief = false;

  std::string name() const;
};

/// Every setting at this depth.
std::vector<DriftSetting> drift_settings(Depth depth);

/// Why a method cannot be run in this fluid; nothing if it can.
std::optional<std::string> drift_refusal(const Method& method);

/// Processor seconds that a setting's runs take, roughly.
double drift_cost(const DriftSetting& setting, Depth depth);

/// How many runs a setting has.
unsigned drift_replicas();

/// Runs a setting: {"failures": [cause, ...]} and, unless over a quarter of the runs broke, of
/// those that ended {"drift", "error", "walk": [value, lower, upper]} in kT per particle and unit
/// of time, and the theory's drift {"kick_move_kick", "move_kick_move"} (see drift_prediction.hpp).
nlohmann::json run_drift(const Candidate& candidate, const Conditions& conditions,
                         const DriftSetting& setting);

/// A measured drift with what is known of its setting.
struct MeasuredDrift {
  DriftSetting setting;
  double drift, error, walk, walk_lower, walk_upper, kick_move_kick, move_kick_move;

  double certainty() const { return drift / error; }
};

/// Of every setting whose record has a drift.
std::vector<MeasuredDrift> measured_drifts(Depth depth, const Records& records);

}  // namespace driftless::judge
