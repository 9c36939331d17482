#include "experiments/compare/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "experiments/compare/compare_text.hpp"
#include "experiments/statistics.hpp"
#include "tests/json_schema.hpp"
#include "tests/small_result.hpp"

namespace driftless {
namespace {

using nlohmann::json;

json result_of(const std::vector<SmallCell>& cells) {
  json result = small_result(cells);
  result["study"]["duration"] = {{"equilibrate", 1.0}, {"measure", 10.0}, {"sample_every", 0.1}};
  result["scenes"][0]["parameters"] = {{"particles", 100}, {"friction", 4.5}};
  result["scenes"][0]["energy_per_particle"] = 50.0;
  return result;
}

json with_observable(const std::string& name, const json& entry) {
  json result = result_of({{.method = "one"}});
  result["cells"][0]["observables"] = {{name, entry}};
  return result;
}

json measured(double mean, double error) { return {{"mean", mean}, {"error", error}}; }

json first_test(const json& comparison) { return comparison["cells"][0]["tests"][0]; }

/// The verdict on one observable that was and is.
std::string verdict(const std::string& name, const json& was, const json& is) {
  const json comparison = compare(with_observable(name, was), with_observable(name, is));
  EXPECT_TRUE(schema_errors(comparison_schema(), comparison).empty());
  return first_test(comparison)["verdict"];
}

json exact(double mean, double error, double exact = 1) {
  json entry = measured(mean, error);
  entry["exact"] = exact;
  return entry;
}

TEST(Compare, AResultIsTheSameAsItself) {
  const json result = result_of({{.method = "one"}, {.method = "other", .off = 0.1}});
  const json comparison = compare(result, result);
  EXPECT_EQ(comparison["verdict"], "same");
  EXPECT_EQ(comparison["tests"], 6);
  EXPECT_EQ(comparison["counts"]["tests"]["same"], 6);
  EXPECT_EQ(schema_errors(comparison_schema(), comparison), std::vector<std::string>());
}

TEST(Compare, ADeviationThatGrowsIsWorseAndOneThatShrinksBetter) {
  const std::string temperature = "kinetic_temperature";
  EXPECT_EQ(verdict(temperature, exact(1.00, 1e-3), exact(1.02, 1e-3)), "worse");
  EXPECT_EQ(verdict(temperature, exact(1.02, 1e-3), exact(1.00, 1e-3)), "better");
  EXPECT_EQ(verdict(temperature, exact(1.00, 1e-3), exact(1.002, 1e-3)), "same");
  // Off by less on the other side, by as much, by more.
  EXPECT_EQ(verdict(temperature, exact(1.02, 1e-3), exact(0.99, 1e-3)), "better");
  EXPECT_EQ(verdict(temperature, exact(1.02, 1e-3), exact(0.98, 1e-3)), "worse");
  EXPECT_EQ(verdict(temperature, exact(1.02, 1e-3), exact(0.97, 1e-3)), "worse");
}

TEST(Compare, WhatNothingExactStandsBesideIsWorseIfItChanges) {
  for (const double now : {0.9, 1.1}) {
    const json comparison = compare(with_observable("pressure", measured(1, 1e-3)),
                                    with_observable("pressure", measured(now, 1e-3)));
    EXPECT_EQ(first_test(comparison)["verdict"], "worse");
    EXPECT_EQ(first_test(comparison)["reason"], "changed, and nothing exact says that it may");
  }
}

TEST(Compare, AnEffectBelowTheMinimumIsTheSameHoweverSure) {
  const json was = with_observable("pressure", measured(1, 1e-6));
  const json is = with_observable("pressure", measured(1.0005, 1e-6));
  EXPECT_EQ(first_test(compare(was, is))["verdict"], "same");
  EXPECT_EQ(first_test(compare(was, is, {.minimum_effect = 0.0001}))["verdict"], "worse");
}

TEST(Compare, WhatIsMostlyBlindIsNotTheSame) {
  const json was = result_of({{.method = "one"}});
  json is = was;
  auto& observables = is["cells"][0]["observables"];
  ASSERT_EQ(observables.size(), 3U);
  const auto spoil = [](json& entry) {
    entry["error"] = 1000 * std::max(1e-3, entry["error"].get<double>());
  };
  auto entry = observables.begin();
  spoil(*entry);
  EXPECT_EQ(compare(was, is)["verdict"], "same");
  spoil(*++entry);
  const json comparison = compare(was, is);
  EXPECT_EQ(comparison["verdict"], "too_little_data");
  EXPECT_TRUE(schema_errors(comparison_schema(), comparison).empty());
  EXPECT_TRUE(
      comparison_text(comparison)
          .ends_with("\nNEW cannot be called the same as BASE, nor worse, at a family level of "
                     "1e-05 over 3 tests: 2 of them have too little data; more replicas would "
                     "tell.\n"))
      << comparison_text(comparison);
}

TEST(Compare, TooLittleDataIsWhatCannotSeeTheWantedEffect) {
  EXPECT_EQ(verdict("pressure", measured(1, 0.01), measured(1.01, 0.01)), "too_little_data");
  // One test: +- 4.42 standard errors at 1e-5, and 1.645 for the power.
  const json was = with_observable("pressure", measured(1, 0.001));
  const json test = first_test(compare(was, was));
  EXPECT_NEAR(test["detectable"].get<double>(), 0.001 * std::sqrt(2) * (4.41717 + 1.64485), 1e-6);
  EXPECT_EQ(first_test(compare(was, was, {.wanted_effect = 0.008}))["verdict"], "too_little_data");
  EXPECT_EQ(first_test(compare(was, was, {.wanted_effect = 0.009}))["verdict"], "same");
  // A drift may be known as badly as it is large.
  EXPECT_EQ(verdict("energy_drift", exact(1, 0.1, 0), exact(1, 0.1, 0)), "same");
  EXPECT_EQ(verdict("energy_drift", exact(0.1, 0.1, 0), exact(0.1, 0.1, 0)), "too_little_data");
}

TEST(Compare, FewDegreesOfFreedomNeedMore) {
  const auto known = [](double mean, double degrees) {
    json entry = exact(mean, 1e-3 * student_factor(degrees));
    entry["degrees_of_freedom"] = degrees;
    return entry;
  };
  EXPECT_EQ(verdict("kinetic_temperature", known(1, 200), known(1.01, 200)), "worse");
  EXPECT_EQ(verdict("kinetic_temperature", known(1, 3), known(1.01, 200)), "too_little_data");
}

TEST(Compare, DriftsDistancesAndWalksGoBySize) {
  EXPECT_EQ(verdict("energy_drift", exact(-0.1, 1e-3, 0), exact(0.2, 1e-3, 0)), "worse");
  EXPECT_EQ(verdict("energy_drift", exact(-0.2, 1e-3, 0), exact(-0.1, 1e-3, 0)), "better");
  EXPECT_EQ(verdict("momentum_distance", exact(1e-6, 1e-6, 0), exact(1e-4, 1e-6, 0)), "worse");
  EXPECT_EQ(verdict("momentum_distance", exact(1e-4, 1e-6, 0), exact(-1e-6, 1e-6, 0)), "better");
  const auto walk = [](double value) {
    return json{{"mean", value}, {"error", 0.1 * value}, {"effective_samples", 200}};
  };
  EXPECT_EQ(verdict("energy_walk", walk(0.01), walk(0.1)), "worse");
  EXPECT_EQ(verdict("energy_walk", walk(0.1), walk(0.01)), "better");
  EXPECT_EQ(verdict("energy_walk", walk(0.1), walk(0.11)), "same");
}

TEST(Compare, WhatWasConservedToRoundingMustStaySo) {
  for (const char* name : {"momentum_error", "energy_drift", "energy_walk"}) {
    const json was = measured(1e-24, 1e-25), is = measured(1e-3, 1e-4);
    EXPECT_EQ(verdict(name, was, is), "worse") << name;
    EXPECT_EQ(verdict(name, is, was), "better") << name;
    EXPECT_EQ(verdict(name, was, measured(1e-22, 1e-23)), "same") << name;
  }
}

TEST(Compare, FailuresAreComparedExactly) {
  const auto failing = [](int failed, int replicas) {
    json result = result_of({{.method = "one"}});
    result["cells"][0]["replicas"] = replicas;
    result["cells"][0]["failed_replicas"] = failed;
    result["cells"][0]["observables"] = json::object();
    return result;
  };
  const auto of = [&](int was, int is, int replicas) {
    return first_test(compare(failing(was, replicas), failing(is, replicas)))["verdict"];
  };
  EXPECT_EQ(of(0, 16, 16), "worse");
  EXPECT_EQ(of(16, 0, 16), "better");
  EXPECT_EQ(of(0, 4, 16), "same");
  EXPECT_EQ(compare(failing(0, 16), failing(4, 16))["verdict"], "same");
  // 0.0008 by chance alone: neither the same nor, among many cells, worse.
  const json doubtful = compare(failing(0, 16), failing(9, 16));
  EXPECT_EQ(first_test(doubtful)["verdict"], "too_little_data");
  EXPECT_EQ(doubtful["verdict"], "too_little_data");
  EXPECT_EQ(compare(failing(9, 16), failing(0, 16))["verdict"], "same");
  EXPECT_EQ(of(0, 4, 4), "too_little_data");
  EXPECT_TRUE(compare(failing(0, 16), failing(0, 16))["cells"][0]["tests"].empty());
}

/// What makes two results impossible to compare, after a change of NEW; empty if nothing does.
std::string complaint(const std::function<void(json&)>& change, bool all_cells = false) {
  const json base = result_of({{.method = "one"}, {.method = "other"}});
  json changed = base;
  change(changed);
  try {
    compare(base, changed, {.all_cells = all_cells});
  } catch (const NotComparable& fault) {
    return fault.what();
  }
  return "";
}

TEST(Compare, RunsOfAnotherProtocolCannotBeCompared) {
  EXPECT_EQ(complaint([](json& r) { r["study"]["duration"]["measure"] = 20; }),
            "the studies differ in duration.measure: 10.0 in BASE, 20 in NEW; only runs of one "
            "protocol can be compared");
  EXPECT_EQ(complaint([](json& r) { r["scenes"][0]["parameters"]["friction"] = 5; }),
            "the scenes named \"scene\" differ in friction: 4.5 in BASE, 5 in NEW");
  EXPECT_EQ(complaint([](json& r) { r["scenes"][0]["parameters"].erase("friction"); }),
            "the scenes named \"scene\" differ in friction: 4.5 in BASE, none in NEW");
  EXPECT_EQ(complaint([](json& r) {
              for (auto& cell : r["cells"]) cell["time_step"] = 0.5;
            }),
            "no cell (scene, method, options and time step) stands in both results");
  // What only a later program knows, and what may differ.
  EXPECT_EQ(complaint([](json& r) { r["scenes"][0]["parameters"]["species"] = 1; }), "");
  EXPECT_EQ(complaint([](json& r) { r["provenance"]["seed"] = 8; }), "");
}

TEST(Compare, AGateMissesWhatVanished) {
  const auto vanish = [](json& result) { result["cells"].erase(1); };
  const auto refuse = [](json& result) { result["cells"][1]["status"] = "not_applicable"; };
  EXPECT_EQ(complaint(vanish), "");
  EXPECT_EQ(complaint(vanish, true), "NEW lacks 1 of the 2 cells of BASE: scene, other, step 0.01");
  EXPECT_EQ(complaint(refuse, true), "NEW lacks 1 of the 2 cells of BASE: scene, other, step 0.01");
  const auto forget = [](json& result) {
    result["cells"][1]["observables"].erase("kinetic_temperature");
  };
  EXPECT_EQ(complaint(forget), "");
  EXPECT_EQ(complaint(forget, true),
            "NEW lacks kinetic_temperature in the cell scene, other, step 0.01");
  const auto break_all = [](json& result) {
    result["cells"][1]["observables"] = json::object();
    result["cells"][1]["failed_replicas"] = result["cells"][1]["replicas"];
  };
  EXPECT_EQ(complaint(break_all, true), "");
  json less = result_of({{.method = "one"}});
  const json more = result_of({{.method = "one"}, {.method = "other"}});
  EXPECT_EQ(compare(more, less)["missing"].size(), 1U);
  EXPECT_EQ(compare(less, more, {.all_cells = true})["added"].size(), 1U);
  // One method alone, as after work on it.
  EXPECT_EQ(compare(more, less, {.all_cells = true, .method = "one"})["verdict"], "same");
  EXPECT_THROW(compare(more, less, {.method = "other"}), NotComparable);
}

TEST(Compare, ScenesOfOtherEnergiesAreComparedByDeviations) {
  json was = with_observable("potential_energy", exact(2.0, 1e-4, 2.0));
  json is = with_observable("potential_energy", exact(2.1, 1e-4, 2.1));
  EXPECT_EQ(first_test(compare(was, is))["verdict"], "worse") << "at one energy";
  is["scenes"][0]["energy_per_particle"] = 50.1;
  EXPECT_EQ(first_test(compare(was, is))["verdict"], "same");
  // The reference's own error counts.
  is["cells"][0]["observables"]["potential_energy"]["exact"] = 2.0;
  EXPECT_EQ(first_test(compare(was, is))["verdict"], "worse");
  is["cells"][0]["observables"]["potential_energy"]["exact_error"] = 0.05;
  EXPECT_EQ(first_test(compare(was, is))["verdict"], "too_little_data");
  was["cells"][0]["observables"]["potential_energy"].erase("exact");
  EXPECT_TRUE(compare(was, is)["cells"][0]["tests"].empty());
}

TEST(Compare, TimesAreComparedOnOneProcessorAlone) {
  const json was = result_of({{.method = "one", .cost = 1}, {.method = "other", .cost = 1}});
  json is = result_of({{.method = "one", .cost = 1.5}, {.method = "other", .cost = 1.01}});
  const json cost = compare(was, is)["cost"];
  EXPECT_EQ(cost["methods"][0]["verdict"], "slower");
  EXPECT_NEAR(cost["methods"][0]["ratio"].get<double>(), 1.5, 1e-12);
  EXPECT_EQ(cost["methods"][1]["verdict"], "same");
  EXPECT_EQ(compare(is, was)["cost"]["methods"][0]["verdict"], "faster");
  EXPECT_EQ(compare(was, is)["verdict"], "same") << "time is no part of the verdict";
  // Timings that scatter by 2 units of a cost of 15 say less.
  json scattered = result_of({{.method = "one", .cost = 15}}), slow = scattered;
  scattered["cells"][0]["cost"]["core_seconds_per_time"] = 12;
  EXPECT_EQ(compare(scattered, slow)["cost"]["methods"][0]["verdict"], "slower");
  slow["cells"][0]["cost"]["spread"] = 2;
  EXPECT_EQ(compare(scattered, slow)["cost"]["methods"][0]["verdict"], "same");
  is["provenance"]["cpu"] = "another CPU";
  EXPECT_EQ(compare(was, is)["cost"]["reason"], "cpu is \"a CPU\" in BASE, \"another CPU\" in NEW");
}

TEST(Compare, TheTextHasWhatIsNotTheSameAndEndsInASentence) {
  const json was = result_of({{.method = "one"}, {.method = "other"}});
  const json is = result_of({{.method = "one", .off = 0.05}, {.method = "other"}});
  const std::string text = comparison_text(compare(was, is));
  EXPECT_NE(text.find("worse    scene, one, step 0.01  kinetic_temperature"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("scene, other"), std::string::npos) << text;
  EXPECT_NE(text.find("tests: 3 same, 0 better, 3 worse, 0 with too little data\n"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with(
      "\nNEW is worse than BASE in 1 of 2 cells, at a family level of 1e-05 over 6 tests.\n"))
      << text;
}

TEST(Compare, AResultKeptWithoutItsCurvesComparesAsBefore) {
  json result = result_of({{.method = "one"}});
  result["cells"][0]["curves"] = {{"momentum", {{"x", {1, 2}}}}};
  result["cells"][0]["energy_trace"] = {{"time", {1}}, {"energy", {0}}};
  const json kept = without_curves(result);
  EXPECT_FALSE(kept["cells"][0].contains("curves"));
  EXPECT_FALSE(kept["cells"][0].contains("energy_trace"));
  EXPECT_EQ(compare(result, result), compare(kept, kept));
}

/// Results as chance makes them: cells of five methods and four observables whose means share most
/// of their noise, with errors known from `replicas` replicas and true errors that differ by cell.
class Chance {
 public:
  explicit Chance(int replicas) : replicas_(replicas) {}

  /// `degrees`: what the result claims of its errors; the truth if negative.
  json result(double degrees = -1) {
    json result = result_of(
        {{.method = "a"}, {.method = "b"}, {.method = "c"}, {.method = "d"}, {.method = "e"}});
    const double common = normal_(numbers_);
    int index = 0;
    for (auto& cell : result["cells"]) {
      cell["observables"] = json::object();
      for (const char* name :
           {"kinetic_temperature", "kinetic_share", "pressure", "internal_energy_variance"}) {
        cell["observables"][name] = observable(common, 1e-3 * (1 + index++ % 5), degrees);
      }
    }
    return result;
  }

 private:
  json observable(double common, double error, double degrees) {
    const double freedom = replicas_ - 1;
    const double seen =
        error * std::sqrt(std::chi_squared_distribution<>(freedom)(numbers_) / freedom);
    const double claimed = degrees < 0 ? freedom : degrees;
    json entry = exact(1 + error * (0.9 * common + std::sqrt(0.19) * normal_(numbers_)),
                       seen * student_factor(claimed));
    entry["degrees_of_freedom"] = claimed;
    return entry;
  }

  int replicas_;
  std::mt19937_64 numbers_{20240229};
  std::normal_distribution<> normal_;
};

int false_alarms(int replicas, double family_level, int trials, double degrees = -1) {
  Chance chance(replicas);
  int alarms = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const json base = chance.result(degrees), changed = chance.result(degrees);
    const json counts = compare(
        base, changed, {.family_level = family_level, .minimum_effect = 0})["counts"]["tests"];
    if (counts["better"] > 0 || counts["worse"] > 0) ++alarms;
  }
  return alarms;
}

// At most binomial with 2000 trials: more than 5 % + 6.1 standard deviations, 159, with a chance
// below 1e-8; at 1e-5 more than 3 with one of 7e-9.
TEST(Compare, AFamilyOfTestsKeepsItsLevelHoweverFewReplicasThereAre) {
  for (const int replicas : {3, 8}) {
    EXPECT_LE(false_alarms(replicas, 0.05, 2000), 159) << replicas;
    EXPECT_LE(false_alarms(replicas, 1e-5, 2000), 3) << replicas;
  }
}

// The test of the test: errors of three replicas taken for certain. With the promised 5 % more than
// 32 of 200 alarms would have a chance below 1e-8.
TEST(Compare, AFamilyOfTestsThatTrustsItsErrorsDoesNot) {
  const double certain = std::numeric_limits<double>::max();
  EXPECT_GT(false_alarms(3, 0.05, 200, certain), 32);
  EXPECT_GT(false_alarms(3, 1e-5, 200, certain), 3);
}

}  // namespace
}  // namespace driftless
