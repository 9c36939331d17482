#include <gtest/gtest.h>

#include <cmath>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/observed_order.hpp"
#include "experiments/judge/path_fluid.hpp"
#include "experiments/judge/path_records.hpp"
#include "integrators/shardlow.hpp"

// Orders of convergence and runs on one Wiener path. All seeds are fixed; bounds are ten standard
// errors and more away from what is measured.
namespace driftless::judge {
namespace {

// ---- Verdicts. ----------------------------------------------------------------------------------

/// Deviations c h^order with a relative error.
std::vector<Deviation> power_law(double order, double error, double size = 0.3) {
  std::vector<Deviation> all;
  for (const double h : {0.4, 0.2, 0.1}) {
    const double value = size * std::pow(h / 0.4, order);
    all.push_back({h, value, error * value});
  }
  return all;
}

Finding of(double order, double error, int claimed) {
  return claimed_order({"it", "the deviation", power_law(order, error)}, claimed);
}

TEST(ClaimedOrder, HoldsWhereItIsNotLower) {
  EXPECT_EQ(of(1, 0.02, 1).verdict, Verdict::holds);
  EXPECT_EQ(of(0.85, 0.02, 1).verdict, Verdict::holds);
  EXPECT_EQ(of(2, 0.02, 1).verdict, Verdict::holds);
  EXPECT_NE(of(2, 0.02, 1).sentence.find("higher"), std::string::npos);
  EXPECT_EQ(of(1, 0.02, 1).sentence.find("higher"), std::string::npos);
}

TEST(ClaimedOrder, FailsWhereItIsCertainlyLower) {
  const auto finding = of(0.5, 0.02, 1);
  EXPECT_EQ(finding.verdict, Verdict::fails);
  EXPECT_TRUE(finding.contradicts_claim());
  EXPECT_NEAR(*finding.value, 0.5, 1e-9);
  EXPECT_EQ(of(1, 0.02, 2).verdict, Verdict::fails);
}

TEST(ClaimedOrder, IsLeftOpenWhereTheNoiseIsLarge) {
  EXPECT_EQ(of(0.5, 0.3, 1).verdict, Verdict::not_resolved);
  EXPECT_EQ(of(1, 1, 1).verdict, Verdict::not_resolved);
}

TEST(ClaimedOrder, HoldsWhereThereIsNoDeviation) {
  const std::vector<Deviation> none = {{0.4, 1e-3, 2e-3}, {0.2, -1e-3, 2e-3}};
  EXPECT_EQ(claimed_order({"it", "the deviation", none}, 1).verdict, Verdict::holds);
  const std::vector<Deviation> unknown = {{0.4, 1e-3, 2e-2}, {0.2, -1e-3, 2e-2}};
  EXPECT_EQ(claimed_order({"it", "the deviation", unknown}, 1).verdict, Verdict::not_resolved);
}

// ---- One path. ----------------------------------------------------------------------------------

Candidate candidate(const std::string& name) { return {{name, {}}}; }

/// Half sweeps; `told` says that they are the halves of a step.
template <bool told>
class HalfSweeps : public Integrator {
 public:
  void step(System& system, double dt) override {
    constexpr unsigned parts = told ? 2 : 1;
    shardlow_sweep(system, dt / 2, SweepOrder::forward, {0, parts}, {});
    system.move(dt);
    shardlow_sweep(system, dt / 2, SweepOrder::reverse, {1, parts}, {});
  }
};

/// Takes no heed of the path: steps of another size draw other noise.
class OwnNoise : public Integrator {
 public:
  void step(System& system, double dt) override {
    const auto stage = static_cast<unsigned>(std::lround(1 / dt));
    shardlow_sweep(system, dt, SweepOrder::forward, stage, {});
    system.move(dt);
  }
};

/// Friction that is too strong by what vanishes with the root of the step.
class RootOfTheStep : public Integrator {
 public:
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.accumulate(
        [&](const Pair<double>& pair) {
          const auto law = fluid.friction(pair);
          const double zeta = (1 + std::sqrt(dt)) * law.friction;
          return change_velocity(
              fluid, pair,
              ornstein_uhlenbeck(pair, zeta, law.noise_squared, fluid.reduced_mass(), dt));
        },
        exchange_);
    system.move(dt);
    system.apply(exchange_);
  }

 private:
  Exchange exchange_;
};

template <class Planted>
Candidate plant(std::string_view name) {
  if (!find_method(name)) {
    Method method;
    method.name = name;
    method.closures = {FrictionClosure::noise};
    method.make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<Planted>();
    };
    register_method(method);
  }
  return candidate(std::string(name));
}

struct Runner {
  Candidate candidate;
  unsigned steps, cells;
};

