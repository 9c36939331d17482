#include "experiments/deviations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/statistics.hpp"
#include "tests/small_result.hpp"

namespace driftless {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Deviation, IsRelativeToTheExactValueWithItsInterval) {
  const auto entry =
      deviation("kinetic_temperature", {{"mean", 2.2}, {"exact", 2}}, {0.05, infinity});
  EXPECT_NEAR(entry["value"].get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(entry["lower"].get<double>(), 0.1 - interval_quantile * 0.025, 1e-12);
  EXPECT_NEAR(entry["upper"].get<double>(), 0.1 + interval_quantile * 0.025, 1e-12);
  EXPECT_FALSE(entry["below_noise"]);
}

TEST(Deviation, IsStudentsWhereTheErrorIsPoorlyKnown) {
  const auto entry = deviation("kinetic_temperature", {{"mean", 2.2}, {"exact", 2}}, {0.05, 3});
  EXPECT_NEAR(entry["upper"].get<double>(), 0.1 + 3.18245 * 0.025, 1e-6);
}

TEST(Deviation, CountsTheErrorOfAMeasuredReference) {
  const auto entry =
      deviation("pressure", {{"mean", 10}, {"exact", 10}, {"exact_error", 0.4}}, {0.3, infinity});
  EXPECT_NEAR(entry["upper"].get<double>(), interval_quantile * 0.05, 1e-12);
  EXPECT_TRUE(entry["below_noise"]);
}

TEST(Deviation, OfADriftIsItsSize) {
  const auto entry = deviation("energy_drift", {{"mean", -0.02}, {"exact", 0}}, {0.001, infinity});
  EXPECT_NEAR(entry["value"].get<double>(), 0.02, 1e-12);
  EXPECT_FALSE(entry["below_noise"]);
}

TEST(Deviation, OfADistanceIsTheRootOfItsSquareAndNeverHidesTheNoise) {
  const auto clear =
      deviation("momentum_distance", {{"mean", 4e-4}, {"exact", 0}}, {1e-5, infinity});
  EXPECT_NEAR(clear["value"].get<double>(), 0.02, 1e-12);
  EXPECT_NEAR(clear["lower"].get<double>(), std::sqrt(4e-4 - interval_quantile * 1e-5), 1e-12);
  // An unbiased square far below zero by chance does not prove a distance of zero.
  const auto chance =
      deviation("momentum_distance", {{"mean", -4e-4}, {"exact", 0}}, {1e-4, infinity});
  EXPECT_EQ(chance["value"], 0);
  EXPECT_NEAR(chance["upper"].get<double>(), std::sqrt(interval_quantile * 1e-4), 1e-12);
  EXPECT_TRUE(chance["below_noise"]);
}

TEST(Deviations, BoundsOfAllCellsHoldAtOnce) {
  auto result = small_result({{"a", 0.01, 1, 0.02, 0.001},
                              {"b", 0.01, 2, 0.01, 0.001},
                              {"c", 0.01, 3, 0.01, 0.001, "unstable"}});
  result["cells"].push_back(small_cell("scene", {"d"}));
  result["cells"][3]["observables"]["kinetic_temperature"]["status"] = "not_resolved";
  add_deviations(result);
  const auto& first = result["cells"][0]["observables"];
  // Two cells resolve the kinetic temperature, three the variance; 5 % are shared among them.
  EXPECT_NEAR(first["kinetic_temperature"]["deviation"]["bound"].get<double>(),
              0.02 + 0.001 * student_quantile(infinity, 0.025), 1e-12);
  EXPECT_NEAR(first["internal_energy_variance"]["deviation"]["bound"].get<double>(),
              0.02 + 0.001 * student_quantile(infinity, 0.05 / 3), 1e-12);
  EXPECT_NEAR(first["internal_energy_variance"]["deviation"]["resolution"].get<double>(),
              0.001 * student_quantile(infinity, 0.05 / 3), 1e-12);
  const auto& unresolved = result["cells"][3]["observables"]["kinetic_temperature"]["deviation"];
  EXPECT_TRUE(unresolved.contains("upper"));
  EXPECT_FALSE(unresolved.contains("bound"));
}

TEST(Deviations, OneCellAloneIsBoundByItsInterval) {
  auto result = small_result({{"a", 0.01, 1, 0.02, 0.001}});
  add_deviations(result);
  const auto& entry = result["cells"][0]["observables"]["kinetic_temperature"]["deviation"];
  EXPECT_EQ(entry["bound"], entry["upper"]);
}

TEST(Deviations, ReplicasThatDisagreeAreNotHelpedByTheOthers) {
  std::vector<SmallCell> cells;
  for (int n = 0; n < 12; ++n) {
    cells.push_back({"m" + std::to_string(n % 3), 0.01 * (n / 3 + 1), 1, 0, 0.01 + 1e-9 * n});
  }
  auto result = small_result(cells);
  for (auto& cell : result["cells"]) {
    cell["observables"]["kinetic_temperature"]["degrees_of_freedom"] = 10;
  }
  auto& odd = result["cells"][5]["observables"]["kinetic_temperature"];
  odd.update({{"error", 0.05}, {"degrees_of_freedom", 3}, {"replicas_disagree", true}});
  add_deviations(result);
  EXPECT_NEAR(odd["deviation"]["bound"].get<double>(),
              0.05 / student_factor(3) * student_quantile(3, 0.05 / 12), 1e-12);
  const auto& plain = result["cells"][4]["observables"]["kinetic_temperature"]["deviation"];
  EXPECT_LT(plain["bound"].get<double>(),
            0.01 / student_factor(10) * student_quantile(10, 0.05 / 12));
}

}  // namespace
}  // namespace driftless
