#include "experiments/binned_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace driftless {
namespace {

/// Distribution function of a Beta law, and of the signed root law with shape b.
double beta_cdf(double a, double b, double x) { return boost::math::ibeta(a, b, x); }
double root_cdf(double b, double x) {
  return 0.5 + std::copysign(0.5 * boost::math::ibeta(0.5, b, x * x), x);
}

std::size_t bin_by_search(const BinnedLaw& law, double sample) {
  const auto first = law.edges().begin() + 1;
  const auto last = law.edges().end() - 1;
  return static_cast<std::size_t>(std::upper_bound(first, last, sample) - first);
}

void expect_bins_found(const BinnedLaw& law) {
  for (const double edge : law.edges()) {
    for (const double sample : {edge, std::nextafter(edge, -2.0), std::nextafter(edge, 2.0)}) {
      ASSERT_EQ(law.bin(sample), bin_by_search(law, sample)) << sample;
    }
  }
  std::mt19937_64 random(1);
  const double first = law.edges()[1];
  const double last = law.edges()[law.bins() - 1];
  const double margin = 0.2 * (last - first) + 1e-3;
  std::uniform_real_distribution<double> uniform(first - margin, last + margin);
  for (int i = 0; i < 100000; ++i) {
    const double sample = uniform(random);
    ASSERT_EQ(law.bin(sample), bin_by_search(law, sample)) << sample;
  }
}

struct Shapes {
  double a, b;
  std::size_t bins;
};

class BetaLaw : public testing::TestWithParam<Shapes> {};

TEST_P(BetaLaw, EdgesHaveEqualProbability) {
  const auto [a, b, bins] = GetParam();
  const BinnedLaw law = BinnedLaw::beta(a, b, bins);
  ASSERT_EQ(law.bins(), bins);
  EXPECT_EQ(law.edges().front(), 0.0);
  EXPECT_EQ(law.edges().back(), 1.0);
  for (std::size_t i = 1; i < bins; ++i) {
    EXPECT_NEAR(beta_cdf(a, b, law.edges()[i]) * static_cast<double>(bins), static_cast<double>(i),
                1e-8);
  }
  // The test of the test: another law's edges are told from these.
  EXPECT_GT(std::abs(beta_cdf(1.01 * a, b, law.edges()[bins / 2]) - 0.5), 1e-6);
}

TEST_P(BetaLaw, FindsBins) {
  const auto [a, b, bins] = GetParam();
  expect_bins_found(BinnedLaw::beta(a, b, bins));
}

INSTANTIATE_TEST_SUITE_P(Laws, BetaLaw,
                         testing::Values(Shapes{51, 51.0 * 8000, 256}, Shapes{61, 1e7, 256},
                                         Shapes{4, 20, 256}, Shapes{0.5, 8, 256}, Shapes{2, 2, 4},
                                         Shapes{2, 2, 2}, Shapes{1.5, 100, 37}));

TEST(SignedRootLaw, EdgesAreMirroredAndHaveEqualProbability) {
  for (const std::size_t bins : {256u, 37u, 2u}) {
    for (const double b : {1.0, 51.5, 4e5}) {
      const BinnedLaw law = BinnedLaw::signed_root(b, bins);
      EXPECT_EQ(law.edges().front(), -1.0);
      EXPECT_EQ(law.edges().back(), 1.0);
      for (std::size_t i = 1; i < bins; ++i) {
        EXPECT_EQ(law.edges()[i], -law.edges()[bins - i]);
        EXPECT_NEAR(root_cdf(b, law.edges()[i]) * static_cast<double>(bins), static_cast<double>(i),
                    1e-8);
      }
      expect_bins_found(law);
    }
  }
}

TEST(NormalLaw, EdgesAreMirroredAndHaveEqualProbability) {
  for (const std::size_t bins : {256u, 37u, 2u}) {
    const BinnedLaw law = BinnedLaw::normal(bins);
    EXPECT_EQ(law.edges().back(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 1; i < bins; ++i) {
      EXPECT_EQ(law.edges()[i], -law.edges()[bins - i]);
      EXPECT_NEAR(0.5 * std::erfc(-law.edges()[i] / std::sqrt(2)) * static_cast<double>(bins),
                  static_cast<double>(i), 1e-8);
    }
    EXPECT_EQ(law.density(0), 0);
    EXPECT_EQ(law.bin(-1e9), 0u);
    EXPECT_EQ(law.bin(1e9), bins - 1);
    EXPECT_EQ(law.bin(0), bins / 2);
  }
  EXPECT_THROW(BinnedLaw::normal(1), std::invalid_argument);
}

TEST(BinnedLaw, EndBinsTakeWhatIsOutside) {
  const BinnedLaw law = BinnedLaw::beta(3.0, 4.0, 16);
  EXPECT_EQ(law.bin(-1.0), 0u);
  EXPECT_EQ(law.bin(-std::numeric_limits<double>::infinity()), 0u);
  EXPECT_EQ(law.bin(std::numeric_limits<double>::quiet_NaN()), 0u);
  EXPECT_EQ(law.bin(1.0), 15u);
  EXPECT_EQ(law.bin(std::numeric_limits<double>::infinity()), 15u);
}

TEST(BinnedLaw, DensityIsThatOfTheLaw) {
  const BinnedLaw law = BinnedLaw::beta(3.0, 4.0, 1024);
  const double x = 0.5 * (law.edges()[300] + law.edges()[301]);
  EXPECT_NEAR(law.density(300), boost::math::ibeta_derivative(3.0, 4.0, x), 1e-4);
  double sum = 0.0;
  for (std::size_t bin = 0; bin < law.bins(); ++bin) {
    sum += law.density(bin) * (law.edges()[bin + 1] - law.edges()[bin]);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(BinnedLaw, RefusesWhatIsNoLaw) {
  EXPECT_THROW(BinnedLaw::beta(0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(BinnedLaw::beta(1.0, std::numeric_limits<double>::quiet_NaN()),
               std::invalid_argument);
  EXPECT_THROW(BinnedLaw::beta(1.0, 1.0, 1), std::invalid_argument);
  EXPECT_THROW(BinnedLaw::signed_root(-1.0), std::invalid_argument);
}

}  // namespace
}  // namespace driftless
