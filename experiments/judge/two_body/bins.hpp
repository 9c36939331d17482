#pragma once

#include <cstdint>
#include <vector>

#include "experiments/judge/two_body/bench.hpp"

namespace driftless::two_body {

/// A grid over the phase space of a pair at its present energy e: v (mu/2e)^(1/2) in [-1, 1] and
/// u_i/(u_i + u_j) in [0, 1], independent of each other in the exact law. Bins are a third of the
/// law's width in either direction.
class PairBins {
 public:
  /// `shape` is a = phi/k + 1.
  explicit PairBins(double shape);

  std::size_t size() const { return log_mass_.size(); }
  /// The bin of a pair whose energies are not negative.
  std::uint16_t bin(const PairView& pair) const;
  /// ln of every bin's share of the exact law.
  const std::vector<double>& log_mass() const { return log_mass_; }

 private:
  int velocities_, shares_;  ///< number of bins in either direction, even
  std::vector<double> log_mass_;
};

}  // namespace driftless::two_body
