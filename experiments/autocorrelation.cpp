#include "experiments/autocorrelation.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

namespace driftless {
namespace {

/// Ratio of the exponential to the integrated autocorrelation time that the window allows for.
constexpr double window_parameter = 1.5;
/// Runs of fewer autocorrelation times than this count as short.
constexpr double short_run = 20.0;

double autocovariance(const std::vector<Eigen::VectorXd>& series, Eigen::Index lag) {
  double sum = 0.0;
  Eigen::Index count = 0;
  for (const Eigen::VectorXd& replica : series) {
    const Eigen::Index overlap = replica.size() - lag;
    if (overlap <= 0) continue;
    sum += replica.head(overlap).dot(replica.tail(overlap));
    count += overlap;
  }
  return sum / static_cast<double>(count);
}

/// True where a longer window would add more noise than it removes bias.
bool window_suffices(double lag, double integrated_time, double total) {
  if (integrated_time <= 0.5) return true;
  const double decay =
      window_parameter / std::log((2.0 * integrated_time + 1.0) / (2.0 * integrated_time - 1.0));
  return std::exp(-lag / decay) < decay / std::sqrt(lag * total);
}

/// Adds lag after lag until the window suffices. In a short run that first window is often an
/// accident, so there the largest sum over all windows up to a third of the run counts.
AutocovarianceSum sum_up(const std::vector<Eigen::VectorXd>& series, double variance, double total,
                         Eigen::Index longest, double means_removed) {
  AutocovarianceSum result;
  double sum = variance;
  double largest = 0.0;
  double window = 0.0;
  bool closed = false;
  for (Eigen::Index lag = 1; lag <= std::max<Eigen::Index>(1, longest / 3); ++lag) {
    sum += 2.0 * autocovariance(series, lag);
    const double candidate =
        sum * (1.0 + (2.0 * static_cast<double>(lag) + 1.0) * means_removed / total);
    if (!closed || candidate > largest) {
      largest = candidate;
      window = static_cast<double>(lag);
    }
    if (closed) continue;
    closed = window_suffices(window, 0.5 * sum / variance, total);
    result.is_short = static_cast<double>(longest) < short_run * 0.5 * largest / variance;
    if (closed && !result.is_short) break;
  }
  result.is_short = result.is_short || !closed;
  result.variance = variance + std::max(0.0, largest) * means_removed / total;
  result.sum = std::max(largest, result.variance);
  result.degrees_of_freedom = std::max(1.0, total / (2.0 * window + 1.0) - 1.0);
  return result;
}

}  // namespace

AutocovarianceSum autocovariance_sum(const std::vector<Eigen::VectorXd>& series,
                                     double means_removed) {
  double total = 0.0;
  Eigen::Index longest = 0;
  for (const Eigen::VectorXd& replica : series) {
    total += static_cast<double>(replica.size());
    longest = std::max(longest, replica.size());
  }
  const double variance = autocovariance(series, 0);
  if (variance > 0.0 && longest >= 2) {
    return sum_up(series, variance, total, longest, means_removed);
  }
  AutocovarianceSum result;  // constant, or one sample each
  result.variance = result.sum = variance * total / std::max(1.0, total - means_removed);
  result.degrees_of_freedom = total - means_removed;
  return result;
}

double exceeds_by_chance(double variance, double degrees_of_freedom, double other,
                         double other_degrees_of_freedom) {
  if (variance <= 0.0) return 1.0;
  if (other <= 0.0) return 0.0;
  const boost::math::fisher_f law(degrees_of_freedom, std::max(1.0, other_degrees_of_freedom));
  return boost::math::cdf(boost::math::complement(law, variance / other));
}

}  // namespace driftless
