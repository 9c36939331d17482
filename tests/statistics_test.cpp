#include "experiments/statistics.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "experiments/autocorrelation.hpp"

// Every statistical statement below has a false-alarm rate of at most 1e-8; the seeds are fixed.

namespace driftless {
namespace {

constexpr double false_alarm = 1e-8;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// True if so few successes happen with at most the false-alarm rate when each has `probability`.
bool too_few(int successes, int trials, double probability) {
  return boost::math::cdf(boost::math::binomial(trials, probability), successes) < false_alarm;
}

bool too_many(int successes, int trials, double probability) {
  return too_few(trials - successes, trials, 1.0 - probability);
}

using Random = std::mt19937_64;

/// Stationary series of mean 0 and variance 1 with autocorrelation rho^t.
Eigen::VectorXd autoregressive(Random& random, Eigen::Index count, double time) {
  const double rho = (2.0 * time - 1.0) / (2.0 * time + 1.0);
  std::normal_distribution<double> normal;
  Eigen::VectorXd series(count);
  double value = normal(random);
  for (double& sample : series) {
    sample = value;
    value = rho * value + std::sqrt(1.0 - rho * rho) * normal(random);
  }
  return series;
}

std::vector<Eigen::VectorXd> runs_of(Random& random, int replicas, Eigen::Index count,
                                     double time) {
  std::vector<Eigen::VectorXd> runs;
  for (int i = 0; i < replicas; ++i) runs.push_back(autoregressive(random, count, time));
  return runs;
}

/// The error of somebody who takes all samples for independent.
Estimate naive_estimate(const std::vector<Eigen::VectorXd>& replicas) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const Eigen::VectorXd& replica : replicas) {
    sum += replica.sum();
    squares += replica.squaredNorm();
    count += static_cast<double>(replica.size());
  }
  const double mean = sum / count;
  return {mean, std::sqrt((squares / count - mean * mean) / (count - 1.0)), count, false};
}

/// Number of intervals mean +- 1.96 error that hold the true value 0.
template <typename Method>
int covered(int trials, int replicas, Eigen::Index count, double time, Method method) {
  Random random(12345);
  int result = 0;
  for (int i = 0; i < trials; ++i) {
    const Estimate made = method(runs_of(random, replicas, count, time));
    if (std::abs(made.mean) <= 1.96 * made.error) ++result;
  }
  return result;
}

struct Runs {
  int replicas;
  Eigen::Index samples;
  double time;
  double least_coverage;  // claimed
  int trials() const { return samples > 50 ? 1500 : 8000; }
};

class Coverage : public testing::TestWithParam<Runs> {};

TEST_P(Coverage, HoldsAndIsNotBoughtByHugeErrors) {
  const auto [replicas, samples, time, least] = GetParam();
  const int trials = GetParam().trials();
  const int found = covered(trials, replicas, samples, time,
                            [](const auto& runs) { return estimate_mean(runs); });
  EXPECT_FALSE(too_few(found, trials, least)) << found;
  EXPECT_FALSE(too_many(found, trials, 0.995)) << found;
}

TEST_P(Coverage, NaiveErrorIsCaught) {
  const auto [replicas, samples, time, least] = GetParam();
  if (time < 1.0) return;  // for independent samples it is right
  const int trials = GetParam().trials();
  EXPECT_TRUE(too_few(covered(trials, replicas, samples, time, naive_estimate), trials, least));
}

INSTANTIATE_TEST_SUITE_P(Autoregressive, Coverage,
                         testing::Values(Runs{1, 400, 0.5, 0.94}, Runs{1, 1000, 10.0, 0.94},
                                         Runs{4, 400, 10.0, 0.94}, Runs{8, 200, 5.0, 0.94},
                                         // short runs, down to 5 and 2 autocorrelation times
                                         Runs{4, 50, 10.0, 0.94}, Runs{8, 20, 10.0, 0.94},
                                         Runs{4, 20, 10.0, 0.95}, Runs{1, 100, 10.0, 0.92},
                                         Runs{1, 50, 10.0, 0.91}, Runs{1, 20, 10.0, 0.89}));

