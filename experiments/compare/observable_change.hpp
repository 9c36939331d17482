#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "experiments/compare/common_cells.hpp"
#include "experiments/compare/difference.hpp"

namespace driftless {

/// How far an observable of a cell moved from BASE to NEW.
struct ObservableChange {
  Difference difference;         ///< in the observable's unit
  double base = 0, changed = 0;  ///< measured, or deviations where scenes differ in their energy
  double scale = 1;              ///< an effect is size/scale, or root(size/scale) of squares
  bool is_square = false;
  bool is_share = true;  ///< whether effects are shares of a value; else numbers of their own
  /// NEW's size of the error less BASE's; nothing where nothing is known to be right.
  std::optional<double> growth;

  /// What a difference of so much in the observable's unit is as an effect (see compare.hpp).
  double effect_of(double size) const;
  double effect() const;
  /// BASE's own number as an effect.
  double base_effect() const;
  /// What of it may grow or shrink: "deviation" or "size".
  const char* grows() const;
};

/// What drifts and walks add up to.
struct Run {
  double measured_time = 0;  ///< simulated
  double particles = 1;
};

/// Nothing where the observable cannot be compared: not measured in both, or without a reference
/// value in scenes of different energies.
std::optional<ObservableChange> observable_change(const std::string& observable,
                                                  const CommonCell& cell, const Run& run);

/// Whether something that is conserved is: the verdict "better" or "worse" where one result keeps
/// it to rounding and the other does not, "same" where both keep it; nothing where neither does,
/// or where it is none of momentum_error, energy_drift and energy_walk.
std::optional<std::string> conservation_verdict(const std::string& observable,
                                                const CommonCell& cell, const Run& run);

}  // namespace driftless
