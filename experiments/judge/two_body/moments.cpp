#include "experiments/judge/two_body/moments.hpp"

#include <cmath>

namespace driftless::two_body {
namespace {

double rising(double x, int n) {
  double product = 1;
  for (int k = 0; k < n; ++k) product *= x + k;
  return product;
}

}  // namespace

ShareLaw::ShareLaw(double shape) : a_(shape), total_(2 * shape + 0.5) {
  const auto x = [&](int i, int j) { return expectation(0, i, j); };
  mean_ = x(1, 0);
  variance_ = x(2, 0) - mean_ * mean_;
  third_ = x(3, 0) - 3 * mean_ * x(2, 0) + 2 * mean_ * mean_ * mean_;
  difference_2_ = 2 * x(2, 0) - 2 * x(1, 1);
  difference_4_ = 2 * x(4, 0) - 8 * x(3, 1) + 6 * x(2, 2);
  kinetic_ = expectation(1, 0, 0);
  kinetic_squared_ = expectation(2, 0, 0);
}

double ShareLaw::expectation(int n, int i, int j) const {
  return rising(0.5, n) * rising(a_, i) * rising(a_, j) / rising(total_, n + i + j);
}

std::array<double, moments> ShareLaw::deviations(const PairView& pair) const {
  const double e = pair.energy(), share = pair.kinetic / e;
  const double x = pair.u_i / e - mean_, y = pair.u_j / e - mean_, d = x - y;
  return {share / kinetic_ - 1,
          share * share / kinetic_squared_ - 1,
          0.5 * (x * x + y * y) / variance_ - 1,
          (0.5 * (x * x * x + y * y * y) - third_) / (variance_ * std::sqrt(variance_)),
          d / std::sqrt(difference_2_),
          d * d / difference_2_ - 1,
          d * d * d * d / difference_4_ - 1};
}

std::array<double, ShareLaw::controls_per_stage> ShareLaw::controls(
    const PairView& pair, const Noise::PairNormals& noise) const {
  const double e = pair.energy();
  const double v = std::copysign(std::sqrt(pair.kinetic / e * total_), pair.velocity);
  const double d = (pair.u_i - pair.u_j) / e * std::sqrt(a_);
  const double w = noise.friction, q = noise.heat, w2 = w * w - 1, q2 = q * q - 1;
  return {v * w, v * v * v * w, v * d * d * w, w2, v * v * w2,
          d * q, d * d * d * q, d * v * v * q, q2, d * d * q2};
}

}  // namespace driftless::two_body
