#include "experiments/judge/limit_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftless::judge {
namespace {

constexpr std::size_t fewest = 3, most = 4;

/// Lagrange's: by these the values of the first so many points are weighted in the limit.
std::vector<double> limit_weights(const std::vector<LimitPoint>& points, std::size_t count) {
  std::vector<double> weights(count, 1.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i == j) continue;
      weights[i] *= points[j].time_step / (points[j].time_step - points[i].time_step);
    }
  }
  return weights;
}

double weighted(const std::vector<LimitPoint>& points, const std::vector<double>& weights) {
  double sum = 0;
  for (std::size_t n = 0; n < weights.size(); ++n) sum += weights[n] * points[n].value;
  return sum;
}

}  // namespace

std::optional<Limit> limit_at_zero(std::vector<LimitPoint> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.time_step < b.time_step; });
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (!(points[n].time_step > (n == 0 ? 0 : points[n - 1].time_step))) {
      throw std::invalid_argument("a time step is not positive or occurs twice");
    }
    if (!std::isfinite(points[n].value) || !std::isfinite(points[n].error)) return std::nullopt;
  }
  if (points.size() < fewest) return std::nullopt;
  points.resize(std::min(points.size(), most));

  const auto weights = limit_weights(points, points.size() - 1);
  double variance = 0, spread = 0;
  for (std::size_t n = 0; n < weights.size(); ++n) {
    const double share = std::pow(weights[n] * points[n].error, 2);
    variance += share;
    spread += share * share / points[n].degrees_of_freedom;
  }
  Limit limit{weighted(points, weights), std::sqrt(variance)};
  if (spread > 0) limit.degrees_of_freedom = variance * variance / spread;
  const double with_all = weighted(points, limit_weights(points, points.size()));
  limit.model_error = std::abs(with_all - limit.value);
  limit.points = points.size();
  return limit;
}

}  // namespace driftless::judge
