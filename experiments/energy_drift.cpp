#include "experiments/energy_drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "experiments/autocorrelation.hpp"
#include "experiments/drift_likelihood.hpp"

namespace driftless {
namespace {

constexpr Eigen::Index modes_used = 64;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Throws unless the trace fits the model; returns its time step.
double checked_spacing(const EnergyTrace& trace) {
  const Eigen::Index count = trace.times.size();
  if (trace.energies.size() != count) {
    throw std::invalid_argument("an energy trace has not as many energies as times");
  }
  if (!trace.times.allFinite() || !trace.energies.allFinite()) {
    throw std::invalid_argument("an energy trace holds a number that is not finite");
  }
  if (count < 2) return 0.0;
  const double spacing = (trace.times[count - 1] - trace.times[0]) / static_cast<double>(count - 1);
  for (Eigen::Index i = 1; i < count; ++i) {
    const double step = trace.times[i] - trace.times[i - 1];
    if (!(spacing > 0.0) || std::abs(step - spacing) > 1e-6 * spacing) {
      throw std::invalid_argument("the times of an energy trace are not equally spaced");
    }
  }
  return spacing;
}

/// The slowest cosine modes of a trace less a line of slope `trend`, of the line of slope 1, and
/// the walk's variance in each.
DriftModes cosine_modes(const Eigen::VectorXd& energies, double spacing, double trend) {
  const Eigen::Index points = energies.size();
  const Eigen::Index count = std::min(points - 1, modes_used);
  const double n = static_cast<double>(points);
  const Eigen::ArrayXd times = Eigen::ArrayXd::LinSpaced(points, 0.5 - 0.5 * n, 0.5 * n - 0.5);
  const Eigen::ArrayXd deviations =
      (energies.array() - energies[0]) - trend * spacing * (times - times[0]);
  DriftModes modes{Eigen::ArrayXd(count), Eigen::ArrayXd(count), Eigen::ArrayXd(count),
                   Eigen::ArrayXd(count)};
  for (Eigen::Index j = 1; j <= count; ++j) {
    const double angle = std::numbers::pi * static_cast<double>(j) / n;
    const Eigen::ArrayXd wave = std::sqrt(2.0 / n) * (angle * (times + 0.5 * n)).cos();
    const double sine = 2.0 * std::sin(0.5 * angle);
    modes.amplitude[j - 1] = (deviations * wave).sum();
    modes.line[j - 1] = spacing * (times * wave).sum();
    modes.walk[j - 1] = spacing / (sine * sine);
    modes.squared_frequency[j - 1] = sine * sine;
  }
  return modes;
}

/// From half of what is left of the variance of E(t + s) - E(t) after the walk's share D s, at a
/// lag s of three correlation times, or of the fastest mode used.
double bounded_fluctuation(const std::vector<Eigen::VectorXd>& traces, double spacing, double slope,
                           const DriftVariance& fitted) {
  if (fitted.fluctuation == 0.0) return 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const Eigen::VectorXd& trace : traces) {
    const auto slow = static_cast<Eigen::Index>(3.0 * std::sqrt(fitted.slowness));
    const Eigen::Index lag = std::clamp<Eigen::Index>(std::max(slow, trace.size() / modes_used), 1,
                                                      std::max<Eigen::Index>(1, trace.size() / 4));
    const double time = spacing * static_cast<double>(lag);
    const Eigen::ArrayXd steps =
        (trace.tail(trace.size() - lag) - trace.head(trace.size() - lag)).array() - slope * time;
    squares += (steps.square() - fitted.walk * time).sum();
    count += static_cast<double>(steps.size());
  }
  return std::sqrt(std::max(0.0, 0.5 * squares / count));
}

/// Replicas whose own slopes scatter more than the common error allows decide the error.
void compare_replicas(const std::vector<DriftModes>& modes, const DriftFit& fit, Estimate& slope) {
  if (modes.size() < 2 || fit.degrees_of_freedom < 1.0) return;
  double chi_squared = 0.0;
  double information = 0.0;
  for (const DriftModes& replica : modes) {
    const SlopeFit own = fit_slope({replica}, fit.best);
    chi_squared += (own.slope - slope.mean) * (own.slope - slope.mean) * own.information;
    information += own.information;
  }
  const double others = static_cast<double>(modes.size()) - 1.0;
  const double scatter = chi_squared / others;
  slope.replicas_disagree = exceeds_by_chance(scatter, others, 1.0, fit.degrees_of_freedom) < 0.01;
  const double error = std::sqrt(scatter / information) * student_factor(others);
  if (!slope.replicas_disagree || error <= slope.error) return;
  slope.error = error;
  slope.degrees_of_freedom = others;
}

}  // namespace

EnergyDrift energy_drift(const std::vector<EnergyTrace>& replicas) {
  double spacing = 0.0;
  std::vector<Eigen::VectorXd> traces;
  for (const EnergyTrace& trace : replicas) {
    const double own = checked_spacing(trace);
    if (trace.times.size() < 2) continue;
    if (spacing == 0.0) spacing = own;
    if (std::abs(own - spacing) > 1e-6 * spacing) {
      throw std::invalid_argument("the energy traces differ in their time spacing");
    }
    traces.push_back(trace.energies);
  }
  if (traces.empty()) throw std::invalid_argument("an energy drift needs two points of a trace");
  // Taken off beforehand, lest the rounding of a large drift's modes hide a small fluctuation.
  const double trend = (traces[0][traces[0].size() - 1] - traces[0][0]) /
                       (spacing * static_cast<double>(traces[0].size() - 1));
  std::vector<DriftModes> modes;
  for (const Eigen::VectorXd& trace : traces) modes.push_back(cosine_modes(trace, spacing, trend));
  const DriftFit fit = fit_drift(modes);
  EnergyDrift result;
  result.slope.mean = fit.slope;
  result.slope.effective_samples = fit.degrees_of_freedom + 1.0;
  result.slope.error = fit.degrees_of_freedom < 1.0 ? infinity : fit.slope_error;
  result.slope.degrees_of_freedom = fit.slope_degrees_of_freedom;
  result.walk = fit.walk;
  if (!fit.deterministic) compare_replicas(modes, fit, result.slope);
  result.slope.mean += trend;
  result.fluctuation = bounded_fluctuation(traces, spacing, result.slope.mean, fit.best);
  return result;
}

}  // namespace driftless
