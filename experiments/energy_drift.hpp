#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/statistics.hpp"

namespace driftless {

/// Energy of one replica over time.
struct EnergyTrace {
  Eigen::VectorXd times;     ///< equally spaced, rising
  Eigen::VectorXd energies;  ///< as many, in any one unit
};

/// What a random walk adds to the variance of the energy per unit time.
struct WalkStrength {
  double value = 0.0;  ///< D = d Var(E)/dt, in energy^2 per time, at the likelihood's maximum
  double error = 0.0;  ///< the 95 % interval's width over 3.92: about one sigma
  double lower = 0.0;  ///< 95 % interval; 0 if no walk can be told from the bounded fluctuation
  double upper = 0.0;
  /// Independent increments that the strength rests on: those (cosine modes) where the walk, not
  /// the bounded fluctuation, dominates. 0 if there is no walk.
  double effective_increments = 0.0;
};

struct EnergyDrift {
  /// Systematic drift dE/dt, in energy per time; effective samples are the cosine modes used.
  Estimate slope;
  WalkStrength walk;         ///< random walk
  double fluctuation = 0.0;  ///< standard deviation of the bounded fluctuation, in energy; rough
};

/// Tells apart, in E(t) = E0 + slope t + random walk + bounded stationary fluctuation, the three
/// ways in which an integrator fails to conserve energy.
///
/// In the cosine modes of a trace of n points with spacing dt,
///   c_j = sqrt(2/n) sum_k E_k cos(pi j (k + 1/2)/n),   j = 1, 2, ...,
/// a walk has the variance D dt / (2 sin(pi j/2n))^2, exactly and independently for all j; a fast
/// fluctuation has the same variance in all; a slower one falls off beyond its own frequency; and
/// the slope is a known pattern. That is Var(E(t+s) - E(t)) = D s + 2 sigma^2 compared over all
/// lags at once. The 64 slowest modes of every replica enter a restricted likelihood over the
/// slope, D, and the fluctuation's strength and corner frequency:
/// - The slope is its generalised least squares value: the mean of (E_end - E_start)/T for a pure
///   walk, ordinary regression for a pure fast fluctuation, the best of both between. Its error
///   counts the walk, and that walk and fluctuation are known only with an uncertainty (it is the
///   average over the likelihood, and not below any variance about as likely as the best), and the
///   scatter of the replicas if that is incompatible. So it is up to twice (one replica: three
///   times) too large where there is no walk, as one too small to be seen can't be excluded.
/// - The walk's interval is the likelihood ratio's; its lower end is 0 where no walk is seen.
/// - A fluctuation whose correlation time exceeds a twentieth of the longest trace counts as walk.
///
/// Traces of fewer than two points are left out. Throws std::invalid_argument if none remains,
/// sizes differ, a number is not finite, or the times are not equally spaced, with one spacing for
/// all replicas (to a relative 1e-6). With a single increment in all the error is infinite.
EnergyDrift energy_drift(const std::vector<EnergyTrace>& replicas);

}  // namespace driftless
