#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/energy_ladder.hpp"
#include "experiments/judge/examinations.hpp"
#include "experiments/judge/short_paths.hpp"

/// The examination of invariants sees what is kept, how fast the rest drifts, and internal energies
/// that run out. That each single check sees a fault of its own is in invariants_test.
namespace driftless::judge {
namespace {

using nlohmann::json;

/// A scheme that keeps energy, and a loss of it: u -= rate dt^2 u for every particle, so that
/// energy falls by a share of rate dt per unit time.
class Leaking : public Integrator {
 public:
  explicit Leaking(double rate) : rate_(rate) {}
  void step(System& system, double dt) override {
    sound_->step(system, dt);
    system.update([&](std::size_t, Vector&, double& u) { u *= 1 - rate_ * dt * dt; });
  }

 private:
  std::unique_ptr<Integrator> sound_ = find_method("shardlow-s1")->make({});
  double rate_;
};

/// Takes so much from every particle that all run out before a unit of time is over.
class Draining : public Integrator {
 public:
  void step(System& system, double dt) override {
    sound_->step(system, dt);
    system.update([&](std::size_t, Vector&, double& u) { u -= 100 * dt; });
  }

 private:
  std::unique_ptr<Integrator> sound_ = find_method("shardlow-s1")->make({});
};

template <class Scheme, int... arguments>
Candidate planted(std::string_view name) {
  if (!find_method(name)) {
    Method method = *find_method("shardlow-s1");
    method.name = name;
    method.make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<Scheme>(arguments...);
    };
    register_method(method);
  }
  return {{std::string(name), {}}};
}

constexpr unsigned runs = 4;
constexpr double duration = 2.88;

const PreparedScene& ideal() {
  return prepared_once(small_fluid_scene(60, FrictionClosure::noise, false), 3, runs);
}

std::vector<json> rungs(const Candidate& candidate) {
  std::vector<json> all;
  for (const double step : {0.04, 0.02, 0.01}) {
    all.push_back(energy_rung(candidate, ideal(), runs, step, duration));
  }
  return all;
}

TEST(EnergyLadder, FindsTheOrderAndTheSizeOfALeak) {
  const auto found = rungs(planted<Leaking, 1>("leaks"));
  for (const auto& rung : found) {
    // Particles hold (phi + k) T = 61 kT; the mean over the run is of a falling energy.
    const double step = rung["time_step"], lost = 61 * step;
    const auto& drift = rung["drift"];
    EXPECT_LT(drift["value"], -lost * std::exp(-step * duration) * 0.995);
    EXPECT_GT(drift["value"], -lost * 1.005);
  }
  const auto findings = energy_findings("fluid", found);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_NEAR(findings[0].value.value(), 1, 0.1);
  EXPECT_LT(findings[0].lower.value(), 1.05);
  EXPECT_GT(findings[0].upper.value(), 0.9);
}

TEST(EnergyLadder, OfASoundMethodIsKept) {
  const auto findings = energy_findings("fluid", rungs({{"shardlow-s1", {}}}));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_LT(findings[0].value.value(), 1e-12);
}

TEST(EnergyLadder, CountsInternalEnergiesThatRunOut) {
  const auto found = rungs(planted<Draining>("drains"));
  for (const auto& rung : found) {
    EXPECT_EQ(rung["failed"], runs);
    EXPECT_EQ(rung["negative"], runs);
    EXPECT_LT(rung["time"], 1);
    EXPECT_FALSE(rung.contains("drift"));
  }
  const auto finding = positivity_finding("fluid", found);
  EXPECT_EQ(finding.value.value(), 1);
  EXPECT_NE(finding.sentence.find("4 by a negative internal energy"), std::string::npos)
      << finding.sentence;
  EXPECT_EQ(positivity_finding("fluid", rungs({{"shardlow-s1", {}}})).value.value(), 0);
}

/// The rule of three for none of 10, and the tables of binomial intervals.
TEST(ShareInterval, IsThatOfClopperAndPearson) {
  EXPECT_EQ(share_interval(0, 10).lower, 0);
  EXPECT_NEAR(share_interval(0, 10).upper, 1 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_NEAR(share_interval(5, 10).lower, 0.1871, 1e-4);
  EXPECT_NEAR(share_interval(5, 10).upper, 0.8129, 1e-4);
  EXPECT_EQ(share_interval(10, 10).upper, 1);
}

/// The parts named, run.
Records records_of(const Candidate& candidate, std::string_view beginning) {
  Records records;
  for (const auto& part : invariants.parts(candidate, {})) {
    if (part.name.rfind(beginning, 0) == 0) records[part.name] = part.run();
  }
  return records;
}

TEST(InvariantsExamined, OfASoundMethodHold) {
  const Candidate candidate{{"shardlow-s1", {}}};
  const auto conclusion = invariants.conclude(candidate, {}, records_of(candidate, "short"));
  ASSERT_EQ(conclusion.findings.size(), short_checks().size());
  EXPECT_EQ(overall(conclusion), Verdict::holds);
  for (const auto& finding : conclusion.findings) {
    const bool unclaimed =
        finding.subject == "order of pairs" || finding.subject == "total energy with a potential";
    const bool empty = finding.subject == "what is saved";
    EXPECT_EQ(finding.verdict, empty       ? Verdict::not_applicable
                               : unclaimed ? Verdict::reported
                                           : Verdict::holds)
        << finding.sentence;
  }
}

TEST(InvariantsExamined, OfAFaultyMethodContradictItsClaims) {
  const auto candidate = planted<Leaking, 1>("leaks");
  const auto conclusion = invariants.conclude(candidate, {}, records_of(candidate, "short"));
  EXPECT_EQ(overall(conclusion), Verdict::fails);
  for (const auto& finding : conclusion.findings) {
    const bool of_energy =
        finding.subject == "total energy without a potential" || finding.subject == "one particle";
    EXPECT_EQ(finding.contradicts_claim(), of_energy) << finding.sentence;
  }
}

TEST(InvariantsExamined, HaveUniqueParts) {
  for (const auto* method : methods()) {
    std::vector<std::string> names;
    for (const auto& part : invariants.parts({{std::string(method->name), {}}}, {})) {
      names.push_back(part.name);
    }
    EXPECT_EQ(names.size(), 17U) << method->name;
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  }
}

}  // namespace
}  // namespace driftless::judge