TEST(AutocovarianceSum, MakesUpForTheMeansTakenOff) {
  constexpr int trials = 600;
  constexpr double time = 5.0;
  Random random(9);
  double sum = 0.0;
  double taken_for_one_mean = 0.0;
  for (int i = 0; i < trials; ++i) {
    std::vector<Eigen::VectorXd> runs = runs_of(random, 8, 200, time);
    for (Eigen::VectorXd& run : runs) run.array() -= run.mean();
    sum += autocovariance_sum(runs, 8.0).sum / trials;
    taken_for_one_mean += autocovariance_sum(runs, 1.0).sum / trials;
  }
  // Each sum is known to 20 %, their mean to less than 1; the window cuts off another 3 to 5.
  EXPECT_GT(sum, 0.90 * 2.0 * time);
  EXPECT_LT(sum, 1.05 * 2.0 * time);
  EXPECT_LT(taken_for_one_mean, 0.90 * 2.0 * time);
}

TEST(AutocovarianceSum, ComparesVariancesByTheFTest) {
  EXPECT_NEAR(exceeds_by_chance(4.7571, 3.0, 1.0, 6.0), 0.05, 1e-4);  // tabulated
  EXPECT_EQ(exceeds_by_chance(0.0, 3.0, 0.0, 6.0), 1.0);
  EXPECT_EQ(exceeds_by_chance(1.0, 3.0, 0.0, 6.0), 0.0);
}

TEST(AutocorrelationTime, IsThatOfTheSeries) {
  Random random(1);
  constexpr double time = 10.0;
  const Eigen::VectorXd series = autoregressive(random, 200000, time);
  // Standard error of the time [Wolff, eq. 42] with a window of at most 8 times; six of them, and
  // what the window cuts off.
  const double bound = time * (6.0 * std::sqrt((4.0 * 8.0 * time + 2.0) / 200000.0) + 0.01);
  EXPECT_NEAR(autocorrelation_time(series), time, bound);
  const Eigen::VectorXd slower = autoregressive(random, 200000, 1.5 * time);
  EXPECT_GT(std::abs(autocorrelation_time(slower) - time), bound);
}

TEST(AutocorrelationTime, IsOneHalfWithoutAndWithNegativeCorrelation) {
  Random random(2);
  EXPECT_NEAR(autocorrelation_time(autoregressive(random, 100000, 0.5)), 0.5, 0.05);
  EXPECT_EQ(autocorrelation_time(autoregressive(random, 1000, 0.1)), 0.5);
  EXPECT_EQ(autocorrelation_time(Eigen::VectorXd::Constant(10, 0.1)), 0.5);
}

TEST(Estimate, EffectiveSamplesCountIndependentOnes) {
  Random random(3);
  const Estimate made = estimate_mean({autoregressive(random, 200000, 10.0)});
  EXPECT_NEAR(made.effective_samples, 10000.0, 2500.0);  // as for the time
  EXPECT_NEAR(made.error, 0.01, 0.00125);
  EXPECT_LE(estimate_mean({autoregressive(random, 1000, 0.2)}).effective_samples, 1000.0);
}

TEST(Estimate, AnticorrelatedSeriesGetsNoSmallerErrorThanIndependentOne) {
  Eigen::VectorXd series(1000);
  for (Eigen::Index i = 0; i < series.size(); ++i) series[i] = i % 2 == 0 ? 1.0 : -1.0;
  EXPECT_GE(estimate_mean({series}).error, 1.0 / std::sqrt(1000.0));
}

