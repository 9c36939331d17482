#pragma once

#include <Eigen/Core>
#include <vector>

namespace driftless {

/// The sum of a stationary series' autocovariances, sum over all lags t of Gamma(t): N times the
/// variance of the mean of N samples.
struct AutocovarianceSum {
  double variance = 0.0;            ///< Gamma(0), corrected for the mean's own error
  double sum = 0.0;                 ///< never below `variance`
  double degrees_of_freedom = 0.0;  ///< of `sum` as an estimate of a variance
  bool is_short = false;            ///< the runs are shorter than 20 autocorrelation times
};

/// Automatic windowing of [U. Wolff, Comput. Phys. Commun. 156, 143 (2004)], section 3.3, pooled
/// over the replicas. `series` hold deviations from their means; `means_removed` tells how many
/// means these were (1 for a common one, the number of replicas for one each), for the bias that
/// removing them causes.
AutocovarianceSum autocovariance_sum(const std::vector<Eigen::VectorXd>& series,
                                     double means_removed);

/// Probability that chance alone makes an estimate of a variance exceed another of the same
/// variance by as much (F test, one-sided), given both degrees of freedom. 0 if only `other`
/// vanishes.
double exceeds_by_chance(double variance, double degrees_of_freedom, double other,
                         double other_degrees_of_freedom);

}  // namespace driftless
