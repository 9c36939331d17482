#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/reproduce/experiment.hpp"
#include "experiments/scene.hpp"

/// Runs of an isolated fluid at steps that may be too large: kinetic and internal temperature over
/// time and the radial distribution, until the end or a failure.
namespace driftless::reproduce {

struct TemperatureRuns {
  Scene scene;
  unsigned replicas;
  double duration;
};

/// From here on averages are taken: kinetic energies and structure have followed the step.
inline constexpr double kinetic_end = 10;
/// Replicas that fail sooner than this leave too little to average.
inline constexpr double least_duration = 20;
/// Pairs closer than this, in the unit of length, count as overlaps.
inline constexpr double core = 0.2;
/// Of a bin of the radial distribution.
inline constexpr double distance_bin = 0.025;

/// One replica, from the exact law: {"times", "kinetic", "inverse": <1/theta>, "g": counts over
/// those of an ideal gas, by bins, "core": the same of all distances below `core`}, and a "failure"
/// in words if one ended it; then without "g" and "core" if it came before `kinetic_end`.
nlohmann::json run_temperatures(const TemperatureRuns& runs, const MethodChoice& method,
                                double step, unsigned replica, std::uint64_t seed);

/// The replicas of a method at a step.
class TemperatureCell {
 public:
  explicit TemperatureCell(std::vector<nlohmann::json> replicas);

  /// Whether all replicas came to `least_duration`. The rest needs it.
  bool ran() const { return ran_; }
  /// "3 of 6 replicas ended early, first: negative internal energy at t = 47.1", or empty.
  std::string failures() const;
  /// T_kin/T_int from `kinetic_end` on.
  Interval ratio() const;
  /// A number of every replica: mean, with the interval that their scatter gives.
  Interval across(const std::function<double(const nlohmann::json&)>& number) const;
  /// g(r) of a bin, and of all distances below `core`.
  Interval g(std::size_t bin) const;
  Interval overlaps() const;
  std::size_t bins() const { return replicas_.front()["g"].size(); }
  /// Times that every replica has reached.
  std::vector<double> times() const;
  /// Kinetic or internal temperature at the n-th of them.
  double kinetic(std::size_t n) const;
  double internal(std::size_t n) const;

 private:
  std::vector<nlohmann::json> replicas_;
  bool ran_ = true;
};

}  // namespace driftless::reproduce
