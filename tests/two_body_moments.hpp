#pragma once

#include <array>
#include <cmath>

#include "model/noise.hpp"
#include "tests/two_body_bench.hpp"

/// What is averaged over pairs, and the noise polynomials that sharpen the averages.
namespace driftless::two_body {

/// Moments of the shares of a pair's present energy e, (K, u_i, u_j)/e ~ Dirichlet(1/2, a, a).
/// x is u_i/e or u_j/e (averaged over both), d is (u_i - u_j)/e.
enum Moment {
  kinetic,
  kinetic_squared,
  variance,
  skewness,
  difference,
  difference_2,
  difference_4,
  moments
};
constexpr std::array<const char*, moments> moment_names = {
    "<K/e>", "<(K/e)^2>", "<(x - <x>)^2>", "<(x - <x>)^3>", "<d>", "<d^2>", "<d^4>"};

/// The exact law of the shares: turns a pair's moments into deviations from their expectations.
class ShareLaw {
 public:
  explicit ShareLaw(double shape) : a_(shape), total_(2 * shape + 0.5) {
    const auto x = [&](int i, int j) { return expectation(0, i, j); };
    mean_ = x(1, 0);
    variance_ = x(2, 0) - mean_ * mean_;
    third_ = x(3, 0) - 3 * mean_ * x(2, 0) + 2 * mean_ * mean_ * mean_;
    difference_2_ = 2 * x(2, 0) - 2 * x(1, 1);
    difference_4_ = 2 * x(4, 0) - 8 * x(3, 1) + 6 * x(2, 2);
    kinetic_ = expectation(1, 0, 0);
    kinetic_squared_ = expectation(2, 0, 0);
  }

  /// <K^n u_i^i u_j^j>/e^(n+i+j), a ratio of rising factorials.
  double expectation(int n, int i, int j) const {
    return rising(0.5, n) * rising(a_, i) * rising(a_, j) / rising(total_, n + i + j);
  }

  /// Relative deviations of one pair's moments from their expectations; odd ones in units of the
  /// standard deviation's power.
  std::array<double, moments> deviations(const PairView& pair) const {
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

  static constexpr int controls_per_stage = 10;
  /// Polynomials g(x_n, W) whose expectation is exactly 0 for any method, because the noise W of a
  /// step is independent of the state x_n before it. Their sums over time follow closely how the
  /// moments' averages fluctuate; taken out by regression they leave errors several times smaller.
  std::array<double, controls_per_stage> controls(const PairView& pair,
                                                  const Noise::PairNormals& noise) const {
    const double e = pair.energy();
    const double v = std::copysign(std::sqrt(pair.kinetic / e * total_), pair.velocity);
    const double d = (pair.u_i - pair.u_j) / e * std::sqrt(a_);
    const double w = noise.friction, q = noise.heat, w2 = w * w - 1, q2 = q * q - 1;
    return {v * w, v * v * v * w, v * d * d * w, w2, v * v * w2,
            d * q, d * d * d * q, d * v * v * q, q2, d * d * q2};
  }

 private:
  static double rising(double x, int n) {
    double product = 1;
    for (int k = 0; k < n; ++k) product *= x + k;
    return product;
  }

  double a_, total_;
  double mean_, variance_, third_, difference_2_, difference_4_, kinetic_, kinetic_squared_;
};

}  // namespace driftless::two_body
