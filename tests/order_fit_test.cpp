#include "experiments/order_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace driftless {
namespace {

TEST(OrderFit, RecoversAPowerLaw) {
  const auto fit = fit_order({{0.1, 0.02, 0.001}, {0.2, -0.08, 0.001}, {0.4, 0.32, 0.001}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 2.0, 1e-12);
  EXPECT_EQ(fit->points, 3u);
}

TEST(OrderFit, ErrorOfTwoPointsIsPropagated) {
  const auto fit = fit_order({{1.0, 1.0, 0.03}, {std::exp(1.0), 7.0, 0.28}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, std::log(7.0), 1e-12);
  EXPECT_NEAR(fit->error, std::hypot(0.03, 0.04), 1e-12);
}

TEST(OrderFit, IntervalHoldsTheOrder) {
  // Standard errors of 2 to 8 %: 10^4 intervals of four points, six sigma of the binomial law.
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  constexpr int trials = 10000;
  const auto held = [&](double error_scale) {
    int result = 0;
    for (int i = 0; i < trials; ++i) {
      std::vector<Deviation> points;
      for (const double step : {0.1, 0.14, 0.2, 0.28}) {
        const double error = 2e-4;
        points.push_back({step, step * step + error * normal(random), error_scale * error});
      }
      const auto fit = fit_order(points);
      result += fit && std::abs(fit->order - 2.0) < 1.96 * fit->error;
    }
    return result;
  };
  EXPECT_GT(held(1.0), 0.95 * trials - 6.0 * std::sqrt(0.95 * 0.05 * trials));
  EXPECT_LT(held(0.1), 0.95 * trials - 6.0 * std::sqrt(0.95 * 0.05 * trials));
}

TEST(OrderFit, PointsOffOnePowerLawRaiseTheError) {
  const auto fit = fit_order({{1, 1, 1e-3}, {2, 2, 1e-3}, {4, 16, 1e-3}});
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->error, 0.05);
}

TEST(OrderFit, LeavesNoiseAndWhatIsNotFiniteOut) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fit = fit_order({{0.05, 0.5, 0.3},
                              {0.1, 0.02, 0.001},
                              {0.2, 0.08, 0.001},
                              {0.4, nan, 0.001},
                              {0.8, 1.0, nan},
                              {0.9, 1.0, std::numeric_limits<double>::infinity()}});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->points, 2u);
  EXPECT_NEAR(fit->order, 2.0, 1e-12);
}

TEST(OrderFit, ExactPointsNeedNoError) {
  const auto fit = fit_order({{0.1, 1e-3, 0.0}, {0.2, 8e-3, 0.0}, {0.4, 64e-3, 0.0}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 3.0, 1e-12);
  EXPECT_LT(fit->error, 1e-6);
}

TEST(OrderFit, NeedsTwoTimeSteps) {
  EXPECT_FALSE(fit_order({}));
  EXPECT_FALSE(fit_order({{0.1, 1.0, 0.01}}));
  EXPECT_FALSE(fit_order({{0.1, 1.0, 0.01}, {0.1, 1.1, 0.01}}));
  EXPECT_FALSE(fit_order({{0.1, 1.0, 0.01}, {0.2, 0.01, 0.01}}));
  EXPECT_FALSE(fit_order({{0.1, 0.0, 0.0}, {0.2, 0.0, 0.0}}));
  EXPECT_THROW(fit_order({{0.0, 1.0, 0.01}}), std::invalid_argument);
}

}  // namespace
}  // namespace driftless
