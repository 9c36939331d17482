#include "experiments/reproduce/interval_arithmetic.hpp"

#include <cmath>

namespace driftless::reproduce {

Interval scaled(const Interval& interval, double factor) {
  const Interval scaled{interval.value * factor, interval.low * factor, interval.high * factor};
  return factor < 0 ? Interval{scaled.value, scaled.high, scaled.low} : scaled;
}

namespace {

Interval with_relative_errors(double value, const Interval& one, const Interval& other) {
  const auto relative = [](const Interval& i) { return (i.high - i.low) / (2 * i.value); };
  const double half = std::abs(value) * std::hypot(relative(one), relative(other));
  return {value, value - half, value + half};
}

}  // namespace

Interval product(const Interval& one, const Interval& other) {
  return with_relative_errors(one.value * other.value, one, other);
}

Interval ratio(const Interval& one, const Interval& other) {
  return with_relative_errors(one.value / other.value, one, other);
}

Interval mean_of(const Interval& a, const Interval& b) {
  const double value = 0.5 * (a.value + b.value);
  const double spread = 0.25 * std::hypot(a.high - a.low, b.high - b.low);
  return {value, value - spread, value + spread};
}

}  // namespace driftless::reproduce
