#include <gtest/gtest.h>

#include <algorithm>

#include "tests/two_body_checks.hpp"

// Every registered method against the exact law of isolated pairs, for every closure that it
// claims: the tests know no method by name.
namespace driftless::two_body {
namespace {

struct Case {
  const Method* method;
  FrictionClosure closure;
  double phi_over_k;
  HeatForm form;

  std::string name() const {
    std::string text = std::string(method->name) + "_" + std::string(to_string(closure)) + "_" +
                       std::to_string(static_cast<int>(phi_over_k)) + "_" +
                       std::string(to_string(form));
    std::replace(text.begin(), text.end(), '-', '_');
    return text;
  }
  bool nearly_isothermal() const { return phi_over_k > 10; }
  Bench bench() const {
    return make_bench(phi_over_k, closure, form, nearly_isothermal() ? 1 : 0.5);
  }
  Factory make() const {
    return [chosen = method] { return chosen->make({}); };
  }
  /// Its own noise, whatever other methods there are (FNV-1a of the name).
  std::uint64_t seed() const {
    std::uint64_t hash = 14695981039346656037U;
    for (const char c : name()) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
    return hash;
  }
  /// Small enough for few copies to fail, large enough for a bias of first order to be seen.
  Schedule run() const {
    Schedule run;
    run.dt = nearly_isothermal() ? 0.2 : 0.04;
    run.settle = 4;
    run.measure = 32;
    run.ensembles = nearly_isothermal() ? 40 : 20;
    run.pairs.seed = seed();
    return run;
  }
};

void PrintTo(const Case& tested, std::ostream* stream) { *stream << tested.name(); }

/// All methods and their closures at both heat capacities; the second heat form where the energies
/// fluctuate most, with each method's last closure.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Method* method : methods()) {
    for (const auto closure : method->closures) {
      all.push_back({method, closure, 50, HeatForm::inverse_temperature});
      all.push_back({method, closure, 3, HeatForm::inverse_temperature});
    }
    if (method->closures.empty()) continue;
    all.push_back({method, method->closures.back(), 3, HeatForm::temperature});
  }
  return all;
}

/// The runs at dt, dt/2 and dt/4; where nothing stands out of the noise at dt, at up to four times
/// these steps and with more copies. A method exact at any step goes up to steps at which a pair
/// relaxes at once.
Ladder resolving_ladder(const Case& tested) {
  if (tested.method->pair_law_exact) {
    Schedule run = tested.run();
    run.dt = tested.nearly_isothermal() ? 1.6 : 0.8;
    run.ensembles *= 10;
    return climb(tested.bench(), tested.make(), run);
  }
  Ladder ladder = climb(tested.bench(), tested.make(), tested.run());
  for (int n = 0; n < 2 && tested.nearly_isothermal() && !resolves_something(ladder); ++n) {
    ladder.run.dt *= 2;
    ladder.run.ensembles *= 4;
    ladder.run.pairs.seed += 10;
    const Outcome coarse = measure(tested.bench(), tested.make(), ladder.run);
    ladder.rungs = {coarse, ladder.rungs[0], ladder.rungs[1]};
  }
  return ladder;
}

class TwoBody : public testing::TestWithParam<Case> {};

TEST_P(TwoBody, SharesOfEnergyTendToTheExactLaw) {
  const Case& tested = GetParam();
  const int order = tested.method->weak_order;
  const Ladder ladder = resolving_ladder(tested);
  const auto holds = [](const Verdict& verdict) { EXPECT_TRUE(verdict) << verdict.complaint; };
  if (tested.method->pair_law_exact) {
    holds(exact_at_every_step(ladder, 0.02));
  } else {
    holds(limit_is_exact(ladder, order));
    holds(shrinks_at_order(ladder, order));
    holds(sharp(ladder, order, 0.01));
  }
  holds(momentum_is_kept(ladder));
  holds(energy_as_claimed(ladder, tested.method->energy_ideal));
  const bool never_fails = tested.nearly_isothermal() || tested.method->pair_law_exact;
  holds(few_failures(ladder, never_fails ? 0 : 0.06));
  if (tested.nearly_isothermal() && !tested.method->pair_law_exact) {
    EXPECT_TRUE(resolves_something(ladder)) << "nothing stands out of the noise";
  }
}

TEST_P(TwoBody, AStartFarAwayReachesTheSameLaw) {
  const Case& tested = GetParam();
  Schedule run = tested.run();
  run.dt /= 2;
  run.measure = 8;
  run.ensembles /= 2;
  const Outcome near = measure(tested.bench(), tested.make(), run);
  run.settle = 14;  // exp(-14/2) of the start is left at the slower of the two rates
  run.pairs.start = Start::far;
  run.pairs.seed += 1;
  const Outcome far = measure(tested.bench(), tested.make(), run);
  const Verdict verdict = same_law(near, far);
  EXPECT_TRUE(verdict) << verdict.complaint;
  EXPECT_LE(far.failed_fraction, tested.nearly_isothermal() ? 0 : 0.06);
}

TEST_P(TwoBody, AMovingCentreOfMassChangesTheLawOnlyAsClaimed) {
  const Case& tested = GetParam();
  const Bench bench = tested.bench();
  Schedule run = tested.run();
  run.dt /= 2;
  run.settle = 2;
  run.measure = 4;
  run.ensembles /= 2;
  const Outcome at_rest = measure(bench, tested.make(), run);
  // Fast enough for m V to move as much internal energy as conduction does.
  run.pairs.frame_velocity =
      std::sqrt(tested.phi_over_k * bench.thermal_energy() / bench.fluid.mass());
  const Outcome moving = measure(bench, tested.make(), run);
  if (tested.method->galilean) {
    const Verdict verdict = same_in_every_frame(at_rest, moving);
    EXPECT_TRUE(verdict) << verdict.complaint;
  } else {
    EXPECT_FALSE(same_law(at_rest, moving)) << "no difference between frames is seen";
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, TwoBody, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name(); });

}  // namespace
}  // namespace driftless::two_body