/// Mean square distance of the velocities after one unit of time on the same paths.
double distance(const Runner& one, const Runner& other) {
  double sum = 0;
  for (std::uint64_t replica = 0; replica < 100; ++replica) {
    const auto end = [&](const Runner& runner) {
      PathRun run;
      run.step = 1.0 / runner.steps;
      run.steps = run.interval = runner.steps;
      run.cells = runner.cells;
      run.replica = replica;
      return run_on_path({FrictionClosure::noise, false}, runner.candidate, run).back();
    };
    const State a = end(one), b = end(other);
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += (a.velocity[i] - b.velocity[i]).squaredNorm();
    }
  }
  return sum;
}

/// The order of the momenta's distances of steps 1/16 and 1/64 to their halves.
double momentum_order(const Candidate& chosen) {
  const double coarse = distance({chosen, 16, 16}, {chosen, 32, 8});
  const double fine = distance({chosen, 64, 4}, {chosen, 128, 2});
  return std::log2(coarse / fine) / 4;
}

TEST(OnePath, BringsMomentaTogetherAtFirstOrder) {
  EXPECT_GT(momentum_order(candidate("shardlow-s1")), 0.8);
  EXPECT_GT(momentum_order(candidate("avalos-mackie-midpoint")), 0.8);
  EXPECT_GT(momentum_order(candidate("shardlow-s2")), 0.8);
  EXPECT_LT(momentum_order(plant<OwnNoise>("own-noise")), 0.2);
}

TEST(OnePath, IsTheSameForMethodsThatSayHowTheyCutTheStep) {
  const Runner whole{candidate("shardlow-s1"), 32, 2};
  const double told = distance(whole, {plant<HalfSweeps<true>>("told-halves"), 32, 2});
  const double untold = distance(whole, {plant<HalfSweeps<false>>("untold-halves"), 32, 2});
  EXPECT_LT(10 * told, untold);
}

TEST(OnePath, IsNotThereWhereUniformVariatesDecide) {
  const PathFluid fluid{FrictionClosure::noise, true};
  EXPECT_TRUE(draws_uniforms(candidate("lowe-andersen"), fluid));
  EXPECT_TRUE(draws_uniforms(candidate("metropolized-splitting"), fluid));
  EXPECT_FALSE(draws_uniforms(candidate("shardlow-s2"), fluid));
  EXPECT_FALSE(draws_uniforms(candidate("avalos-mackie-implicit"), fluid));
}

// ---- Whole examinations. ------------------------------------------------------------------------

/// The parts whose names hold a word and not another one, run; the others empty.
Records run_parts(const Examination& examination, const Candidate& chosen, const std::string& word,
                  const std::string& but_not = "0.05") {
  const auto holds = [](const std::string& name, const std::string& what) {
    return name.find(what) != std::string::npos;
  };
  const nlohmann::json empty = {{"failed", 1}, {"rows", nlohmann::json::array()}, {"time_step", 1}};
  Records records;
  for (const auto& part : examination.parts(chosen, {})) {
    const bool wanted = holds(part.name, word) && !holds(part.name, but_not);
    records[part.name] = wanted ? part.run() : empty;
  }
  return records;
}

Finding find(const Conclusion& conclusion, const std::string& words) {
  for (const auto& finding : conclusion.findings) {
    if (finding.subject.find(words) != std::string::npos) return finding;
  }
  return {"", Verdict::not_applicable, "no finding: " + words};
}

Finding stationary(const Candidate& chosen) {
  const auto records = run_parts(orders, chosen, "stationary, closure noise, without");
  return find(orders.conclude(chosen, {}, records), "stationary, closure noise, without");
}

TEST(Orders, OfTheStationaryLawAreAsClaimed) {
  const auto finding = stationary(candidate("averaged-drift"));
  EXPECT_EQ(finding.verdict, Verdict::holds) << finding.sentence;
  EXPECT_NEAR(finding.value.value_or(0), 1, 0.15);
}

TEST(Orders, ThatAreClaimedTooHighFail) {
  const auto finding = stationary(plant<RootOfTheStep>("root-of-the-step"));
  EXPECT_TRUE(finding.contradicts_claim()) << finding.sentence;
}

TEST(Orders, OfARefusedClosureAreNotApplicable) {
  const Candidate chosen = candidate("espanol");
  const auto finding =
      find(orders.conclude(chosen, {}, run_parts(orders, chosen, "nothing")), "closure friction");
  EXPECT_EQ(finding.verdict, Verdict::not_applicable);
}

TEST(CommonNoise, SharpensDifferencesOnlyWhereItIsCommon) {
  const auto factor = [](const Candidate& chosen) {
    const auto records = run_parts(common_noise, chosen, "noise");
    return find(common_noise.conclude(chosen, {}, records),
                "step against half step, kinetic energy, closure noise, duration 1");
  };
  const auto common = factor(candidate("shardlow-s1"));
  EXPECT_GT(common.value.value_or(0), 8) << common.sentence;
  // The start is common all the same.
  const auto own = factor(plant<OwnNoise>("own-noise"));
  EXPECT_LT(own.value.value_or(100), 3) << own.sentence;
}

}  // namespace
}  // namespace driftless::judge
