#include "model/coefficient_law.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "model/differentiable.hpp"

namespace driftless {
namespace {

void require(bool allowed, const char* name, double value, const char* range) {
  if (allowed && std::isfinite(value)) return;
  std::ostringstream message;
  message << name << " is " << value << ", allowed is " << range;
  throw std::invalid_argument(message.str());
}

/// A place where a law is tried.
struct Sample {
  double distance, theta_i, theta_j;
};

[[noreturn]] void refuse(const Sample& at, const std::string& complaint) {
  std::ostringstream message;
  message << "the law of a coefficient is refused at distance " << at.distance
          << " and temperatures " << at.theta_i << " and " << at.theta_j << ": " << complaint;
  throw std::invalid_argument(message.str());
}

bool close(double a, double b, double relative) {
  return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

using Factor = std::function<Coefficient<double>(double, double, double)>;

/// What is wrong with g at one place; nothing returns if nothing is.
void check(const Factor& factor, const Sample& at) {
  const auto g = factor(at.distance, at.theta_i, at.theta_j);
  const auto swapped = factor(at.distance, at.theta_j, at.theta_i);
  const auto text = [](double value) {
    std::ostringstream stream;
    stream << value;
    return stream.str();
  };
  if (!std::isfinite(g.value) || !std::isfinite(g.by_theta_i) || !std::isfinite(g.by_theta_j)) {
    refuse(at, "its value or a derivative is not a finite number");
  }
  if (!(g.value > 0)) refuse(at, "it is " + text(g.value) + ", allowed is > 0");
  if (!close(g.value, swapped.value, 1e-10)) {
    refuse(at, "it is " + text(g.value) + ", but " + text(swapped.value) +
                   " with the temperatures exchanged; it has to be the same");
  }
  // By differences of 1e-5 theta, which err by about 1e-10 g/theta.
  const double h = 1e-5 * at.theta_i;
  const double slope = (factor(at.distance, at.theta_i + h, at.theta_j).value -
                        factor(at.distance, at.theta_i - h, at.theta_j).value) /
                       (2 * h);
  if (std::abs(slope - g.by_theta_i) > 1e-5 * (std::abs(slope) + g.value / at.theta_i)) {
    refuse(at, "its derivative by the first temperature is said to be " + text(g.by_theta_i) +
                   ", but is " + text(slope));
  }
}

}  // namespace

CoefficientLaw CoefficientLaw::power(double exponent, double temperature) {
  require(true, "exponent", exponent, "any finite number");
  require(temperature > 0, "temperature", temperature, "> 0");
  CoefficientLaw law;
  if (exponent == 0) return law;
  law.form_ = Form::power;
  law.half_exponent_ = 0.5 * exponent;
  law.inverse_temperature_squared_ = 1 / (temperature * temperature);
  return law;
}

CoefficientLaw CoefficientLaw::any(Function function, double temperature, double range) {
  require(temperature > 0, "temperature", temperature, "> 0");
  require(range > 0, "range", range, "> 0");
  CoefficientLaw law;
  law.form_ = Form::any;
  law.function_ = std::make_shared<const Function>(std::move(function));
  const Factor factor = [&](double r, double i, double j) { return law.evaluate(r, i, j); };
  // No round numbers, where laws may have kinks.
  constexpr double temperatures[] = {0.31, 0.57, 1.13, 1.93, 3.71};
  for (const double r : {0.07, 0.43, 0.91}) {
    for (const double i : temperatures) {
      for (const double j : temperatures) {
        check(factor, {r * range, i * temperature, j * temperature});
      }
    }
  }
  return law;
}

Coefficient<double> CoefficientLaw::evaluate(double distance, double theta_i,
                                             double theta_j) const {
  const Differentiable g =
      (*function_)(distance, Differentiable(theta_i, 2, 0), Differentiable(theta_j, 2, 1));
  return {g.value(), g.derivatives()[0], g.derivatives()[1]};
}

}  // namespace driftless
