#include "experiments/compare/difference.hpp"

#include <algorithm>
#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "experiments/statistics.hpp"

namespace driftless {
namespace {

constexpr double missed_with = 0.05;  // one less the power of a detectable difference

/// Two-sided.
double exceeding(double z, double degrees_of_freedom) {
  if (degrees_of_freedom > 1e6) {
    return 2 * boost::math::cdf(boost::math::complement(boost::math::normal(), z));
  }
  const boost::math::students_t student(std::max(1.0, degrees_of_freedom));
  return 2 * boost::math::cdf(boost::math::complement(student, z));
}

Difference judged(const Measurement& base, const Measurement& changed, double degrees_of_freedom) {
  Difference result{changed.mean - base.mean, std::hypot(base.error, changed.error),
                    std::max(1.0, degrees_of_freedom), 1};
  const double rounding = 16 * std::numeric_limits<double>::epsilon() *
                          std::max(std::abs(base.mean), std::abs(changed.mean));
  const double size = std::abs(result.value);
  if (size <= rounding) return result;
  result.probability =
      result.error > 0 ? exceeding(size / result.error, result.degrees_of_freedom) : 0;
  return result;
}

double welch_degrees(const Measurement& base, const Measurement& changed) {
  const double one = base.error * base.error, other = changed.error * changed.error;
  if (one + other == 0) return std::min(base.degrees_of_freedom, changed.degrees_of_freedom);
  const double share = one / (one + other);  // first, so that small errors do not underflow
  return 1 / (share * share / std::max(1.0, base.degrees_of_freedom) +
              (1 - share) * (1 - share) / std::max(1.0, changed.degrees_of_freedom));
}

}  // namespace

Difference difference(const Measurement& base, const Measurement& changed) {
  return judged(base, changed, std::min(base.degrees_of_freedom, changed.degrees_of_freedom));
}

Difference difference_of_variances(const Measurement& base, const Measurement& changed) {
  return judged(base, changed, welch_degrees(base, changed));
}

double detectable_difference(const Difference& difference, double level) {
  const double freedom = difference.degrees_of_freedom;
  return difference.error *
         (student_quantile(freedom, level / 2) + student_quantile(freedom, missed_with));
}

std::vector<double> holm_adjusted(const std::vector<double>& probabilities) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) {
    return probabilities[one] < probabilities[other];
  });
  std::vector<double> adjusted(probabilities.size());
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double factor = static_cast<double>(order.size() - rank);
    largest = std::max(largest, std::min(1.0, factor * probabilities[order[rank]]));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

double fisher_probability(unsigned first, unsigned first_total, unsigned second,
                          unsigned second_total) {
  const unsigned together = first + second, total = first_total + second_total;
  if (together == 0 || together == total || first_total == 0 || second_total == 0) return 1;
  const boost::math::hypergeometric law(together, first_total, total);
  const unsigned least = together > second_total ? together - second_total : 0;
  const double seen = boost::math::pdf(law, first);
  double sum = 0;
  for (unsigned count = least; count <= std::min(together, first_total); ++count) {
    const double chance = boost::math::pdf(law, count);
    if (chance <= seen * (1 + 1e-7)) sum += chance;
  }
  return std::min(1.0, sum);
}

}  // namespace driftless
