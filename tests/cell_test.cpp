#include "experiments/cell.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftless {
namespace {

TEST(Deviation, IsRelativeToTheExactValueWithItsInterval) {
  const auto entry = deviation({"kinetic_temperature", {2.2, 0.05, 100, false}, Reference{2, 0}});
  EXPECT_NEAR(entry["value"].get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(entry["lower"].get<double>(), 0.1 - 1.96 * 0.025, 1e-12);
  EXPECT_NEAR(entry["upper"].get<double>(), 0.1 + 1.96 * 0.025, 1e-12);
  EXPECT_FALSE(entry["below_noise"]);
}

TEST(Deviation, CountsTheErrorOfAMeasuredReference) {
  const auto entry = deviation({"pressure", {10, 0.3, 100, false}, Reference{10, 0.4}});
  EXPECT_NEAR(entry["upper"].get<double>(), 1.96 * 0.05, 1e-12);
  EXPECT_TRUE(entry["below_noise"]);
}

TEST(Deviation, OfADriftIsItsSize) {
  const auto entry = deviation({"energy_drift", {-0.02, 0.001, 100, false}, Reference{0, 0}});
  EXPECT_NEAR(entry["value"].get<double>(), 0.02, 1e-12);
  EXPECT_FALSE(entry["below_noise"]);
}

TEST(Deviation, OfADistanceIsTheRootOfItsSquareAndNeverHidesTheNoise) {
  const auto clear = deviation({"momentum_distance", {4e-4, 1e-5, 100, false}, Reference{0, 0}});
  EXPECT_NEAR(clear["value"].get<double>(), 0.02, 1e-12);
  EXPECT_NEAR(clear["lower"].get<double>(), std::sqrt(4e-4 - 1.96e-5), 1e-12);
  // An unbiased square far below zero by chance does not prove a distance of zero.
  const auto chance = deviation({"momentum_distance", {-4e-4, 1e-4, 100, false}, Reference{0, 0}});
  EXPECT_EQ(chance["value"], 0);
  EXPECT_NEAR(chance["upper"].get<double>(), std::sqrt(1.96e-4), 1e-12);
  EXPECT_TRUE(chance["below_noise"]);
}

TEST(CellStatus, IsThatOfTheFirstFailure) {
  std::vector<ReplicaResult> replicas(3);
  EXPECT_EQ(cell_status(replicas), "ok");
  replicas[1].failure = Failure{1, FailureCause::not_converged, 5, 0.5};
  replicas[2].failure = Failure{2, FailureCause::non_finite, 7, 0.7};
  EXPECT_EQ(cell_status(replicas), "not_converged");
}

}  // namespace
}  // namespace driftless
