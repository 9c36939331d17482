#include "experiments/energy_drift.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

// Every statistical statement below has a false-alarm rate of at most 1e-8; the seeds are fixed.

namespace driftless {
namespace {

bool too_few(int successes, int trials, double probability) {
  return boost::math::cdf(boost::math::binomial(trials, probability), successes) < 1e-8;
}

bool too_many(int successes, int trials, double probability) {
  return too_few(trials - successes, trials, 1.0 - probability);
}

using Random = std::mt19937_64;

struct Model {
  int replicas;
  int points;
  double walk;         // per unit time
  double fluctuation;  // standard deviation
  double memory;       // correlation time of the fluctuation
};

constexpr double spacing = 0.5;
constexpr double true_slope = 0.03;

std::vector<EnergyTrace> traces_of(Random& random, const Model& model) {
  std::normal_distribution<double> normal;
  const double rho = model.memory > 0.0 ? std::exp(-spacing / model.memory) : 0.0;
  std::vector<EnergyTrace> traces(static_cast<std::size_t>(model.replicas));
  for (EnergyTrace& trace : traces) {
    trace.times = Eigen::VectorXd::LinSpaced(model.points, 7.0, 7.0 + spacing * (model.points - 1));
    trace.energies.resize(model.points);
    double walk = 100.0;
    double fluctuation = normal(random);
    for (Eigen::Index i = 0; i < model.points; ++i) {
      trace.energies[i] = walk + model.fluctuation * fluctuation + true_slope * trace.times[i];
      walk += std::sqrt(model.walk * spacing) * normal(random);
      fluctuation = rho * fluctuation + std::sqrt(1.0 - rho * rho) * normal(random);
    }
  }
  return traces;
}

/// Ordinary regression with the error of independent residuals, for one replica after another.
Estimate regression(const std::vector<EnergyTrace>& traces) {
  double slope = 0.0;
  double variance = 0.0;
  for (const EnergyTrace& trace : traces) {
    const Eigen::ArrayXd times = trace.times.array() - trace.times.mean();
    const Eigen::ArrayXd energies = trace.energies.array() - trace.energies.mean();
    const double own = (times * energies).sum() / times.square().sum();
    const double freedom = static_cast<double>(times.size()) - 2.0;
    slope += own;
    variance += (energies - own * times).square().sum() / freedom / times.square().sum();
  }
  const double count = static_cast<double>(traces.size());
  return {slope / count, std::sqrt(variance) / count, count, false};
}

struct Tally {
  int slope_held = 0;
  int walk_held = 0;
  int walk_seen = 0;
  int regression_held = 0;
  double squared_deviation = 0.0;
  double end_to_end_squared = 0.0;  // of the mean of (E_end - E_start)/T
  double mean_error = 0.0;
};

constexpr int trials = 300;

Tally tally(const Model& model) {
  Random random(2024);
  Tally result;
  for (int i = 0; i < trials; ++i) {
    const auto traces = traces_of(random, model);
    const EnergyDrift drift = energy_drift(traces);
    const double deviation = drift.slope.mean - true_slope;
    const Estimate naive = regression(traces);
    double end_to_end = 0.0;
    for (const EnergyTrace& trace : traces) {
      end_to_end += (trace.energies[model.points - 1] - trace.energies[0]) /
                    (trace.times[model.points - 1] - trace.times[0]) / model.replicas;
    }
    result.slope_held += std::abs(deviation) <= 1.96 * drift.slope.error;
    result.regression_held += std::abs(naive.mean - true_slope) <= 1.96 * naive.error;
    result.walk_held += drift.walk.lower <= model.walk && model.walk <= drift.walk.upper;
    result.walk_seen += drift.walk.lower > 0.0;
    result.squared_deviation += deviation * deviation / trials;
    result.end_to_end_squared += (end_to_end - true_slope) * (end_to_end - true_slope) / trials;
    result.mean_error += drift.slope.error / trials;
  }
  return result;
}

TEST(EnergyDrift, PureWalkWithSlope) {
  const Tally found = tally({4, 200, 0.4, 0.0, 0.0});
  EXPECT_FALSE(too_few(found.slope_held, trials, 0.93)) << found.slope_held;
  EXPECT_FALSE(too_few(found.walk_held, trials, 0.93)) << found.walk_held;
  EXPECT_FALSE(too_few(found.walk_seen, trials, 0.97)) << found.walk_seen;
  // Regression takes the walk for independent residuals.
  EXPECT_TRUE(too_few(found.regression_held, trials, 0.93)) << found.regression_held;
  // Nothing beats the end points here; the fit may lose a few per cent, and the comparison of two
  // strongly correlated means of 300 squares is good to a few more.
  EXPECT_LT(found.squared_deviation, 1.25 * found.end_to_end_squared);
}

TEST(EnergyDrift, BoundedFluctuationWithSlope) {
  const Tally found = tally({4, 400, 0.0, 1.0, 1.5});
  EXPECT_FALSE(too_few(found.slope_held, trials, 0.95)) << found.slope_held;
  EXPECT_FALSE(too_few(trials - found.walk_seen, trials, 0.95)) << found.walk_seen;
  EXPECT_TRUE(too_few(found.regression_held, trials, 0.93)) << found.regression_held;
  // The end points alone are ten times as uncertain, and so would be an error that took the
  // fluctuation for a walk.
  EXPECT_LT(found.squared_deviation, 0.2 * found.end_to_end_squared);
  EXPECT_LT(found.mean_error, 2.5 * std::sqrt(found.squared_deviation));
}

TEST(EnergyDrift, IndependentFluctuationWithSlope) {
  const Tally found = tally({4, 100, 0.0, 1.0, 0.0});
  EXPECT_FALSE(too_few(found.slope_held, trials, 0.95)) << found.slope_held;
  EXPECT_FALSE(too_few(found.walk_held, trials, 0.95)) << found.walk_held;
  EXPECT_LT(found.squared_deviation, 0.1 * found.end_to_end_squared);
  EXPECT_LT(found.mean_error, 2.5 * std::sqrt(found.squared_deviation));
}

TEST(EnergyDrift, WalkUnderALargerFluctuation) {
  const Tally found = tally({4, 400, 0.02, 1.0, 0.0});
  EXPECT_FALSE(too_few(found.slope_held, trials, 0.92)) << found.slope_held;
  EXPECT_FALSE(too_few(found.walk_held, trials, 0.93)) << found.walk_held;
  EXPECT_FALSE(too_few(found.walk_seen, trials, 0.90)) << found.walk_seen;
  EXPECT_TRUE(too_few(found.regression_held, trials, 0.92)) << found.regression_held;
}

TEST(EnergyDrift, FewPointsOrOneReplica) {
  EXPECT_FALSE(too_few(tally({1, 200, 0.4, 0.0, 0.0}).slope_held, trials, 0.90));
  EXPECT_FALSE(too_few(tally({4, 6, 0.4, 0.0, 0.0}).slope_held, trials, 0.90));
  EXPECT_FALSE(too_few(tally({2, 6, 0.0, 1.0, 0.0}).slope_held, trials, 0.93));
  EXPECT_FALSE(too_many(tally({4, 20, 0.4, 0.1, 0.0}).slope_held, trials, 0.99));
}

TEST(EnergyDrift, ReportsTheStrengths) {
  Random random(3);
  const EnergyDrift drift = energy_drift(traces_of(random, {8, 1000, 0.02, 1.0, 0.0}));
  // Six standard errors: of some 250 increments, and of 8000 independent fluctuations.
  EXPECT_NEAR(drift.walk.value, 0.02, 0.02 * 6.0 * std::sqrt(2.0 / 100.0));
  EXPECT_NEAR(drift.fluctuation, 1.0, 6.0 / std::sqrt(8000.0));
  EXPECT_GT(drift.walk.effective_increments, 50.0);
  EXPECT_LE(drift.walk.effective_increments, 512.0);
  EXPECT_LT(drift.walk.lower, drift.walk.value);
  EXPECT_GT(drift.walk.upper, drift.walk.value);
}

EnergyTrace trace(int points, double start, double slope) {
  EnergyTrace result;
  result.times = Eigen::VectorXd::LinSpaced(points, 0.0, spacing * (points - 1));
  result.energies = start + slope * result.times.array();
  return result;
}

TEST(EnergyDrift, LineIsExact) {
  const EnergyDrift drift = energy_drift({trace(50, 1.0, 0.25), trace(50, 2.0, 0.25)});
  EXPECT_NEAR(drift.slope.mean, 0.25, 1e-14);
  EXPECT_LT(drift.slope.error, 1e-14);
  EXPECT_LT(drift.walk.upper, 1e-26);
  EXPECT_LT(drift.fluctuation, 1e-13);
}

TEST(EnergyDrift, ConstantHasNeitherDriftNorWalk) {
  const EnergyDrift drift = energy_drift({trace(50, 0.1, 0.0), trace(30, 0.3, 0.0)});
  EXPECT_EQ(drift.slope.mean, 0.0);
  EXPECT_EQ(drift.slope.error, 0.0);
  EXPECT_EQ(drift.walk.value, 0.0);
  EXPECT_EQ(drift.walk.upper, 0.0);
  EXPECT_EQ(drift.fluctuation, 0.0);
}

TEST(EnergyDrift, RoundingIsMeasuredLikeAnythingElse) {
  // Energies that jump between neighbouring doubles now and then.
  Random random(4);
  std::bernoulli_distribution jump(0.2);
  std::vector<EnergyTrace> traces;
  for (int replica = 0; replica < 4; ++replica) {
    traces.push_back(trace(100, 1000.0, 0.0));
    for (double& energy : traces.back().energies) {
      if (jump(random)) energy = std::nextafter(energy, 2000.0);
    }
  }
  const EnergyDrift drift = energy_drift(traces);
  EXPECT_LT(std::abs(drift.slope.mean), 6.0 * drift.slope.error);
  EXPECT_GT(drift.slope.error, 0.0);
  EXPECT_LT(drift.slope.error, 1e-14);
  EXPECT_NEAR(drift.fluctuation, 0.4 * std::pow(2.0, -43), 0.2 * std::pow(2.0, -43));
}

TEST(EnergyDrift, ReplicaThatDriftsOtherwiseDecidesTheError) {
  Random random(5);
  auto traces = traces_of(random, {4, 200, 0.0, 1.0, 0.0});
  EXPECT_FALSE(energy_drift(traces).slope.replicas_disagree);
  traces[0].energies += 1.0 * traces[0].times;
  const EnergyDrift drift = energy_drift(traces);
  EXPECT_GT(1.96 * drift.slope.error, 0.25);  // the mean slope is 0.25 off the other three's
}

TEST(EnergyDrift, ReplicasMayEndEarly) {
  Random random(6);
  auto traces = traces_of(random, {4, 200, 0.4, 0.0, 0.0});
  for (const Eigen::Index left : {1, 2, 40}) {
    traces[0].times = traces[0].times.head(std::min(left, traces[0].times.size())).eval();
    traces[0].energies = traces[0].energies.head(traces[0].times.size()).eval();
    const EnergyDrift drift = energy_drift(traces);
    EXPECT_LT(std::abs(drift.slope.mean - true_slope), 6.0 * drift.slope.error);
    EXPECT_LT(drift.slope.error, 0.2);
  }
}

TEST(EnergyDrift, TwoPointsHaveNoError) {
  const EnergyDrift drift = energy_drift({trace(2, 1.0, 0.25)});
  EXPECT_DOUBLE_EQ(drift.slope.mean, 0.25);
  EXPECT_EQ(drift.slope.error, std::numeric_limits<double>::infinity());
}

TEST(EnergyDrift, RefusesWhatIsNoTrace) {
  EXPECT_THROW(energy_drift({}), std::invalid_argument);
  EXPECT_THROW(energy_drift({trace(1, 1.0, 0.0)}), std::invalid_argument);
  EnergyTrace uneven = trace(5, 1.0, 0.0);
  uneven.times[2] += 0.1;
  EXPECT_THROW(energy_drift({uneven}), std::invalid_argument);
  EnergyTrace short_energies = trace(5, 1.0, 0.0);
  short_energies.energies.conservativeResize(4);
  EXPECT_THROW(energy_drift({short_energies}), std::invalid_argument);
  EnergyTrace infinite = trace(5, 1.0, 0.0);
  infinite.energies[1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(energy_drift({infinite}), std::invalid_argument);
  EnergyTrace other_spacing = trace(5, 1.0, 0.0);
  other_spacing.times *= 2.0;
  EXPECT_THROW(energy_drift({trace(5, 1.0, 0.0), other_spacing}), std::invalid_argument);
}

}  // namespace
}  // namespace driftless
