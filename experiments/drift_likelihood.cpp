#include "experiments/drift_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftless {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// That of the walk's interval: above the normal one, as a fluctuation can only be fitted with a
/// positive strength, which is then taken from the walk. Found with pure walks: with the normal one
/// only 89 to 93 % of the intervals hold the truth.
constexpr double walk_quantile = 2.25;
/// A fluctuation's corner must lie at or above this mode of the longest trace: with a correlation
/// time above T/(6 pi), about a twentieth of the trace, it counts as a walk.
constexpr double slowest_corner = 6.0;

/// One shape of the variance: everything but its overall scale, which is fitted exactly.
struct Shape {
  DriftVariance variance;  // of scale 1
  SlopeFit fit;
  double log_likelihood = 0.0;  // twice the restricted one, at the best scale
};

Eigen::ArrayXd total_variance(const DriftModes& modes, const DriftVariance& variance) {
  return variance.walk * modes.walk +
         variance.fluctuation / (1.0 + variance.slowness * modes.squared_frequency);
}

double degrees_of_freedom(const SlopeFit& fit) { return fit.count - 1.0; }

/// Twice the restricted log-likelihood at a given scale, up to a constant.
double log_likelihood(const SlopeFit& fit, double scale) {
  return -degrees_of_freedom(fit) * std::log(scale) - fit.residual / scale - fit.log_variances -
         std::log(fit.information);
}

const DriftModes& longest_of(const std::vector<DriftModes>& replicas) {
  return *std::max_element(
      replicas.begin(), replicas.end(),
      [](const DriftModes& a, const DriftModes& b) { return a.walk[0] < b.walk[0]; });
}

/// All shapes of a grid: ratios of walk to fluctuation from one that can't be seen in the slowest
/// mode to one that hides the fluctuation in the fastest, and both ends; times corners of the
/// fluctuation. Eight ratios a decade: the likelihood is smooth on the scale of a factor of two.
std::vector<Shape> shapes(const std::vector<DriftModes>& replicas) {
  const DriftModes& longest = longest_of(replicas);
  const double first = longest.squared_frequency[0];
  const double slowest = longest.walk[0];
  const double fastest = longest.walk[longest.walk.size() - 1];
  std::vector<double> corners{infinity};
  for (double corner = slowest_corner; corner < 1.5 * static_cast<double>(longest.walk.size());
       corner *= std::sqrt(2.0)) {
    corners.push_back(corner);
  }
  std::vector<Shape> result;
  const auto add = [&](double walk, double fluctuation, double corner) {
    Shape shape;
    shape.variance = {walk, fluctuation, 1.0 / (first * corner * corner)};
    shape.fit = fit_slope(replicas, shape.variance);
    const double scale = shape.fit.residual / std::max(1.0, degrees_of_freedom(shape.fit));
    shape.log_likelihood = log_likelihood(shape.fit, scale);
    result.push_back(shape);
  };
  add(1.0 / slowest, 0.0, infinity);
  for (const double corner : corners) {
    add(0.0, 1.0, corner);
    const double last = 30.0 * slowest / fastest;
    for (double ratio = 0.03; ratio < last; ratio *= std::pow(10.0, 0.125)) {
      add(std::min(ratio, 1.0) / slowest, std::min(1.0 / ratio, 1.0), corner);
    }
  }
  return result;
}

/// Largest likelihood for a walk of this strength.
double profile(const std::vector<Shape>& all, double walk) {
  double best = -infinity;
  for (const Shape& shape : all) {
    if (walk == 0.0) {
      if (shape.variance.walk == 0.0) best = std::max(best, shape.log_likelihood);
    } else if (shape.variance.walk > 0.0) {
      best = std::max(best, log_likelihood(shape.fit, walk / shape.variance.walk));
    }
  }
  return best;
}

/// Where the profile crosses `level`, between a walk above it (`inside`) and one below (`outside`).
double crossing(const std::vector<Shape>& all, double level, double inside, double outside) {
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(inside) * std::sqrt(outside);
    (profile(all, middle) > level ? inside : outside) = middle;
  }
  return inside;
}

/// Likelihood ratio interval, sought from outside; `scale` is the walk's order of magnitude. The
/// threshold is that of a Student law.
WalkStrength walk_interval(const std::vector<Shape>& all, const Shape& best, double scale) {
  const double freedom = std::max(1.0, degrees_of_freedom(best.fit));
  const double quantile = walk_quantile * student_factor(freedom);
  const double level = best.log_likelihood - freedom * std::log1p(quantile * quantile / freedom);
  WalkStrength walk;
  walk.value = best.variance.walk * best.fit.residual / freedom;
  double above = scale;
  while (profile(all, above) > level) above *= 2.0;
  while (above > std::max(1e-12 * scale, 2.0 * walk.value) && profile(all, 0.5 * above) < level) {
    above *= 0.5;
  }
  walk.upper = crossing(all, level, std::max(0.5 * above, walk.value), above);
  if (walk.value > 0.0 && profile(all, 0.0) < level) {
    double below = walk.value;
    while (profile(all, below) > level) below *= 0.5;
    walk.lower = crossing(all, level, std::min(2.0 * below, walk.value), below);
  }
  walk.error = (walk.upper - walk.lower) / (2.0 * interval_quantile);
  return walk;
}

