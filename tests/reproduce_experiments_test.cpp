#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/judge/balance.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/temperature_runs.hpp"
#include "experiments/scene_keys.hpp"

/// What the experiments conclude, from records made up so that the answer is known.
namespace driftless::reproduce {
namespace {

using nlohmann::json;

const Conditions quick{Effort::quick, 1};

const Experiment& experiment(const std::string& name) { return *read_experiments({name}).front(); }

const Row* row_of(const Outcome& outcome, const std::string& quantity, const std::string& setting) {
  for (const auto& row : outcome.rows) {
    if (row.quantity == quantity && row.setting.starts_with(setting)) return &row;
  }
  return nullptr;
}

double step_of(const std::string& part) { return std::stod(part.substr(part.find("step ") + 5)); }

/// A replica whose temperatures have a ratio known from `start` on, with a little noise, and that
/// fails at `end` if that is below 60.
json replica(double ratio, double end, std::size_t seed) {
  json record = {{"times", json::array()}, {"kinetic", json::array()}, {"inverse", json::array()}};
  for (double time = 0; time <= std::min(end, 60.0); time += 0.5) {
    const double wobble = 0.002 * std::sin(1e3 * (time + 0.37) * static_cast<double>(seed + 1));
    record["times"].push_back(time);
    record["kinetic"].push_back(0.9 * (time < kinetic_end ? 1 : ratio) * (1 + wobble));
    record["inverse"].push_back(1 / 0.9);
  }
  record["g"] = std::vector<double>(64, 1);
  record["core"] = 0.1;
  if (end < 60) record["failure"] = "negative internal energy at t = 30";
  return record;
}

/// A method that any experiment takes and that tells when it is run.
struct Called {};

class Caller : public Integrator {
 public:
  void step(System&, double) override { throw Called(); }
};

const MethodChoice& caller() {
  static const MethodChoice choice = [] {
    Method method;
    method.name = "reproduce-caller";
    method.isothermal = true;
    method.runs_thermal_repulsion = with_any_options;
    method.closures = {FrictionClosure::noise, FrictionClosure::friction};
    method.make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<Caller>();
    };
    register_method(method);
    return MethodChoice{"reproduce-caller", {}};
  }();
  return choice;
}

TEST(ReproduceMethod, TheChosenMethodIsWhatRuns) {
  const Conditions chosen{Effort::quick, 1, caller()};
  for (const auto* one : experiments()) {
    if (one->unsuited && one->unsuited(caller())) {
      EXPECT_EQ(one->name, "methods-transport");
      continue;
    }
    const auto parts = one->parts(chosen);
    // Particles that lie still have no method.
    const auto first = std::find_if(parts.begin(), parts.end(), [](const Part& part) {
      return !part.name.starts_with("network");
    });
    EXPECT_THROW(first->run({}), Called) << one->name << ": " << first->name;
  }
}

/// `ratio(step)`; the published scheme's replicas fail at `end` above the step 0.1.
template <class Ratio>
Outcome temperatures(Ratio&& ratio, double end, const Conditions& conditions = quick) {
  const auto& asked = experiment("soleymani-2020-figure-1");
  Records records;
  for (const auto& part : asked.parts(conditions)) {
    const double step = step_of(part.name);
    const bool fails = step > 0.1 && part.name.starts_with("isoenergetic");
    records[part.name] = replica(ratio(step), fails ? end : 60, records.size());
  }
  return asked.conclude(conditions, records);
}

double quadratic(double step) { return 1 + 0.5 * step * step / (0.106 * 0.106); }

TEST(SoleymaniFigure1, TheStepOfTheWantedDifferenceIsFound) {
  const auto outcome = temperatures(quadratic, 60);
  const auto* small = row_of(outcome, "T_kin/T_int", "isoenergetic-verlet, step 0.01");
  ASSERT_TRUE(small);
  EXPECT_NEAR(small->ours.value, quadratic(0.01), 1e-3);
  EXPECT_EQ(small->verdict, Verdict::agrees);
  const auto* crossed = row_of(outcome, "step at which T_kin/T_int - 1 = 0.5", "isoenergetic");
  ASSERT_TRUE(crossed);
  EXPECT_NEAR(crossed->ours.value, 0.106, 2e-4);
  EXPECT_LT(crossed->ours.low, crossed->ours.value);
  EXPECT_GT(crossed->ours.high, crossed->ours.value);
  const auto* greatest = row_of(outcome, "greatest T_kin/T_int - 1", "isoenergetic");
  ASSERT_TRUE(greatest);
  EXPECT_NEAR(greatest->ours.value, quadratic(0.12) - 1, 2e-3);
  EXPECT_EQ(greatest->verdict, Verdict::agrees);
}

TEST(SoleymaniFigure1, AnotherMethodStandsBesideThePapersValue) {
  const Conditions chosen{Effort::quick, 1, MethodChoice{"peters", {}}};
  const auto outcome = temperatures(quadratic, 60, chosen);
  EXPECT_EQ(row_of(outcome, "T_kin/T_int", "isoenergetic"), nullptr);
  ASSERT_TRUE(row_of(outcome, "T_kin/T_int", "peters, step 0.01"));
  EXPECT_EQ(row_of(outcome, "T_kin/T_int", "peters")->verdict, Verdict::agrees);
  EXPECT_EQ(row_of(outcome, "T_kin/T_int", "shardlow-s1")->verdict, Verdict::ours_alone);
}

TEST(SoleymaniFigure1, TemperaturesApartAtASmallStepAreADifference) {
  const auto outcome = temperatures([](double step) { return quadratic(step) + 0.03; }, 60);
  EXPECT_EQ(row_of(outcome, "T_kin/T_int", "isoenergetic")->verdict, Verdict::differs);
}

TEST(SoleymaniFigure1, WhatFailsLateCountsAndWhatFailsSoonDoesNot) {
  const auto late = temperatures(quadratic, 30);
  const auto* greatest = row_of(late, "greatest T_kin/T_int - 1", "isoenergetic-verlet, step 0.12");
  ASSERT_TRUE(greatest);
  EXPECT_NE(greatest->explanation.find("6 of 6 replicas ended early"), std::string::npos)
      << greatest->explanation;

  const auto soon = temperatures(quadratic, 15);
  greatest = row_of(soon, "greatest T_kin/T_int - 1", "isoenergetic-verlet, step 0.1");
  ASSERT_TRUE(greatest);
  EXPECT_EQ(greatest->verdict, Verdict::differs) << "it never comes to 50 %";
  EXPECT_TRUE(std::isnan(row_of(soon, "step at which T_kin/T_int - 1 = 0.5", "iso")->ours.value));
  EXPECT_FALSE(row_of(soon, "greatest T_kin/T_int - 1", "shardlow-s1, step 0.1")
                   ->explanation.starts_with("6 of 6"));
}

/// An ideal fluid, for which all is known: temperatures of the exact law, g(r) = 1.
TEST(TemperatureRuns, AnIdealFluidHasItsExactTemperaturesAndNoStructure) {
  TemperatureRuns runs{find_preset("soft-fluid")->scene, 4, 60};
  runs.scene.particles = 150;
  runs.scene.fluid.repulsion = 0;
  std::vector<json> replicas;
  for (unsigned n = 0; n < runs.replicas; ++n) {
    replicas.push_back(run_temperatures(runs, {"shardlow-s1", {}}, 0.05, n, 1));
    EXPECT_EQ(run_temperatures(runs, {"shardlow-s1", {}}, 0.05, n, 1), replicas.back());
  }
  const TemperatureCell cell(replicas);
  ASSERT_TRUE(cell.ran());
  EXPECT_EQ(cell.failures(), "");
  EXPECT_EQ(cell.times().size(), 121U);
  // (A - 1)/A of the exact law. Six standard errors: a false alarm in 2 of 10^9.
  const double shape = 1.5 * 149 + 150 * 61;
  const auto ratio = cell.ratio();
  const double error = (ratio.high - ratio.low) / (2 * 1.96);
  EXPECT_LT(error, 0.01);
  EXPECT_NEAR(ratio.value, 1 - 1 / shape, 6 * error);
  // 101 samples of 0.5 * 150 * 149 pairs in each replica; positions of samples half a unit apart
  // count as one draw in ten at worst.
  const auto of_pairs = [](double from, double to) {
    const double volume = 4 * std::numbers::pi / 3 * (std::pow(to, 3) - std::pow(from, 3));
    const double expected = 4 * 101 * 0.5 * 149 * 3 * volume;
    return 6 * std::sqrt(10 / expected);
  };
  for (std::size_t bin = 20; bin < cell.bins(); ++bin) {
    const auto inner = static_cast<double>(bin) * distance_bin;
    EXPECT_NEAR(cell.g(bin).value, 1, of_pairs(inner, inner + distance_bin)) << bin;
  }
  EXPECT_NEAR(cell.overlaps().value, 1, of_pairs(0, core));
}

TEST(TemperatureRuns, AFailureKeepsWhatWasMeasuredBefore) {
  TemperatureRuns runs{find_preset("soft-fluid")->scene, 1, 60};
  runs.scene.particles = 150;
  const auto record = run_temperatures(runs, {"isoenergetic-verlet", {}}, 0.3, 0, 1);
  ASSERT_TRUE(record.contains("failure"));
  EXPECT_FALSE(record["times"].empty());
  EXPECT_FALSE(TemperatureCell(std::vector<json>{record}).ran());
}

/// The course of S[P] or F[P] with a change the wrong way of so many standard errors.
json course(double errors) {
  std::vector<double> times, relative, error;
  for (int n = 0; n <= 40; ++n) {
    times.push_back(0.2 * n);
    relative.push_back(7 * std::exp(-0.4 * n) + 0.001);
    error.push_back(2e-4);
  }
  return {{"copies", 1000000},
          {"failed", 0.0},
          {"times", times},
          {"relative", relative},
          {"error", error},
          {"fall", {{"from", 10}, {"to", 20}, {"depth", errors * 2e-4}, {"error", 2e-4}}}};
}

TEST(MarshCoveneyEntropy, AChangeTheWrongWayIsADifference) {
  const auto& asked = experiment("marsh-coveney-1998-entropy");
  Records records;
  for (const auto& part : asked.parts(quick)) {
    const bool wrong = part.name.starts_with("marsh-coveney: free energy");
    records[part.name] = course(wrong ? 20 : 3);
  }
  const auto outcome = asked.conclude(quick, records);
  EXPECT_EQ(outcome.rows.size(), records.size());
  int rises = 0;
  for (const auto& row : outcome.rows) {
    const bool wrong = row.quantity.find("F[P]") != std::string::npos;
    rises += wrong;
    EXPECT_EQ(row.verdict, wrong ? Verdict::differs : Verdict::agrees) << row.setting;
    EXPECT_NEAR(row.ours.value, (wrong ? 20 : 3) * 2e-4, 1e-12) << row.setting;
  }
  EXPECT_EQ(rises, 4);
  EXPECT_EQ(outcome.pictures.size(), 4U);
}

/// Replicas of the fluids with temperatures that are off by `slope` times the step, alike in all
/// species but the last, which is off by another 5 % if `broken`.
Outcome species(double slope, bool broken, const Conditions& conditions = quick) {
  const auto& asked = experiment("marsh-coveney-1998-species");
  Records records;
  for (const auto& part : asked.parts(conditions)) {
    if (part.name.find(": ") != std::string::npos) {
      records[part.name] = course(3);
      continue;
    }
    const double wobble = 0.001 * std::sin(1e3 * static_cast<double>(records.size()));
    std::vector<double> means(7, 1 + slope * step_of(part.name) + wobble);
    for (std::size_t n = 3; n < 7; ++n) means[n] = 1;
    if (broken) means[2] += 0.05;
    records[part.name] = {{"means", means}};
  }
  return asked.conclude(conditions, records);
}

TEST(MarshCoveneySpecies, AnErrorOfTheStepIsGoneAtVanishingSteps) {
  const auto outcome = species(2, false);
  for (const char* fluid : {"isothermal fluid", "energy-conserving fluid"}) {
    const std::string quantity = std::string(fluid) == "isothermal fluid"
                                     ? "T_kin/T of species 2"
                                     : "T_kin of species 2 over T_int of all";
    const auto at = [&](const std::string& setting) {
      return row_of(outcome, quantity, "marsh-coveney, " + std::string(fluid) + ", " + setting);
    };
    ASSERT_TRUE(at("step 0.02"));
    EXPECT_EQ(at("step 0.02")->verdict, Verdict::ours_alone);
    EXPECT_NEAR(at("step 0.02")->ours.value, 1.04, 1e-3);
    ASSERT_TRUE(at("at vanishing"));
    EXPECT_EQ(at("at vanishing")->verdict, Verdict::agrees);
    EXPECT_NEAR(at("at vanishing")->ours.value, 1, 3e-3);
  }
  EXPECT_EQ(outcome.rows.size(), 4U * (3 + 6) + 4);
  EXPECT_EQ(outcome.pictures.size(), 3U);
}

TEST(MarshCoveneySpecies, AnotherMethodIsNotExplainedAsThePapers) {
  const Conditions chosen{Effort::quick, 1, MethodChoice{"shardlow-s1", {}}};
  const auto outcome = species(2, false, chosen);
  ASSERT_TRUE(row_of(outcome, "T_kin/T of species 2", "shardlow-s1, isothermal fluid, at van"));
  for (const auto& row : outcome.rows) {
    EXPECT_EQ(row.explanation.find("explicit step"), std::string::npos) << row.setting;
  }
}

TEST(MarshCoveneySpecies, ASpeciesOfAnotherTemperatureIsADifference) {
  const auto outcome = species(2, true);
  const std::string at = "marsh-coveney, isothermal fluid, at vanishing";
  EXPECT_EQ(row_of(outcome, "T_kin/T of species 2", at)->verdict, Verdict::differs);
  EXPECT_EQ(row_of(outcome, "T_kin/T of species 1", at)->verdict, Verdict::agrees);
}

}  // namespace
}  // namespace driftless::reproduce
