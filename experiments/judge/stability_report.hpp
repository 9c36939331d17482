#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/judge/stability_scene.hpp"

/// What is said of the largest stable steps that were found.
namespace driftless::judge {

/// What the seeds of a point say together.
struct Threshold {
  StabilityPoint point;
  double all_stable;                   ///< largest step at which all seeds survive; 0 if none
  std::optional<double> all_unstable;  ///< smallest at which all fail, where it was reached
  std::optional<double> typical;       ///< geometric mean of the seeds' thresholds
  std::string cause;                   ///< the most frequent one
  double shortest;                     ///< smallest step tried

  bool none() const { return all_stable == 0; }
};

/// From the record of a point: an array, per seed, of `stable`, `unstable` (left out if every step
/// is stable) and `cause`.
Threshold threshold(const StabilityPoint& point, double shortest, const nlohmann::json& record);

/// The quantities that differ from the base: "density = 10"; "base" if none does.
std::string name_of(const StabilityPoint& point);

Finding base_finding(const Threshold& found, FrictionClosure closure);

/// Adds an axis's findings and its chart; thresholds in the axis's order.
void conclude_axis(const StabilityAxis& axis, const std::vector<Threshold>& found,
                   Conclusion& conclusion);

/// A curve against one axis for each value of the other.
Chart map_chart(const StabilityAxis& axis, const StabilityAxis& other,
                const std::vector<std::vector<Threshold>>& curves);

/// Every point with its steps, causes and estimates.
Table threshold_table(const std::vector<Threshold>& found);

}  // namespace driftless::judge
