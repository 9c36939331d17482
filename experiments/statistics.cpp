#include "experiments/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "experiments/autocorrelation.hpp"

namespace driftless {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// What the estimates are made from: samples without empty replicas, and means.
struct Samples {
  std::vector<Eigen::MatrixXd> deviations;  // from the overall means
  Eigen::VectorXd means;
  double total = 0.0;
};

Samples collect(const std::vector<Eigen::MatrixXd>& replicas) {
  Samples samples;
  for (const Eigen::MatrixXd& replica : replicas) {
    if (replica.rows() == 0) continue;
    if (!replica.allFinite()) throw std::invalid_argument("a sample is not a finite number");
    if (!samples.deviations.empty() && replica.cols() != samples.deviations.front().cols()) {
      throw std::invalid_argument("replicas differ in their number of quantities");
    }
    samples.deviations.push_back(replica);
    samples.total += static_cast<double>(replica.rows());
  }
  if (samples.deviations.empty()) throw std::invalid_argument("an estimate needs a sample");
  // Relative to the first sample, so that a constant series has exactly its value as its mean.
  const Eigen::RowVectorXd origin = samples.deviations.front().row(0);
  Eigen::RowVectorXd shift = Eigen::RowVectorXd::Zero(origin.size());
  for (Eigen::MatrixXd& replica : samples.deviations) {
    replica.rowwise() -= origin;
    shift += replica.colwise().sum();
  }
  shift /= samples.total;
  for (Eigen::MatrixXd& replica : samples.deviations) replica.rowwise() -= shift;
  samples.means = (origin + shift).transpose();
  return samples;
}

double finite_value(const DerivedQuantity& derived, const Eigen::VectorXd& means) {
  const double value = derived(means);
  if (!std::isfinite(value)) throw std::domain_error("a derived quantity is not a finite number");
  return value;
}

/// Central differences over one standard error of independent samples: the scale on which the
/// means are known, which also keeps the difference clear of rounding. Not finite where the derived
/// quantity is not.
Eigen::VectorXd gradient(const Samples& samples, const DerivedQuantity& derived) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(samples.means.size());
  for (Eigen::Index column = 0; column < samples.means.size(); ++column) {
    double squares = 0.0;
    for (const Eigen::MatrixXd& replica : samples.deviations) {
      squares += replica.col(column).squaredNorm();
    }
    if (squares == 0.0) continue;
    const double step = std::max(std::sqrt(squares) / samples.total,
                                 std::cbrt(epsilon) * std::abs(samples.means[column]));
    Eigen::VectorXd above = samples.means;
    Eigen::VectorXd below = samples.means;
    above[column] += step;
    below[column] -= step;
    result[column] = (derived(above) - derived(below)) / (above[column] - below[column]);
  }
  return result;
}

/// Wolff's correction: the mean of the replicas' own values has R times the bias of the common one.
double without_bias(double value, const Samples& samples, const DerivedQuantity& derived) {
  const double count = static_cast<double>(samples.deviations.size());
  if (count < 2.0) return value;
  double excess = 0.0;
  for (const Eigen::MatrixXd& replica : samples.deviations) {
    const Eigen::VectorXd means = samples.means + replica.colwise().mean().transpose();
    excess += static_cast<double>(replica.rows()) / samples.total * (derived(means) - value);
  }
  return std::isfinite(excess) ? value - excess / (count - 1.0) : value;
}

/// Sets error, effective samples and the verdict on the replicas from the linearised series, which
/// must have the overall mean zero. `rounding`: what the value is certain to at best.
void set_error(std::vector<Eigen::VectorXd> series, double rounding, Estimate& result) {
  const double count = static_cast<double>(series.size());
  const AutocovarianceSum pooled = autocovariance_sum(series, 1.0);
  double total = 0.0;
  double between = 0.0;
  for (Eigen::VectorXd& replica : series) {
    const double mean = replica.mean();
    total += static_cast<double>(replica.size());
    between += static_cast<double>(replica.size()) * mean * mean;
    replica.array() -= mean;
  }
  result.effective_samples = total;
  if (total < 2.0) {
    result.error = infinity;
    return;
  }
  if (pooled.variance == 0.0) return;
  double variance_of_mean = pooled.sum / total;
  result.degrees_of_freedom = pooled.degrees_of_freedom;
  result.error = std::sqrt(variance_of_mean) * student_factor(pooled.degrees_of_freedom);
  if (series.size() >= 2) {
    const AutocovarianceSum within = autocovariance_sum(series, count);
    between /= count - 1.0;
    result.replicas_disagree =
        between > total * rounding * rounding &&
        exceeds_by_chance(between, count - 1.0, within.sum, within.degrees_of_freedom) < 0.01;
    const bool scatter_counts = result.replicas_disagree || (pooled.is_short && series.size() >= 3);
    const double scatter = std::sqrt(between / total) * student_factor(count - 1.0);
    if (scatter_counts && scatter > result.error) {
      result.error = scatter;
      result.degrees_of_freedom = count - 1.0;
      variance_of_mean = std::max(variance_of_mean, between / total);
    }
  }
  result.effective_samples = std::min(total, pooled.variance / variance_of_mean);
}

}  // namespace

double student_quantile(double degrees_of_freedom, double exceeded_with) {
  if (degrees_of_freedom > 1e6) {
    return boost::math::quantile(boost::math::complement(boost::math::normal(), exceeded_with));
  }
  const boost::math::students_t student(std::max(1.0, degrees_of_freedom));
  return boost::math::quantile(boost::math::complement(student, exceeded_with));
}

double student_factor(double degrees_of_freedom) {
  if (degrees_of_freedom > 1e6) return 1.0;
  return std::max(1.0, student_quantile(degrees_of_freedom, 0.025) / interval_quantile);
}

Estimate estimate(const std::vector<Eigen::MatrixXd>& replicas, const DerivedQuantity& derived) {
  const Samples samples = collect(replicas);
  const double value = finite_value(derived, samples.means);
  const Eigen::VectorXd slopes = gradient(samples, derived);
  if (!slopes.allFinite()) return {value, infinity, 1.0, false};
  std::vector<Eigen::VectorXd> series;
  series.reserve(samples.deviations.size());
  for (const Eigen::MatrixXd& replica : samples.deviations) series.emplace_back(replica * slopes);
  Estimate result;
  result.mean = without_bias(value, samples, derived);
  set_error(std::move(series), 8.0 * epsilon * slopes.cwiseAbs().dot(samples.means.cwiseAbs()),
            result);
  return result;
}

Estimate estimate_mean(const std::vector<Eigen::VectorXd>& replicas) {
  std::vector<Eigen::MatrixXd> matrices(replicas.begin(), replicas.end());
  return estimate(matrices, [](const Eigen::VectorXd& means) { return means[0]; });
}

double agreement_z(const Estimate& one, const Estimate& other) {
  constexpr double largest = 1e6;
  const double difference = std::abs(one.mean - other.mean);
  if (difference <= 16.0 * epsilon * std::max(std::abs(one.mean), std::abs(other.mean))) return 0.0;
  const double error = std::hypot(one.error, other.error);
  return difference < largest * error ? difference / error : largest;
}

double autocorrelation_time(const Eigen::VectorXd& series) {
  const Samples samples = collect({series});
  const AutocovarianceSum sum = autocovariance_sum({samples.deviations.front().col(0)}, 1.0);
  return sum.variance > 0.0 ? 0.5 * sum.sum / sum.variance : 0.5;
}

}  // namespace driftless
