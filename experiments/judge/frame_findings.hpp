#pragma once

#include "experiments/judge/moving_frame.hpp"

/// What the records of moving_frame.hpp say in words.
namespace driftless::judge {

/// "1 thermal velocity", "5 thermal velocities".
std::string speed_words(double speed);

/// When internal energies with the same noise are compared; velocities forget theirs within about
/// 0.3.
inline constexpr double changes_after = 0.32;

/// What internal energies and the internal temperature suffer at a speed, at the last and finest of
/// the steps of frame_change().
Finding frame_change_finding(const Method& method, const std::vector<nlohmann::json>& changes,
                             double speed);

/// An observable of frame_averages().
struct FrameAverage {
  const char* key;
  const char* words;
  double tolerance;  ///< of the relative difference
};
const std::vector<FrameAverage>& frame_averages_asked();

/// How much an average differs from that at rest, relative to it, with its standard error: from the
/// differences of runs that have start and noise in common, so that a drift that both have does not
/// count. Nothing if fewer than two came to their ends in both.
struct FrameRatio {
  double difference, error, degrees_of_freedom;
};
std::optional<FrameRatio> frame_ratio(const FrameAverage& average, const nlohmann::json& rest,
                                      const nlohmann::json& moving);

/// The same in words.
Finding frame_average_finding(const Method& method, const FrameAverage& average,
                              const nlohmann::json& rest, const nlohmann::json& moving);

}  // namespace driftless::judge
