#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Whether a stationary process looks alike forwards and backwards in time.
namespace driftless::judge {

/// Two moments of the state whose correlation is compared with that of the reversed motion:
/// A = <f(t) g(t + tau)> - sign <g(t) f(t + tau)>, which detailed balance makes 0. `sign` is the
/// product of the moments' signs under the reversal of momenta.
struct MomentPair {
  std::string name;  ///< "u, K u"
  int f, g;          ///< columns of the series
  double sign = 1;
};

/// A of every pair of moments at every lag (rows of the series), one lag after the other, averaged
/// over the series: rows are times, columns moments.
Eigen::VectorXd reversal_differences(const Eigen::MatrixXd& series,
                                     const std::vector<MomentPair>& pairs,
                                     const std::vector<int>& lags);

/// Mean and covariance of independent, equally distributed vectors.
class Scatter {
 public:
  void add(const Eigen::VectorXd& row);
  /// {"rows", "mean", "covariance"}, the covariance being that of the mean.
  nlohmann::json record() const;

 private:
  double rows_ = 0;
  Eigen::VectorXd sum_;
  Eigen::MatrixXd products_;
};

/// A measured vector: what Scatter recorded.
struct MeasuredVector {
  double rows = 0;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;  ///< of the mean

  double error(Eigen::Index n) const { return std::sqrt(std::max(covariance(n, n), 0.0)); }
};

MeasuredVector measured_vector(const nlohmann::json& record);

/// The value at step 0 of the parabola through independent vectors at three steps, each half of the
/// one before.
MeasuredVector at_vanishing_step(const std::array<MeasuredVector, 3>& vectors);

/// A test and the probability that it comes out as far off, or farther, by chance.
struct ChanceTest {
  double statistic = 0, freedom = 0, probability = 1;

  /// Less likely than `certain` standard errors of a normal variate.
  bool certainly_not_chance() const;
};

/// Hotelling's T^2 of the hypothesis that the whole vector is 0; directions in which the rows do
/// not scatter are left out.
ChanceTest hotelling(const MeasuredVector& vector);

/// sum (n_ab - n_ba)^2/(n_ab + n_ba) of independent two-way transition counts, over the pairs of
/// bins with 10 transitions or more: chi^2 distributed under detailed balance.
ChanceTest two_way_test(const Eigen::MatrixXd& counts);

}  // namespace driftless::judge
