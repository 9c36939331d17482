#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/energy_drift.hpp"

namespace driftless {

/// The cosine modes of one energy trace (see `energy_drift`), slowest first.
struct DriftModes {
  Eigen::ArrayXd amplitude;          ///< of the trace, in energy
  Eigen::ArrayXd line;               ///< of a line of slope 1, in time
  Eigen::ArrayXd walk;               ///< variance of a walk of strength 1, in time
  Eigen::ArrayXd squared_frequency;  ///< (2 sin(pi j/2n))^2, per squared time spacing
};

/// The modes' variance: walk * DriftModes::walk + fluctuation / (1 + slowness * squared_frequency).
struct DriftVariance {
  double walk = 0.0;         ///< energy^2 per time
  double fluctuation = 0.0;  ///< energy^2
  double slowness = 0.0;     ///< of the fluctuation: squared inverse corner frequency, 0 if fast
};

/// Generalised least squares of the slope under a known variance.
struct SlopeFit {
  double slope = 0.0;
  double information = 0.0;    ///< inverse squared standard error
  double residual = 0.0;       ///< sum of squared residuals over variances
  double log_variances = 0.0;  ///< sum of their logarithms
  double count = 0.0;          ///< modes
};

struct DriftFit {
  DriftVariance best;  ///< where the restricted likelihood is largest
  double slope = 0.0;
  double slope_error = 0.0;               ///< widened for its degrees of freedom
  double slope_degrees_of_freedom = 1.0;  ///< of slope_error's square
  WalkStrength walk;
  double degrees_of_freedom = 0.0;  ///< modes less the slope
  bool deterministic = false;       ///< nothing is left beside the line: all errors are zero
};

SlopeFit fit_slope(const std::vector<DriftModes>& replicas, const DriftVariance& variance);

/// Maximises the restricted likelihood, and averages over it for the slope's error. All replicas
/// must have the same time spacing, and there must be at least one mode in all.
DriftFit fit_drift(const std::vector<DriftModes>& replicas);

}  // namespace driftless
