#include "experiments/pooled_errors.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace driftless {
namespace {

constexpr double heterogeneity_confidence = 0.75;

/// A squared error's logarithm, free of the bias that chance gives it.
struct LogVariance {
  double value, chance;  ///< `chance`: its variance by chance alone
  double time_step;
};

LogVariance log_variance(const CellError& cell) {
  const double half = 0.5 * cell.degrees_of_freedom;
  return {2.0 * std::log(cell.error) - boost::math::digamma(half) + std::log(half),
          boost::math::trigamma(half), cell.time_step};
}

/// Each cell once, also where two names stand for one scheme.
std::vector<LogVariance> distinct(const std::vector<CellError>& cells) {
  std::vector<LogVariance> result;
  std::set<std::pair<double, double>> known;
  for (const CellError& cell : cells) {
    const LogVariance entry = log_variance(cell);
    if (known.emplace(entry.time_step, entry.value).second) result.push_back(entry);
  }
  return result;
}

/// The mean over the cells of other steps than one, and its variance.
struct Common {
  double value, uncertainty;
};

std::optional<Common> common_value(const std::vector<LogVariance>& cells, double heterogeneity,
                                   std::optional<double> without_step) {
  double weights = 0.0, sum = 0.0;
  std::map<double, double> roots;  // of the weights, by step: all errors of a step in one direction
  for (const LogVariance& cell : cells) {
    if (cell.time_step == without_step) continue;
    const double weight = 1.0 / (cell.chance + heterogeneity);
    weights += weight;
    sum += weight * cell.value;
    roots[cell.time_step] += std::sqrt(weight);
  }
  if (roots.empty()) return std::nullopt;
  double squares = 0.0;
  for (const auto& [step, root] : roots) squares += root * root;
  return Common{sum / weights, squares / (weights * weights)};
}

/// Upper confidence limit of the variance of true differences between the cells.
double heterogeneity_of(const std::vector<LogVariance>& cells) {
  if (cells.size() < 2) return 0.0;  // then there is nothing to learn from either
  const double least =
      boost::math::quantile(boost::math::chi_squared(static_cast<double>(cells.size()) - 1.0),
                            1.0 - heterogeneity_confidence);
  // Falls with h: the scatter in units of what h and chance explain.
  const auto excess = [&](double h) {
    const double centre = common_value(cells, h, std::nullopt)->value;
    double sum = 0.0;
    for (const LogVariance& cell : cells) {
      sum += (cell.value - centre) * (cell.value - centre) / (cell.chance + h);
    }
    return sum - least;
  };
  if (excess(0.0) <= 0.0) return 0.0;
  double low = 0.0, high = 1.0;
  while (excess(high) > 0.0) high *= 2.0;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0.0 ? low : high) = middle;
  }
  return high;
}

/// The degrees of freedom of a squared error whose logarithm has this variance.
double degrees_of_freedom(double variance) {
  double low = 1e-6, high = 1e9;  // trigamma falls from infinity to 0
  for (int halving = 0; halving < 100; ++halving) {
    const double middle = std::sqrt(low * high);
    (boost::math::trigamma(middle) > variance ? low : high) = middle;
  }
  return 2.0 * low;
}

/// What the cells of the other steps say of the cells of each step, as one more estimate; nothing
/// where there are none.
std::map<double, std::optional<PooledError>> estimates_of_others(
    const std::vector<LogVariance>& cells) {
  const double heterogeneity = heterogeneity_of(cells);
  std::map<double, std::optional<PooledError>> result;
  for (const LogVariance& cell : cells) {
    if (result.contains(cell.time_step)) continue;
    auto& others = result[cell.time_step];
    if (const auto common = common_value(cells, heterogeneity, cell.time_step)) {
      others = {std::exp(0.5 * common->value),
                degrees_of_freedom(heterogeneity + common->uncertainty)};
    }
  }
  return result;
}

}  // namespace

std::vector<PooledError> pool_errors(const std::vector<CellError>& cells) {
  const auto estimates = estimates_of_others(distinct(cells));
  std::vector<PooledError> result;
  for (const CellError& cell : cells) {
    const double own = cell.degrees_of_freedom, square = cell.error * cell.error;
    const auto& others = estimates.at(cell.time_step);
    if (!others) {
      result.push_back({cell.error, own});
      continue;
    }
    const double sum = others->degrees_of_freedom + own;
    const double weighted = others->degrees_of_freedom * others->error * others->error;
    result.push_back({std::sqrt((weighted + own * square) / sum), sum});
  }
  return result;
}

}  // namespace driftless
