#include "experiments/order_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftless {
namespace {

struct Point {
  double x, y, weight;
};

std::vector<Point> significant_points(const std::vector<Deviation>& deviations) {
  // Errors of zero mean rounding; beside them no weight may be infinite.
  constexpr double smallest_relative_error = 1e-9;
  std::vector<Point> points;
  for (const Deviation& deviation : deviations) {
    if (!(deviation.time_step > 0.0) || !std::isfinite(deviation.time_step)) {
      throw std::invalid_argument("a time step is not positive");
    }
    const double size = std::abs(deviation.value);
    if (!std::isfinite(size) || !(size > 2.0 * deviation.error)) continue;
    const double relative = std::max(deviation.error / size, smallest_relative_error);
    points.push_back({std::log(deviation.time_step), std::log(size), 1.0 / (relative * relative)});
  }
  return points;
}

}  // namespace

std::optional<OrderFit> fit_order(const std::vector<Deviation>& deviations) {
  const std::vector<Point> points = significant_points(deviations);
  if (points.size() < 2) return std::nullopt;
  double weights = 0.0;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const Point& point : points) {
    weights += point.weight;
    mean_x += point.weight * point.x;
    mean_y += point.weight * point.y;
  }
  mean_x /= weights;
  mean_y /= weights;
  double xx = 0.0;
  double xy = 0.0;
  for (const Point& point : points) {
    xx += point.weight * (point.x - mean_x) * (point.x - mean_x);
    xy += point.weight * (point.x - mean_x) * (point.y - mean_y);
  }
  const auto [least, most] = std::minmax_element(
      points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
  if (most->x - least->x < 1e-9 || !(xx > 0.0)) return std::nullopt;
  OrderFit fit{xy / xx, 0.0, points.size()};
  double chi_squared = 0.0;
  for (const Point& point : points) {
    const double residual = point.y - mean_y - fit.order * (point.x - mean_x);
    chi_squared += point.weight * residual * residual;
  }
  const double freedom = std::max(1.0, static_cast<double>(points.size()) - 2.0);
  fit.error = std::sqrt(std::max(1.0, chi_squared / freedom) / xx);
  return fit;
}

}  // namespace driftless
