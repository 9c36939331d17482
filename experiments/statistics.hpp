#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

namespace driftless {

/// A measured number with an honest error.
struct Estimate {
  /// Value, in the unit of the samples (or of the derived quantity).
  double mean = 0.0;
  /// Standard error, widened where it is itself poorly known, so that mean +- 1.96 error covers
  /// the truth in 95 % of the cases. Infinite if the data allow no error at all (one sample).
  double error = 0.0;
  /// Number of independent samples that would give the same error; never above the number taken.
  double effective_samples = 0.0;
  /// The replicas differ by more than their fluctuations in time explain (F test at 1 %). The error
  /// then comes from the scatter of the replicas.
  bool replicas_disagree = false;
  /// How well the error is known: the degrees of freedom that it was widened for. The standard
  /// error itself is error / student_factor(degrees_of_freedom).
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};

/// A quantity that depends on the means of the primary quantities, for example a ratio of two.
using DerivedQuantity = std::function<double(const Eigen::VectorXd& means)>;

/// Value and error of a quantity derived from the means of primary quantities, by the Gamma method
/// [U. Wolff, Comput. Phys. Commun. 156, 143 (2004)].
///
/// `replicas`: one matrix per independent run, samples (rows, equally spaced in time) by primary
/// quantities (columns); runs may differ in length, empty ones are left out.
///
/// - The value is `derived` at the means over all samples, with Wolff's correction of the bias of
///   order 1/N if there are at least two replicas.
/// - The error is the autocorrelation's sum up to an automatic window, of the series linearised by
///   central differences, pooled over the replicas about the common mean, with the corrections for
///   the finite window and number of samples. It is never below that of independent samples, so
///   that an anticorrelated series gets a conservative error.
/// - That sum has about N / (2 window + 1) degrees of freedom; the error is multiplied by the ratio
///   of Student's and the normal 97.5 % quantiles.
/// - Replicas whose means scatter more than the fluctuations inside the runs allow (F test at 1 %)
///   set `replicas_disagree`; the error is then the larger one that follows from the scatter.
/// - Runs of fewer than 20 autocorrelation times say little about that time. The sum is then also
///   carried to every longer window up to a third of the run and the largest value counts, and,
///   from three replicas on, the scatter of the replicas' means if that is larger. Of three or more
///   such runs the intervals then hold in 95 % of the cases or more; of one single run of 5
///   autocorrelation times in 93 %, of 2 in 91 %. What no run has visited yet, no statistics sees.
/// - A constant series has error 0 and as many effective samples as samples. A single sample, or a
///   derived quantity that is not finite a standard error off the means, has an infinite error.
///
/// Throws std::invalid_argument if there is no sample, the numbers of columns differ or a sample is
/// not finite; std::domain_error if `derived` is not finite at the means.
Estimate estimate(const std::vector<Eigen::MatrixXd>& replicas, const DerivedQuantity& derived);

/// The same for the mean of one scalar quantity; one series per replica.
Estimate estimate_mean(const std::vector<Eigen::VectorXd>& replicas);

/// Distance of two independent estimates in units of their common standard error, never negative,
/// at most 1e6 (so also where both errors are zero), and 0 if they agree to rounding.
double agreement_z(const Estimate& one, const Estimate& other);

/// Integrated autocorrelation time of a series in units of its sampling interval, 1/2 for
/// independent samples and for a constant series; never below 1/2.
/// Throws std::invalid_argument if the series is empty or not finite.
double autocorrelation_time(const Eigen::VectorXd& series);

/// The normal law's 97.5 % quantile: +- so many standard errors make a 95 % interval.
inline constexpr double interval_quantile = 1.959963984540054;

/// What Student's variable with so many degrees of freedom exceeds with a probability above 0 and
/// below 1/2; infinitely many make it normal. At least one degree is assumed.
double student_quantile(double degrees_of_freedom, double exceeded_with);

/// Student's 97.5 % quantile in units of the normal one: what a standard error with so many degrees
/// of freedom is multiplied by so that +- 1.96 of it covers 95 %. At least one degree is assumed.
double student_factor(double degrees_of_freedom);

}  // namespace driftless