TEST(Estimate, RatioOfCorrelatedQuantities) {
  // x = 2 + a, y = 4 + a + b: the ratio's linearised series is (a - (a + b)/2)/4 = (a - b)/8.
  constexpr int trials = 800;
  Random random(4);
  int held = 0;
  int held_with_numerator_alone = 0;
  double errors = 0.0;
  for (int i = 0; i < trials; ++i) {
    std::vector<Eigen::MatrixXd> replicas;
    for (int replica = 0; replica < 3; ++replica) {
      Eigen::MatrixXd samples(300, 2);
      const Eigen::VectorXd a = autoregressive(random, 300, 3.0);
      const Eigen::VectorXd b = autoregressive(random, 300, 3.0);
      samples.col(0) = a.array() + 2.0;
      samples.col(1) = (a + b).array() + 4.0;
      replicas.push_back(samples);
    }
    const Estimate ratio = estimate(replicas, [](const auto& m) { return m[0] / m[1]; });
    const Estimate frozen = estimate(replicas, [](const auto& m) { return m[0] / 4.0 - 0.0; });
    held += std::abs(ratio.mean - 0.5) <= 1.96 * ratio.error;
    held_with_numerator_alone += std::abs(ratio.mean - 0.5) <= 1.96 * 0.3 * frozen.error;
    errors += ratio.error / trials;
  }
  EXPECT_FALSE(too_few(held, trials, 0.94)) << held;
  EXPECT_FALSE(too_many(held, trials, 0.99)) << held;
  EXPECT_TRUE(too_few(held_with_numerator_alone, trials, 0.94));
  const double exact = std::sqrt(2.0) / 8.0 * std::sqrt(2.0 * 3.0 / 900.0);
  EXPECT_NEAR(errors, exact, 0.1 * exact);  // each is uncertain by some 12 %, their mean by 0.5 %
}

TEST(Estimate, ReplicasTakeTheBiasOfFirstOrderAway) {
  // The square of a mean of 20 samples is 1/20 too large on average.
  constexpr int trials = 20000;
  Random random(5);
  double corrected = 0.0;
  double plain = 0.0;
  const DerivedQuantity square = [](const Eigen::VectorXd& means) { return means[0] * means[0]; };
  for (int i = 0; i < trials; ++i) {
    std::vector<Eigen::MatrixXd> replicas;
    Eigen::VectorXd all(20);
    for (int replica = 0; replica < 4; ++replica) {
      const Eigen::VectorXd run = autoregressive(random, 5, 0.5);
      replicas.emplace_back(run);
      all.segment(5 * replica, 5) = run;
    }
    corrected += estimate(replicas, square).mean / trials;
    plain += square(Eigen::VectorXd::Constant(1, all.mean())) / trials;
  }
  // Variance of the corrected square: 2/20^2 (1 + 1/3).
  const double bound = 6.0 * std::sqrt(2.0 / 400.0 * 4.0 / 3.0 / trials);
  EXPECT_NEAR(corrected, 0.0, bound);
  EXPECT_GT(plain, bound);
}

TEST(Estimate, DisagreeingReplicaIsFoundAndWidensTheError) {
  Random random(6);
  std::vector<Eigen::VectorXd> runs = runs_of(random, 4, 1000, 5.0);
  runs[2].array() += 1.0;  // ten standard errors of its mean
  const Estimate made = estimate_mean(runs);
  EXPECT_TRUE(made.replicas_disagree);
  // True mean of the other three is 0: the interval must reach it, from 0.25.
  EXPECT_GT(1.96 * made.error, 0.25);
  EXPECT_LT(made.effective_samples, 40.0);
}

TEST(Estimate, AgreeingReplicasAreSeldomAccused) {
  constexpr int trials = 2000;
  const auto accused = [](double spread) {
    Random random(7);
    std::normal_distribution<double> normal;
    int result = 0;
    for (int i = 0; i < trials; ++i) {
      std::vector<Eigen::VectorXd> runs = runs_of(random, 4, 500, 5.0);
      for (Eigen::VectorXd& run : runs) run.array() += spread * normal(random);
      result += estimate_mean(runs).replicas_disagree;
    }
    return result;
  };
  EXPECT_FALSE(too_many(accused(0.0), trials, 0.015));
  EXPECT_TRUE(too_many(accused(0.15), trials, 0.015));  // about one standard error of a run
}

