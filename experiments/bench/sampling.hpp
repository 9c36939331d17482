#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace driftless {

/// Median and quartiles of samples.
struct Spread {
  double median = 0, lower = 0, upper = 0;
  std::size_t samples = 0;
};
/// Throws std::invalid_argument if there is no sample.
Spread spread(std::vector<double> samples);

/// How much is measured of every contestant.
struct Sampling {
  unsigned samples = 15;  ///< fewer, but at least 3, where they would last longer than `most`
  double seconds = 0.05;  ///< least duration of a sample
  std::uint64_t least_steps = 3;  ///< least number of steps in a sample
  double most = 8;                ///< seconds of all samples of one contestant
};

/// Something that is stepped and timed.
struct Contestant {
  std::function<void()> step;
  std::size_t particles;
};

/// What was measured of a contestant.
struct Measured {
  Spread nanoseconds;  ///< per particle and step, by the clock on the wall; no samples if it failed
  std::string failure;  ///< why it could not be stepped; empty if it could
};

/// Times all contestants in turns, sample by sample, so that a machine that others use, or that
/// changes its pace, hurts them alike. A contestant whose step throws StepFailure takes part no
/// more.
std::vector<Measured> time_in_turns(const std::vector<Contestant>& contestants,
                                    const Sampling& sampling);

}  // namespace driftless
