#pragma once

#include <array>

#include "experiments/judge/two_body/bench.hpp"
#include "model/noise.hpp"

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
  explicit ShareLaw(double shape);

  /// <K^n u_i^i u_j^j>/e^(n+i+j), a ratio of rising factorials.
  double expectation(int n, int i, int j) const;

  /// Relative deviations of one pair's moments from their expectations; odd ones in units of the
  /// standard deviation's power.
  std::array<double, moments> deviations(const PairView& pair) const;

  static constexpr int controls_per_stage = 10;
  /// Polynomials g(x_n, W) whose expectation is exactly 0 for any method, because the noise W of a
  /// step is independent of the state x_n before it. Their sums over time follow closely how the
  /// moments' averages fluctuate; taken out by regression they leave errors several times smaller.
  std::array<double, controls_per_stage> controls(const PairView& pair,
                                                  const Noise::PairNormals& noise) const;

 private:
  double a_, total_;
  double mean_, variance_, third_, difference_2_, difference_4_, kinetic_, kinetic_squared_;
};

}  // namespace driftless::two_body