TEST(Estimate, ConstantSeriesIsCertain) {
  const Estimate made = estimate_mean({Eigen::VectorXd::Constant(7, 0.1)});
  EXPECT_EQ(made.mean, 0.1);
  EXPECT_EQ(made.error, 0.0);
  EXPECT_EQ(made.effective_samples, 7.0);
  const auto constants = [](double one, double other) {
    return estimate_mean({Eigen::VectorXd::Constant(5, one), Eigen::VectorXd::Constant(5, other)});
  };
  EXPECT_FALSE(constants(0.1, 0.1).replicas_disagree);
  EXPECT_FALSE(constants(0.1, std::nextafter(0.1, 1.0)).replicas_disagree);
  const Estimate different = constants(0.1, 0.2);
  EXPECT_TRUE(different.replicas_disagree);
  EXPECT_GT(different.error, 0.3);  // two values: Student's factor is 6.5
}

TEST(Estimate, OneSampleHasNoError) {
  EXPECT_EQ(estimate_mean({Eigen::VectorXd::Constant(1, 3.0)}).error, infinity);
  const Estimate two =
      estimate_mean({Eigen::VectorXd::Constant(1, 3.0), Eigen::VectorXd::Constant(1, 4)});
  EXPECT_GT(two.error, 3.0);
  EXPECT_LT(two.error, infinity);
}

TEST(Estimate, DerivedQuantityThatIsNotFiniteNearTheMeansHasNoError) {
  const Eigen::MatrixXd samples{{0.1}, {0.0}, {0.2}, {0.5}};
  const auto wall = [](double at) {
    return [at](const Eigen::VectorXd& m) { return m[0] < at ? infinity : m[0]; };
  };
  EXPECT_EQ(estimate({samples}, wall(0.15)).error, infinity);
  EXPECT_THROW(estimate({samples}, wall(0.3)), std::domain_error);
}

TEST(Estimate, RefusesBadSamples) {
  const DerivedQuantity first = [](const Eigen::VectorXd& means) { return means[0]; };
  EXPECT_THROW(estimate({}, first), std::invalid_argument);
  EXPECT_THROW(estimate({Eigen::MatrixXd(0, 1)}, first), std::invalid_argument);
  EXPECT_THROW(estimate({Eigen::MatrixXd::Ones(3, 1), Eigen::MatrixXd::Ones(3, 2)}, first),
               std::invalid_argument);
  EXPECT_THROW(estimate_mean({Eigen::VectorXd::Constant(3, infinity)}), std::invalid_argument);
  EXPECT_THROW(autocorrelation_time(Eigen::VectorXd()), std::invalid_argument);
}

TEST(Estimate, ReplicasOfDifferentLengthAreWeightedByTheirSamples) {
  EXPECT_EQ(estimate_mean({Eigen::VectorXd::Zero(30), Eigen::VectorXd::Zero(0),
                           Eigen::VectorXd::Constant(10, 4.0)})
                .mean,
            1.0);
}

TEST(AgreementZ, IsFiniteAndCountsBothErrors) {
  EXPECT_DOUBLE_EQ(agreement_z({1.0, 3.0, 1, false}, {11.0, 4.0, 1, false}), 2.0);
  EXPECT_EQ(agreement_z({0.3, 0.0, 1, false}, {0.1 + 0.2, 0.0, 1, false}), 0.0);
  EXPECT_EQ(agreement_z({1.0, 0.0, 1, false}, {2.0, 0.0, 1, false}), 1e6);
  EXPECT_EQ(agreement_z({1.0, infinity, 1, false}, {2.0, 0.0, 1, false}), 0.0);
}

TEST(StudentQuantile, IsThatOfTheTables) {
  EXPECT_NEAR(student_quantile(3.0, 0.005), 5.8409, 1e-4);
  EXPECT_NEAR(student_quantile(infinity, 0.025), interval_quantile, 1e-12);
  EXPECT_EQ(student_quantile(0.2, 0.05), student_quantile(1.0, 0.05));
}

TEST(StudentFactor, IsTheRatioOfQuantiles) {
  EXPECT_NEAR(student_factor(1.0), 12.7062 / 1.95996, 1e-4);
  EXPECT_NEAR(student_factor(10.0), 2.22814 / 1.95996, 1e-5);
  EXPECT_EQ(student_factor(1e9), 1.0);
}

}  // namespace
}  // namespace driftless
