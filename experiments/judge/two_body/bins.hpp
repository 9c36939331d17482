#pragma once

#include <cstdint>
#include <vector>

#include "experiments/judge/two_body/bench.hpp"

namespace driftless::two_body {

/// A grid over the phase space of a pair. At its present energy e: v (mu/2e)^(1/2) in [-1, 1] and
/// u_i/(u_i + u_j) in [0, 1], independent of each other in the exact law. Of an isothermal pair:
/// v alone, up to 8 thermal speeds, the last bins taking what is beyond. Bins are a third of the
/// law's width in either direction.
class PairBins {
 public:
  explicit PairBins(const Bench& bench);

  std::size_t size() const { return log_mass_.size(); }
  /// The bin of a pair whose energies are not negative.
  std::uint16_t bin(const PairView& pair) const;
  /// ln of every bin's share of the exact law.
  const std::vector<double>& log_mass() const { return log_mass_; }

 private:
  double thermal_speed_ = 0;         ///< of an isothermal pair's relative velocity, else 0
  int velocities_ = 0, shares_ = 1;  ///< number of bins in either direction, even if several
  std::vector<double> log_mass_;
};

}  // namespace driftless::two_body
