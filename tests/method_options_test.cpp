#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "integrators/reference.hpp"
#include "tests/planted_schemes.hpp"
#include "tests/small_system.hpp"
#include "tests/two_body_checks.hpp"

// What the methods claim, where their options are not the defaults: the suites over the registry
// see defaults alone.
namespace driftless {
namespace {

using driftless::testing::distance;
using driftless::testing::small_box;
using driftless::testing::small_fluid;
using driftless::testing::small_state;
using driftless::testing::Terms;
using two_body::Bench;
using two_body::Ladder;
using two_body::Verdict;

/// A method with options.
struct Choice {
  std::string method;
  Options options;

  const Method& claims() const { return *find_method(method); }
  std::unique_ptr<Integrator> make() const { return claims().make(options); }
  std::string name() const {
    std::string text = method;
    for (const auto& [key, value] : options) {
      text += "_" + key + "_";
      if (const auto* word = std::get_if<std::string>(&value)) text += *word;
      if (const auto* number = std::get_if<double>(&value)) text += std::to_string(*number);
    }
    for (char& c : text) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return text;
  }
};

void PrintTo(const Choice& choice, std::ostream* stream) { *stream << choice.name(); }

const std::string exponential = "exponential", frozen = "frozen";

std::vector<Choice> choices() {
  std::vector<Choice> all = {
      {"avalos-mackie-explicit", {{"own_products", true}}},
      {"groot-warren", {{"lambda", 0.5}}},
      {"groot-warren", {{"lambda", 1.0}}},
      {"splitting-energy-reinjection", {{"reinject_potential", true}}},
      {"metropolized-splitting", {{"conduction_proposal", exponential}}},
      {"metropolized-splitting", {{"symmetric", true}}},
      {"peters", {{"scheme", std::string("II")}}},
      {"lowe-andersen", {{"rate", 5.0}}},
  };
  for (const auto* method : {"shardlow-s1", "shardlow-s2", "shardlow-aboba"}) {
    const bool is_default = std::string(method) == "shardlow-aboba";
    const std::string other = is_default ? "half-implicit" : exponential;
    all.push_back({method, {{"update", other}}});
    all.push_back({method, {{"temperatures", frozen}}});
    all.push_back({method, {{"update", other}, {"temperatures", frozen}}});
    all.push_back({method, {{"order", std::string("ids")}}});
  }
  return all;
}

std::vector<Terms> terms_of(const Choice& choice) {
  std::vector<Terms> all;
  for (const auto closure : choice.claims().closures) {
    for (const auto heat : driftless::testing::all_heat_forms()) {
      for (const bool potential : {false, true}) all.push_back({closure, heat, potential});
    }
  }
  return all;
}

State run(const Choice& choice, const FluidParameters& fluid, const State& start, double dt,
          std::uint64_t steps) {
  System system(Fluid(fluid), small_box(), start, Noise(7, 0));
  const auto integrator = choice.make();
  driftless::testing::run(*integrator, system, dt, 1, steps + 1);
  return system.state();
}

double energy(const FluidParameters& fluid, const State& state) {
  return System(Fluid(fluid), small_box(), state, Noise(0, 0)).total_energy();
}

class Choices : public ::testing::TestWithParam<Choice> {};

constexpr double rounding = 1e-11;

TEST_P(Choices, ConserveAndStandStillAsTheDefaultsDo) {
  const Choice& choice = GetParam();
  for (const auto& terms : terms_of(choice)) {
    SCOPED_TRACE(terms.name());
    const auto f = small_fluid(terms, 0.5);
    const State start = small_state(f);
    const State end = run(choice, f, start, 0.01, 20);
    const System before(Fluid(f), small_box(), start, Noise(0, 0)),
        after(Fluid(f), small_box(), end, Noise(0, 0));
    EXPECT_LT((after.momentum() - before.momentum()).norm(), rounding);
    const bool exact = !terms.potential && choice.claims().energy_ideal == EnergyClaim::exact;
    const double change = std::abs(energy(f, end) / energy(f, start) - 1);
    EXPECT_LT(change, exact ? rounding : 0.02);
    EXPECT_TRUE(terms.potential || exact || change > 1e-8);
    EXPECT_TRUE(driftless::testing::same_bits(run(choice, f, start, 0, 3), start));
  }
}

TEST_P(Choices, SeeNoUniformVelocity) {
  const Choice& choice = GetParam();
  const Vector boost(1.7, -0.9, 2.3);
  for (const auto& terms : terms_of(choice)) {
    SCOPED_TRACE(terms.name());
    const auto f = small_fluid(terms, 0.5);
    State moving = small_state(f);
    for (auto& velocity : moving.velocity) velocity += boost;
    State end = run(choice, f, moving, 0.01, 20);
    for (std::size_t i = 0; i < end.size(); ++i) {
      end.velocity[i] -= boost;
      end.position[i] -= boost * (0.01 * 20);
    }
    EXPECT_LT(distance(small_box(), end, run(choice, f, small_state(f), 0.01, 20)).largest(),
              rounding);
  }
}

/// The order towards the reference without fluctuations, from dt = duration/200 and half of it.
double noise_free_order(const Choice& choice, const Terms& terms) {
  constexpr double duration = 0.5;
  const auto f = small_fluid(terms, 0);
  const State exact = reference_solution(Fluid(f), small_box(), small_state(f), false, duration);
  const auto error = [&](int steps) {
    const State end = run(choice, f, small_state(f), duration / steps, steps);
    const auto d = distance(small_box(), end, exact);
    return std::max({d.position, d.velocity, d.internal_energy / f.heat_capacity});
  };
  return std::log2(error(200) / error(400));
}

TEST_P(Choices, ConvergeWithoutFluctuations) {
  const Choice& choice = GetParam();
  if (!choice.claims().consistent) return;
  const bool of_potentials = choice.method == "splitting-energy-reinjection";
  for (const auto& terms : terms_of(choice)) {
    if (terms.potential != of_potentials) continue;
    SCOPED_TRACE(terms.name());
    EXPECT_GT(noise_free_order(choice, terms), choice.claims().noise_free_order - 0.2);
  }
}

TEST_P(Choices, TendToTheExactLawOfPairs) {
  const Choice& choice = GetParam();
  if (choice.method == "splitting-energy-reinjection")
    return;  // has an effect on a potential alone
  const Bench bench =
      two_body::make_bench(3, choice.claims().closures.back(), HeatForm::inverse_temperature, 0.5);
  two_body::Schedule schedule;
  schedule.dt = 0.04;
  schedule.measure = 16;
  schedule.ensembles = 10;
  schedule.pairs.seed = 4711;
  const Ladder ladder = climb(
      bench, [&] { return choice.make(); }, schedule);
  const auto holds = [](const Verdict& verdict) { EXPECT_TRUE(verdict) << verdict.complaint; };
  if (choice.claims().pair_law_exact) {
    holds(exact_at_every_step(ladder, 0.1));
  } else {
    holds(limit_is_exact(ladder, 1));
    holds(sharp(ladder, 1, 0.02));
  }
  holds(energy_as_claimed(ladder, choice.claims().energy_ideal));
}

INSTANTIATE_TEST_SUITE_P(Methods, Choices, ::testing::ValuesIn(choices()),
                         [](const auto& tested) { return tested.param.name(); });

// ---- What single options do. --------------------------------------------------------------------

// Symmetric methods are of second order where nothing that is frozen in a pair's update changes.
TEST(Options, LeaveSymmetricMethodsAtSecondOrderWhereCoefficientsStayConstant) {
  const Terms constant{FrictionClosure::friction, HeatForm::none};
  for (const Choice& choice :
       {Choice{"trotter", {}}, Choice{"shardlow-s2", {{"update", exponential}}},
        Choice{"shardlow-s2", {{"temperatures", frozen}}},
        Choice{"metropolized-splitting", {{"symmetric", true}}}}) {
    EXPECT_NEAR(noise_free_order(choice, constant), 2, 0.2) << choice.name();
    EXPECT_NEAR(noise_free_order(choice, {FrictionClosure::noise, HeatForm::none}), 1, 0.2)
        << choice.name();
  }
}

// The velocities at which groot-warren takes its forces are off by (1 - lambda) F dt/m.
TEST(Options, LambdaOfOneMakesGrootWarrenOfSecondOrder) {
  for (const auto& terms : terms_of({"groot-warren", {}})) {
    if (terms.potential) continue;
    EXPECT_NEAR(noise_free_order({"groot-warren", {{"lambda", 1.0}}}, terms), 2, 0.2);
    EXPECT_NEAR(noise_free_order({"groot-warren", {{"lambda", 0.5}}}, terms), 1, 0.2);
  }
}

TEST(Options, LambdaOfOneHalfMakesGrootWarrenVelocityVerlet) {
  for (const auto& terms : terms_of({"groot-warren", {}})) {
    const auto f = small_fluid(terms, 0.5);
    const State half = run({"groot-warren", {{"lambda", 0.5}}}, f, small_state(f), 0.01, 20);
    EXPECT_TRUE(driftless::testing::same_bits(
        half, run({"velocity-verlet", {}}, f, small_state(f), 0.01, 20)));
    const State more = run({"groot-warren", {}}, f, small_state(f), 0.01, 20);
    EXPECT_GT(distance(small_box(), half, more).velocity, 1e-4);
  }
}

// Without moves, Verlet does nothing and all that is left are the sweeps.
TEST(Options, SchemeTwoOfPetersIsTheExponentialUpdateOfShardlow) {
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    const auto f = small_fluid({closure, HeatForm::temperature}, 0.5);
    const auto end_of = [&](const Choice& choice) {
      System system(Fluid(f), small_box(), small_state(f), Noise(7, 0), true);
      const auto integrator = choice.make();
      driftless::testing::run(*integrator, system, 0.01, 1, 11);
      return system.state();
    };
    EXPECT_TRUE(driftless::testing::same_bits(end_of({"peters", {{"scheme", std::string("II")}}}),
                                              end_of({"shardlow-s1", {{"update", exponential}}})));
  }
}

// Total energy with a potential: the Verlet part's error goes back to where it came from.
TEST(Options, ReinjectPotentialKeepsTotalEnergyToRounding) {
  for (const auto& terms : terms_of({"splitting-energy-reinjection", {}})) {
    if (!terms.potential) continue;
    SCOPED_TRACE(terms.name());
    const auto f = small_fluid(terms, 0.5);
    const State start = small_state(f);
    const auto change = [&](bool reinject) {
      const Choice choice{"splitting-energy-reinjection", {{"reinject_potential", reinject}}};
      return std::abs(energy(f, run(choice, f, start, 0.02, 50)) / energy(f, start) - 1);
    };
    EXPECT_LT(change(true), 1e-13);
    EXPECT_GT(change(false), 1e-7);
  }
}

TEST(Options, AreRefusedWithWhatIsAllowed) {
  const auto complaint = [](const Choice& choice) -> std::string {
    try {
      choice.make();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint({"peters", {{"scheme", std::string("III")}}}),
            "scheme is \"III\", allowed is \"I\" or \"II\"");
  EXPECT_EQ(complaint({"shardlow-s1", {{"update", std::string("exact")}}}),
            "update is \"exact\", allowed is \"half-implicit\" or \"exponential\"");
  EXPECT_EQ(complaint({"groot-warren", {{"lambda", 0.0}}}),
            "lambda is 0, allowed is above 0 and at most 1");
  EXPECT_EQ(complaint({"groot-warren", {{"lambda", 1.5}}}),
            "lambda is 1.5, allowed is above 0 and at most 1");
  EXPECT_NE(complaint({"groot-warren", {{"lambda", std::nan("")}}}), "");
  EXPECT_EQ(complaint({"lowe-andersen", {{"rate", -1.0}}}), "rate is -1, allowed is above 0");
  EXPECT_NE(complaint({"lowe-andersen", {{"resampling", std::string("none")}}}), "");
  EXPECT_NE(complaint({"metropolized-splitting", {{"conduction_proposal", std::string("")}}}), "");
  EXPECT_EQ(complaint({"groot-warren", {{"lambda", 1.0}}}), "");
}

}  // namespace
}  // namespace driftless
