#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "experiments/judge/two_body/ensemble.hpp"
#include "experiments/judge/two_body/moments.hpp"

/// Time averages over an ensemble of pairs, with errors from the scatter of independent copies.
namespace driftless::two_body {

using Factory = std::function<std::unique_ptr<Integrator>()>;

struct Measured {
  double mean = 0;
  double error = 0;
};

struct Schedule {
  double dt = 0.1;
  double settle = 4;           ///< relaxation times before the averages
  double measure = 16;         ///< relaxation times of the averages
  std::size_t ensembles = 20;  ///< run one by one, each with its own noise
  Pairs pairs = {};
};

struct Outcome {
  std::vector<Measured> deviations;  ///< by Moment
  Measured energy_rate;              ///< d ln e/dt of a pair, times <e>/kT
  double energy_change = 0;          ///< median of |e(end)/e(start) - 1|
  double largest_energy_change = 0;  ///< and the largest one
  double momentum_change = 0;        ///< largest of all pairs, in m times the thermal speed
  double failed_fraction = 0;        ///< of all pairs
};

/// Mean of each column of y where the regressors x have expectation 0: the intercept of y on x by
/// least squares, with its standard error from the residuals of the independent rows.
std::vector<Measured> regressed_means(const Eigen::MatrixXd& y, const Eigen::MatrixXd& x);

Measured mean_of(const std::vector<double>& values);

/// How many independent noises of a pair a step of the method uses, from what the system counts.
unsigned stages_of(const Bench& bench, const Factory& make);

/// Runs the ensembles and measures. Throws StepFailure if no copy is to blame for one.
Outcome measure(const Bench& bench, const Factory& make, const Schedule& run);

}  // namespace driftless::two_body
