#include "experiments/compare/difference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace driftless {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Difference, IsJudgedInStudentsLawWithTheFewerDegrees) {
  const auto found = difference({1, 3, 5}, {6, 4, 30});
  EXPECT_DOUBLE_EQ(found.value, 5);
  EXPECT_DOUBLE_EQ(found.error, 5);
  EXPECT_DOUBLE_EQ(found.degrees_of_freedom, 5);
  const boost::math::students_t law(5);
  EXPECT_NEAR(found.probability, 2 * cdf(complement(law, 1)), 1e-12);
  EXPECT_NEAR(difference({0, 1, infinity}, {1.959964 * std::sqrt(2), 1, infinity}).probability,
              0.05, 1e-6);
}

TEST(Difference, WithoutErrorsRoundingAloneIsNone) {
  EXPECT_EQ(difference({1, 0, infinity}, {1 + 1e-15, 0, infinity}).probability, 1);
  EXPECT_EQ(difference({1, 0, infinity}, {1 + 1e-9, 0, infinity}).probability, 0);
  EXPECT_EQ(difference({0, 0, infinity}, {0, 0, infinity}).probability, 1);
}

TEST(Difference, OfVariancesHasSatterthwaitesDegrees) {
  EXPECT_NEAR(difference_of_variances({0, 1, 10}, {1, 1, 10}).degrees_of_freedom, 20, 1e-9);
  // A strength that is all but zero, and hardly known, does not hide a large one.
  EXPECT_NEAR(difference_of_variances({0, 1e-30, 1}, {1, 0.1, 200}).degrees_of_freedom, 200, 1e-6);
}

TEST(Difference, DetectableIsFoundInNineteenOfTwentyCases) {
  const double level = 1e-6;
  const Difference known{0, 2, infinity, 1};
  const double size = detectable_difference(known, level);
  // Normal quantiles at 5e-7 and 0.05.
  EXPECT_NEAR(size, 2 * (4.891638 + 1.644854), 1e-5);
  EXPECT_GT(detectable_difference({0, 2, 5, 1}, level), 3 * size);
}

TEST(Holm, AdjustsStepByStep) {
  const auto adjusted = holm_adjusted({0.03, 0.01, 0.9, 0.011});
  // 4 x 0.01, 3 x 0.011 (not below the one before), 2 x 0.03, 0.9.
  EXPECT_NEAR(adjusted[1], 0.04, 1e-15);
  EXPECT_NEAR(adjusted[3], 0.04, 1e-15);
  EXPECT_NEAR(adjusted[0], 0.06, 1e-15);
  EXPECT_NEAR(adjusted[2], 0.9, 1e-15);
  EXPECT_TRUE(holm_adjusted({}).empty());
}

TEST(Fisher, KnowsTheLadyTastingTea) {
  EXPECT_NEAR(fisher_probability(3, 4, 1, 4), 34.0 / 70, 1e-9);
  EXPECT_NEAR(fisher_probability(0, 4, 4, 4), 2.0 / 70, 1e-9);
  EXPECT_EQ(fisher_probability(0, 4, 0, 4), 1);
  EXPECT_NEAR(fisher_probability(0, 16, 16, 16), 2.0 / 601080390, 1e-15);
}

struct Errors {
  double base_degrees, new_degrees;
  double ratio;  ///< of NEW's true variance to BASE's
};

/// How often chance makes a test that promises `level` find something between equal means, over
/// that level: the normal tail integrated over the laws of both estimated variances.
/// `degrees(share)` is what the test takes for its degrees of freedom where BASE's estimated
/// variance has this share of the sum.
template <class Degrees>
double boldness(const Errors& errors, double level, Degrees&& degrees) {
  constexpr int points = 200;
  const auto nodes = [](double freedom) {
    const boost::math::gamma_distribution<> law(freedom / 2, 2 / freedom);
    const double low = std::log(quantile(law, 1e-14));
    const double high = std::log(quantile(complement(law, 1e-14)));
    std::vector<std::pair<double, double>> result;  // estimate over truth, and its weight
    for (int n = 0; n < points; ++n) {
      const double x = std::exp(low + (high - low) * (n + 0.5) / points);
      result.emplace_back(x, pdf(law, x) * x * (high - low) / points);
    }
    return result;
  };
  const auto other_nodes = nodes(errors.new_degrees);
  double sum = 0;
  for (const auto& [base, base_weight] : nodes(errors.base_degrees)) {
    for (const auto& [other, other_weight] : other_nodes) {
      if (base_weight * other_weight < 1e-22) continue;
      const double variance = base + errors.ratio * other;
      const boost::math::students_t law(degrees(base / variance));
      const double reach =
          quantile(complement(law, level / 2)) * std::sqrt(variance / (1 + errors.ratio));
      sum += base_weight * other_weight * std::erfc(reach / std::sqrt(2.0));
    }
  }
  return sum / level;
}

double boldness_of_the_fewer(const Errors& errors, double level) {
  const double degrees = std::min(errors.base_degrees, errors.new_degrees);
  return boldness(errors, level, [=](double) { return degrees; });
}

double boldness_of_welch(const Errors& errors, double level) {
  return boldness(errors, level, [&](double share) {
    return 1 /
           (share * share / errors.base_degrees + (1 - share) * (1 - share) / errors.new_degrees);
  });
}

TEST(Difference, IsNeverTooBoldFarOutInTheTail) {
  for (const double level : {1e-5, 1e-8}) {
    for (const double ratio : {1.0, 0.1, 0.01, 10.0}) {
      EXPECT_LT(boldness_of_the_fewer({15, 15, ratio}, level), 1.001) << level << " " << ratio;
      EXPECT_LT(boldness_of_the_fewer({3, 15, ratio}, level), 1.001) << level << " " << ratio;
    }
  }
  // With the errors of a study of many samples nothing is given away.
  EXPECT_GT(boldness_of_the_fewer({200, 200, 1}, 1e-8), 0.3);
}

// The test of the test: Welch's degrees of freedom break their promise there.
TEST(Difference, WelchsDegreesAreTooBoldFarOutInTheTail) {
  EXPECT_GT(boldness_of_welch({15, 15, 0.1}, 1e-8), 4);
  EXPECT_GT(boldness_of_welch({3, 15, 0.01}, 1e-8), 1e4);
  EXPECT_NEAR(boldness_of_welch({200, 200, 1}, 1e-8), 1, 0.1);
}

}  // namespace
}  // namespace driftless