/// Independent increments: the walk's share in the modes' variance.
double effective_increments(const std::vector<DriftModes>& replicas,
                            const DriftVariance& variance) {
  double result = 0.0;
  for (const DriftModes& modes : replicas) {
    const Eigen::ArrayXd walk = variance.walk * modes.walk;
    result += (walk / total_variance(modes, variance)).sum();
  }
  return result;
}

/// Degrees of freedom of the slope's error: it is that of the slowest mode's variance, of which the
/// walk's share is only known from the modes where the walk dominates (Satterthwaite's rule).
double slope_degrees(const DriftModes& modes, const DriftFit& fit) {
  const double share = fit.best.walk * modes.walk[0] / total_variance(modes, fit.best)[0];
  const double walk =
      share > 0.0 ? share * share / std::max(1.0, fit.walk.effective_increments) : 0;
  const double rest = (1.0 - share) * (1.0 - share) / fit.degrees_of_freedom;
  return std::min(fit.degrees_of_freedom, 1.0 / (walk + rest));
}

/// Variance of the slope: averaged over the likelihood of the shapes, but not below that of any
/// shape within one standard error of the best.
double slope_variance(const std::vector<Shape>& all, const Shape& best) {
  double weights = 0.0;
  double mean = 0.0;
  double square = 0.0;
  double variance = 0.0;
  double largest = 0.0;
  for (const Shape& shape : all) {
    const double weight = std::exp(0.5 * (shape.log_likelihood - best.log_likelihood));
    const double scale = shape.fit.residual / std::max(1.0, degrees_of_freedom(shape.fit));
    const double deviation = shape.fit.slope - best.fit.slope;
    weights += weight;
    mean += weight * deviation;
    square += weight * deviation * deviation;
    variance += weight * scale / shape.fit.information;
    if (best.log_likelihood - shape.log_likelihood < 1.0) {
      largest = std::max(largest, scale / shape.fit.information);
    }
  }
  mean /= weights;
  return std::max(largest, variance / weights + std::max(0.0, square / weights - mean * mean));
}

}  // namespace

SlopeFit fit_slope(const std::vector<DriftModes>& replicas, const DriftVariance& variance) {
  SlopeFit fit;
  double projection = 0.0;
  for (const DriftModes& modes : replicas) {
    const Eigen::ArrayXd variances = total_variance(modes, variance);
    fit.information += (modes.line.square() / variances).sum();
    projection += (modes.line * modes.amplitude / variances).sum();
    fit.log_variances += variances.log().sum();
    fit.count += static_cast<double>(variances.size());
  }
  fit.slope = projection / fit.information;
  for (const DriftModes& modes : replicas) {
    const Eigen::ArrayXd residuals = modes.amplitude - fit.slope * modes.line;
    fit.residual += (residuals.square() / total_variance(modes, variance)).sum();
  }
  return fit;
}

DriftFit fit_drift(const std::vector<DriftModes>& replicas) {
  const std::vector<Shape> all = shapes(replicas);
  const Shape& best = *std::max_element(all.begin(), all.end(), [](const Shape& a, const Shape& b) {
    return a.log_likelihood < b.log_likelihood;
  });
  DriftFit result;
  result.slope = best.fit.slope;
  result.degrees_of_freedom = degrees_of_freedom(best.fit);
  double largest_walk = 0.0;
  for (const DriftModes& modes : replicas) {
    const Eigen::ArrayXd residuals = modes.amplitude - result.slope * modes.line;
    largest_walk = std::max(largest_walk, (residuals.square() / modes.walk).sum());
  }
  result.deterministic = result.degrees_of_freedom < 1.0 || largest_walk == 0.0;
  if (result.deterministic) return result;
  const double scale = best.fit.residual / result.degrees_of_freedom;
  result.best = {scale * best.variance.walk, scale * best.variance.fluctuation,
                 best.variance.slowness};
  result.walk = walk_interval(all, best, largest_walk);
  result.walk.effective_increments = effective_increments(replicas, result.best);
  result.slope_degrees_of_freedom = std::max(1.0, slope_degrees(longest_of(replicas), result));
  result.slope_error =
      std::sqrt(slope_variance(all, best)) * student_factor(result.slope_degrees_of_freedom);
  return result;
}

}  // namespace driftless
