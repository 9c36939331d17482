#include "experiments/transport/decay.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace driftless::transport {
namespace {

/// The first place where the curve over its first value is below a level; its length if nowhere.
std::size_t falls_below(const Decay& decay, double level) {
  const auto& values = decay.values;
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](double value) { return value < level * values.front(); });
  return static_cast<std::size_t>(found - values.begin());
}

std::optional<Exponential> fit_between(const Decay& decay, std::size_t first, std::size_t last) {
  double weight = 0, t_mean = 0, y_mean = 0, covariance = 0, variance = 0;
  std::size_t points = 0;
  const auto each = [&](auto&& visit) {
    for (std::size_t n = first; n < last; ++n) {
      const double value = decay.values[n];
      if (value > 0) visit(value * value, static_cast<double>(n) * decay.interval, std::log(value));
    }
  };
  each([&](double w, double t, double y) {
    weight += w, t_mean += w * t, y_mean += w * y, ++points;
  });
  if (points < 3) return {};
  t_mean /= weight, y_mean /= weight;
  each([&](double w, double t, double y) {
    covariance += w * (t - t_mean) * (y - y_mean);
    variance += w * (t - t_mean) * (t - t_mean);
  });
  const double rate = -covariance / variance;
  return Exponential{std::exp(y_mean + rate * t_mean), rate};
}

double simpson(const Decay& decay, std::size_t last) {
  const auto& v = decay.values;
  double sum = 0;
  std::size_t n = 0;
  for (; n + 2 <= last; n += 2) sum += (v[n] + 4 * v[n + 1] + v[n + 2]) / 3;
  if (n < last) sum += (v[n] + v[n + 1]) / 2;
  return sum * decay.interval;
}

/// A damped oscillation in the parameters (rate, frequency); the two amplitudes follow linearly.
struct OscillationFit {
  const Decay& decay;
  Oscillation found = {};
  Eigen::VectorXd residual = {};

  double square(double rate, double frequency) {
    const auto size = static_cast<Eigen::Index>(decay.values.size());
    Eigen::MatrixXd basis(size, 2);
    for (Eigen::Index n = 0; n < size; ++n) {
      const double t = static_cast<double>(n) * decay.interval, fall = std::exp(-rate * t);
      basis(n, 0) = fall * std::cos(frequency * t);
      basis(n, 1) = fall * std::sin(frequency * t);
    }
    const Eigen::Map<const Eigen::VectorXd> values(decay.values.data(), size);
    const Eigen::Vector2d amplitudes = basis.colPivHouseholderQr().solve(values);
    residual = values - basis * amplitudes;
    found = {rate, frequency, amplitudes[0], amplitudes[1]};
    return residual.squaredNorm();
  }
};

}  // namespace

std::optional<Exponential> fit_exponential(const Decay& decay, double from, double to) {
  return fit_between(decay, falls_below(decay, from), falls_below(decay, to));
}

double integral_rate(const Decay& decay, double to) {
  const auto tail = fit_exponential(decay, std::min(0.5, 4 * to), to);
  if (!tail || !(tail->rate > 0)) throw std::domain_error("a mode does not decay");
  const std::size_t last = std::min(falls_below(decay, to), decay.values.size() - 1);
  const double end = static_cast<double>(last) * decay.interval;
  const double rest = tail->amplitude * std::exp(-tail->rate * end) / tail->rate;
  return decay.values.front() / (simpson(decay, last) + rest);
}

double Oscillation::undamped_frequency() const {
  return std::sqrt(rate * rate + frequency * frequency);
}

std::optional<Oscillation> fit_oscillation(const Decay& decay, double undamped_frequency) {
  OscillationFit fit{decay};
  Eigen::Vector2d at(0.2 * undamped_frequency, undamped_frequency);
  double damping = 1e-3, square = fit.square(at[0], at[1]);
  Oscillation best = fit.found;
  for (int round = 0; round < 200; ++round) {
    const Eigen::VectorXd residual = (fit.square(at[0], at[1]), fit.residual);
    Eigen::MatrixXd slopes(residual.size(), 2);
    const double small = 1e-5 * undamped_frequency;
    for (int p = 0; p < 2; ++p) {
      Eigen::Vector2d aside = at;
      aside[p] += small;
      fit.square(aside[0], aside[1]);
      slopes.col(p) = (fit.residual - residual) / small;
    }
    Eigen::Matrix2d normal = slopes.transpose() * slopes;
    normal.diagonal() *= 1 + damping;
    const Eigen::Vector2d move = normal.ldlt().solve(-slopes.transpose() * residual);
    const Eigen::Vector2d next = at + move;
    const double changed = fit.square(next[0], next[1]);
    if (!std::isfinite(changed)) return {};
    if (changed <= square) {
      at = next, square = changed, best = fit.found, damping /= 5;
      if (move.norm() < 1e-9 * undamped_frequency) break;
    } else if ((damping *= 5) > 1e12) {
      break;
    }
  }
  if (!(std::abs(best.frequency) > 1e-3 * undamped_frequency)) return {};
  return best;
}

Estimate jackknife(const std::vector<std::vector<double>>& replicas,
                   const std::function<double(const std::vector<double>&)>& derive) {
  if (replicas.empty()) throw std::invalid_argument("there are no curves to average");
  const auto count = static_cast<double>(replicas.size());
  std::vector<double> sum(replicas.front().size(), 0.0);
  for (const auto& one : replicas) {
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += one.at(n);
  }
  const auto derived = [&](const std::vector<double>* without) {
    std::vector<double> mean = sum;
    for (std::size_t n = 0; n < mean.size(); ++n) {
      mean[n] = without ? (mean[n] - (*without)[n]) / (count - 1) : mean[n] / count;
    }
    try {
      return derive(mean);
    } catch (const std::domain_error&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  };
  Estimate result;
  result.mean = derived(nullptr);
  result.effective_samples = count;
  result.degrees_of_freedom = std::max(1.0, count - 1);
  result.error = std::numeric_limits<double>::infinity();
  if (replicas.size() < 2 || !std::isfinite(result.mean)) return result;
  std::vector<double> parts;
  double mean = 0, square = 0;
  for (const auto& one : replicas) parts.push_back(derived(&one)), mean += parts.back() / count;
  for (const double part : parts) square += (part - mean) * (part - mean);
  const double error = std::sqrt(square * (count - 1) / count);
  if (std::isfinite(error)) result.error = error * student_factor(count - 1);
  return result;
}

}  // namespace driftless::transport
