#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "integrators/metropolis.hpp"
#include "integrators/pairwise_exchange.hpp"
#include "tests/planted_schemes.hpp"
#include "tests/small_system.hpp"
#include "tests/two_body_checks.hpp"

// Moves of a pair that leave its exact law as it is at any step: detailed balance point by point
// against densities written down here anew, laws at large steps, shares of refusals.
namespace driftless::two_body {
namespace {

using Kernel = std::function<Transfer<double>(const Fluid&, const Pair<double>&, double)>;

Transfer<double> friction(const Fluid& fluid, const Pair<double>& pair, double dt) {
  return metropolis_friction(fluid, pair, dt);
}
Kernel conduction(ConductionProposal kind) {
  return [kind](const Fluid& fluid, const Pair<double>& pair, double dt) {
    return metropolis_conduction(fluid, pair, dt, kind);
  };
}

bool moves(const Transfer<double>& transfer) {
  return transfer.momentum != 0 || transfer.energy_i != 0;
}

/// The probability of acceptance: the uniform variate above which a kernel refuses.
double acceptance_of(const Kernel& kernel, const Fluid& fluid, Pair<double> pair, double dt) {
  const auto moves_at = [&](double uniform) {
    pair.uniform = pair.heat_uniform = uniform;
    return moves(kernel(fluid, pair, dt));
  };
  if (moves_at(1)) return 1;
  double low = 0, high = 1;
  for (int n = 0; n < 60; ++n) (moves_at(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

// ---- Densities, by hand. ------------------------------------------------------------------------

/// Mean and variance of a proposal's coordinate, and the coordinate itself.
struct Gaussian {
  double mean, variance;
  double log_density(double x) const {
    return -0.5 * (x - mean) * (x - mean) / variance - 0.5 * std::log(variance);
  }
};

/// One kind of move: its coordinate, its proposal and the noise of a pair that it uses.
struct Move {
  Kernel kernel;
  std::function<double(const Pair<double>&)> coordinate;
  std::function<Gaussian(const FluidParameters&, const Pair<double>&, double)> proposal;
  double Pair<double>::*noise;
};

double harmonic(double a, double b) { return 2 * a * b / (a + b); }

Gaussian velocity_proposal(const FluidParameters& f, const Pair<double>& p, double dt) {
  const double mean = harmonic(p.u_i, p.u_j) / f.heat_capacity, mu = f.mass / 2;
  const bool constant_noise = f.friction_closure == FrictionClosure::noise;
  const double zeta = f.friction * p.w_friction * (constant_noise ? f.temperature / mean : 1);
  const double alpha = std::exp(-zeta * dt / mu);
  return {alpha * p.v, f.boltzmann * mean / mu * (1 - alpha * alpha)};
}

/// Of the internal energy of i.
template <ConductionProposal kind>
Gaussian energy_proposal(const FluidParameters& f, const Pair<double>& p, double dt) {
  const double phi = f.heat_capacity, theta_i = p.u_i / phi, theta_j = p.u_j / phi;
  const bool fourier = f.heat_form == HeatForm::temperature;
  const double lambda = f.conduction * p.w_heat / (fourier ? 1 : theta_i * theta_j);
  const double difference = theta_j - theta_i;
  if (kind == ConductionProposal::exponential) {
    const double alpha = std::exp(-lambda * (2 / phi) * dt);
    return {p.u_i + (1 - alpha) * difference / (2 / phi),
            f.boltzmann * theta_i * theta_j * (1 - alpha * alpha) / (2 / phi)};
  }
  const double induced = fourier ? f.boltzmann * lambda * difference / phi : 0;
  return {p.u_i + (lambda * difference + induced) * dt,
          2 * f.boltzmann * lambda * theta_i * theta_j * dt};
}

Move friction_move(const Kernel& kernel) {
  return {kernel, [](const auto& p) { return p.v; }, velocity_proposal, &Pair<double>::noise};
}
template <ConductionProposal kind>
Move conduction_move() {
  return {conduction(kind), [](const auto& p) { return p.u_i; }, energy_proposal<kind>,
          &Pair<double>::heat_noise};
}

/// The largest violation of ln{rho q(x'|x) A(x'|x)} = ln{rho' q(x|x') A(x|x')} over random pairs.
double imbalance(const Bench& bench, const Move& move, double dt) {
  const auto& f = bench.fluid.parameters();
  const double k = f.boltzmann;
  testing::Uniform uniform(3);
  double worst = 0;
  int compared = 0;
  for (int n = 0; n < 400; ++n) {
    const double u = 0.5 * bench.energy, w = 0.36;
    Pair<double> here{0.4, w, w, uniform(-1, 1), uniform(0.2, 2) * u, uniform(0.2, 2) * u, 0, 0};
    here.*move.noise = uniform(-2.5, 2.5);
    const double there_probability = acceptance_of(move.kernel, bench.fluid, here, dt);
    here.uniform = here.heat_uniform = 0.5 * there_probability;
    const auto transfer = move.kernel(bench.fluid, here, dt);
    if (there_probability < 1e-6 || !moves(transfer)) continue;  // impossible, or nearly so
    Pair<double> there = after(bench.fluid, here, transfer);
    const Gaussian forth = move.proposal(f, here, dt), back = move.proposal(f, there, dt);
    there.*move.noise = (move.coordinate(here) - back.mean) / std::sqrt(back.variance);
    const double back_probability = acceptance_of(move.kernel, bench.fluid, there, dt);
    there.uniform = there.heat_uniform = 0.5 * back_probability;
    const auto returned = move.kernel(bench.fluid, there, dt);
    EXPECT_NEAR(returned.momentum, -transfer.momentum, 1e-9);
    EXPECT_NEAR(returned.energy_i, -transfer.energy_i, 1e-9);
    const auto entropy = [&](const Pair<double>& p) {
      return f.heat_capacity * (std::log(p.u_i) + std::log(p.u_j));
    };
    const double flow =
        entropy(here) / k + forth.log_density(move.coordinate(there)) + std::log(there_probability);
    const double reverse =
        entropy(there) / k + back.log_density(move.coordinate(here)) + std::log(back_probability);
    worst = std::max(worst, std::abs(flow - reverse));
    ++compared;
  }
  EXPECT_GT(compared, 50);
  return worst;
}

std::vector<Bench> benches() {
  std::vector<Bench> all;
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const auto form : {HeatForm::inverse_temperature, HeatForm::temperature}) {
      for (const double phi_over_k : {3.0, 50.0}) {
        all.push_back(make_bench(phi_over_k, closure, form));
      }
    }
  }
  return all;
}

constexpr double balanced = 1e-6;  // of logarithms, with probabilities found by bisection

TEST(Metropolis, HoldsDetailedBalancePointByPoint) {
  for (const Bench& bench : benches()) {
    for (const double dt : {0.01, 0.3, 1.5}) {
      EXPECT_LT(imbalance(bench, friction_move(friction), dt), balanced);
      EXPECT_LT(imbalance(bench, conduction_move<ConductionProposal::exponential>(), dt), balanced);
      EXPECT_LT(imbalance(bench, conduction_move<ConductionProposal::euler>(), 0.3 * dt), balanced);
    }
  }
}

// ---- Wrong acceptances. -------------------------------------------------------------------------

/// metropolis_friction with another acceptance, given entropy gain, back, spread there and back.
Kernel with_acceptance(
    std::function<double(const Fluid&, double, const Pair<double>&, double, double, double)> rule) {
  return [rule = std::move(rule)](const Fluid& fluid, const Pair<double>& pair, double dt) {
    const auto there = friction_proposal(fluid, pair, dt);
    const double change = there.drift + std::sqrt(fluid.boltzmann() * there.spread) * pair.noise;
    const auto transfer = change_velocity(fluid, pair, change);
    const PossibleGains<double> gains(pair, transfer);
    Pair<double> proposed = pair;
    proposed.v += change;
    proposed.u_i += gains.i;
    proposed.u_j += gains.j;
    const auto back = friction_proposal(fluid, proposed, dt);
    const double gain = entropy_gain(fluid, pair, gains);
    return accepted(fluid, transfer, gains.possible,
                    rule(fluid, gain, pair, -change - back.drift, there.spread, back.spread),
                    pair.uniform);
  };
}

/// A wrong acceptance, and whether it is wrong where Gamma is constant.
struct Fault {
  const char* name;
  Kernel kernel;
};

std::vector<Fault> faults() {
  return {{"every move is accepted",
           with_acceptance([](auto&, auto, auto&, auto, auto, auto) { return 0.0; })},
          {"no logarithm of the spreads",
           with_acceptance([](auto& fluid, auto gain, auto& pair, auto back, auto, auto there) {
             return acceptance(fluid, gain, pair.noise, back, there, there);
           })},
          {"the way back with the spread of the way there",
           with_acceptance([](auto& fluid, auto gain, auto& pair, auto back, auto here, auto) {
             return acceptance(fluid, gain, pair.noise, back, here, here);
           })},
          {"half of the entropy", with_acceptance([](auto& fluid, auto gain, auto& pair, auto back,
                                                     auto here, auto there) {
             return acceptance(fluid, 0.5 * gain, pair.noise, back, here, there);
           })}};
}

TEST(MetropolisFaults, BreakDetailedBalance) {
  const Kernel right =
      with_acceptance([](auto& fluid, auto gain, auto& pair, auto back, auto here, auto there) {
        return acceptance(fluid, gain, pair.noise, back, here, there);
      });
  for (const Bench& bench : benches()) {
    EXPECT_LT(imbalance(bench, friction_move(right), 0.3), balanced);
    for (const auto& fault : faults()) {
      EXPECT_GT(imbalance(bench, friction_move(fault.kernel), 0.3), 1e-3) << fault.name;
    }
  }
}

// ---- The law at large steps. --------------------------------------------------------------------

/// One sweep of a kernel, then conduction by the sound exponential move.
class Swept : public Integrator {
 public:
  explicit Swept(Kernel kernel) : kernel_(std::move(kernel)) {}
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    const Sweep how{.uniforms = true};
    system.sweep(
        [&](const Pair<double>& pair) {
          return friction_and_conduction(
              fluid, pair, how, [&](const auto& seen) { return kernel_(fluid, seen, dt); },
              [&](const auto& seen) {
                return metropolis_conduction(fluid, seen, dt, ConductionProposal::exponential);
              });
        },
        how);
  }

 private:
  Kernel kernel_;
};

Verdict exact_with(const Kernel& kernel, const Bench& bench, double dt) {
  Schedule run;
  run.dt = dt;
  run.settle = 4 * dt;
  run.measure = 60 * dt;
  run.ensembles = 40;
  run.pairs.seed = 77;
  const Outcome found = measure(
      bench, [&] { return std::make_unique<Swept>(kernel); }, run);
  for (int m = 0; m < moments; ++m) {
    if (std::abs(found.deviations[m].mean) <= z_bound * found.deviations[m].error) continue;
    return complain(moment_names[m], " is off by ", found.deviations[m].mean, " +- ",
                    found.deviations[m].error);
  }
  if (found.failed_fraction > 0) return complain("copies failed");
  return {};
}

Bench small_capacity(FrictionClosure closure) {
  return make_bench(3, closure, HeatForm::inverse_temperature);
}

// A step of 0.7 and of 10 relaxation times. 24 moments, each wrong by chance in 1 of 10^9 cases.
TEST(Metropolis, IsExactInLawAtLargeSteps) {
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const double dt : {0.7, 10.0}) {
      const Verdict verdict = exact_with(friction, small_capacity(closure), dt);
      EXPECT_TRUE(verdict) << verdict.complaint;
    }
  }
}

TEST(MetropolisFaults, BreakTheLaw) {
  for (const auto& fault : faults()) {
    EXPECT_FALSE(exact_with(fault.kernel, small_capacity(FrictionClosure::noise), 0.7))
        << fault.name;
  }
}

TEST(LoweAndersen, IsExactInLawAtAnyRateButNotWithMaxwellsVelocities) {
  const auto jumps = [](double rate, Resampling resampling) -> Kernel {
    return [=](const Fluid& fluid, const Pair<double>& pair, double dt) {
      return lowe_andersen_friction(fluid, pair, dt, rate, resampling);
    };
  };
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    const Bench bench = small_capacity(closure);
    for (const double rate : {1.0, 20.0}) {
      const Verdict verdict = exact_with(jumps(rate, Resampling::exact), bench, 1);
      EXPECT_TRUE(verdict) << verdict.complaint;
    }
  }
  // The step has nothing to do with it: one as small is as wrong. Where there is much internal
  // energy, little is.
  for (const double dt : {1.0, 0.05}) {
    const Bench bench = make_bench(10, FrictionClosure::friction, HeatForm::inverse_temperature);
    EXPECT_FALSE(exact_with(jumps(1 / dt, Resampling::maxwell), bench, dt));
  }
}

// ---- Refusals. ----------------------------------------------------------------------------------

/// The share of moves refused from pairs in the exact law; dt in relaxation times of v and u_i -
/// u_j.
double refused(const Bench& bench, const Kernel& kernel, double dt, unsigned pairs = 200000) {
  Pairs start;
  start.count = pairs;
  const Ensemble ensemble(bench, start);
  const Noise noise(9, 0);
  double count = 0;
  for (unsigned n = 0; n < pairs; ++n) {
    const auto view = ensemble.view(n);
    const auto normals = noise.pair_normals(2 * n, 2 * n + 1, 0, true, true);
    const auto uniforms = noise.pair_uniforms(2 * n, 2 * n + 1, 0);
    const double w = (1 - bench.pair_distance) * (1 - bench.pair_distance);
    const Pair<double> pair{bench.pair_distance,
                            w,
                            w,
                            view.velocity,
                            view.u_i,
                            view.u_j,
                            normals.friction,
                            normals.heat,
                            uniforms.friction,
                            uniforms.heat};
    count += moves(kernel(bench.fluid, pair, dt)) ? 0 : 1;
  }
  return count / pairs;
}

/// Five in a hundred and 6.1 standard errors of a count.
void expect_share(double share, double expected, unsigned pairs = 200000) {
  EXPECT_NEAR(share, expected, 0.05 * expected + z_bound * std::sqrt(expected / pairs));
}

// Friction at step 10 refuses about 0.1 k/phi. Of conduction the published proposal is refused ever
// more often, whatever phi/k, the exponential one in 0.19 k/phi of the cases at most.
TEST(Metropolis, RefusesAsOftenAsItShould) {
  const auto bench = [](double phi_over_k) {
    return make_bench(phi_over_k, FrictionClosure::noise, HeatForm::inverse_temperature);
  };
  expect_share(refused(bench(60), friction, 10), 0.00167);
  expect_share(refused(bench(10), friction, 10), 0.0100);
  expect_share(refused(bench(2), friction, 10), 0.054);
  const auto euler = conduction(ConductionProposal::euler);
  const auto exponential = conduction(ConductionProposal::exponential);
  // make_bench counts a relaxation time of u_i - u_j as 1.
  expect_share(refused(bench(60), euler, 0.1), 0.0070);
  expect_share(refused(bench(60), euler, 1), 0.213);
  expect_share(refused(bench(60), euler, 10), 0.941);
  expect_share(refused(bench(60), exponential, 0.1), 0.00016);
  expect_share(refused(bench(60), exponential, 10), 0.0031);
  expect_share(refused(bench(2), exponential, 10), 0.090);
}

// Refusals make the noise-induced friction where there is one, and are then much more frequent.
TEST(Metropolis, RefusalsVanishWithTheStepFasterWhereGammaIsConstant) {
  const auto order = [](FrictionClosure closure) {
    const auto bench = make_bench(3, closure, HeatForm::inverse_temperature);
    return std::log(refused(bench, friction, 0.08) / refused(bench, friction, 0.02)) / std::log(4);
  };
  EXPECT_NEAR(order(FrictionClosure::noise), 1.5, 0.25);
  EXPECT_NEAR(order(FrictionClosure::friction), 0.5, 0.1);
}

// ---- At the edge. -------------------------------------------------------------------------------

TEST(Metropolis, RefusesWhatWouldEndBelowZeroAndStandsStillWithoutAWeightOrAStep) {
  const Bench bench = small_capacity(FrictionClosure::noise);
  const auto all = [&](const Pair<double>& pair, double dt) {
    return std::vector<Transfer<double>>{
        friction(bench.fluid, pair, dt),
        conduction(ConductionProposal::euler)(bench.fluid, pair, dt),
        conduction(ConductionProposal::exponential)(bench.fluid, pair, dt),
        lowe_andersen_friction(bench.fluid, pair, dt, 1, Resampling::exact)};
  };
  for (const double u : {1e-9, 1e-3, 1.0}) {
    for (const double noise : {-8.0, -2.0, 0.0, 2.0, 8.0}) {
      const Pair<double> pair{0.4, 0.36, 0.36, 0.5, u, 2 * u, noise, noise, 1e-9, 1e-9};
      for (const double dt : {1e-6, 1.0, 1e3}) {
        for (const auto& transfer : all(pair, dt)) {
          EXPECT_GT(pair.u_i + transfer.energy_i, 0);
          EXPECT_GT(pair.u_j + transfer.energy_j, 0);
        }
      }
      for (const auto& transfer : all(pair, 0)) EXPECT_FALSE(moves(transfer));
      Pair<double> apart = pair;
      apart.w_friction = apart.w_heat = 0;
      for (const auto& transfer : all(apart, 1)) EXPECT_FALSE(moves(transfer));
    }
  }
}

// Without fluctuations the moves are relaxation to zero and to equal temperatures, never refused.
TEST(Metropolis, WithoutFluctuationsRelaxes) {
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    auto f = make_bench(3, closure, HeatForm::temperature).fluid.parameters();
    f.boltzmann = 0;
    const Fluid fluid(f);
    const Pair<double> pair{0.4, 0.36, 0.36, 0.7, 3, 5, 0, 0, 0.999, 0.999};
    const double x = fluid.friction(pair).friction * 0.3 / fluid.reduced_mass();
    EXPECT_NEAR(friction(fluid, pair, 0.3).momentum,
                fluid.reduced_mass() * 0.7 * (std::exp(-x) - 1), 1e-14);
    const double y = fluid.conductivity(pair) * 2 / f.heat_capacity * 0.3;
    EXPECT_NEAR(conduction(ConductionProposal::exponential)(fluid, pair, 0.3).energy_i,
                1 - std::exp(-y), 1e-14);
    EXPECT_NEAR(conduction(ConductionProposal::euler)(fluid, pair, 0.3).energy_i, y, 1e-14);
  }
}

// However small the move: what rounding takes from the entropy is given back.
TEST(Metropolis, RefusesNothingWithoutFluctuations) {
  testing::Uniform uniform(1);
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    auto f = make_bench(3, closure, HeatForm::temperature).fluid.parameters();
    f.boltzmann = 0;
    const Fluid fluid(f);
    for (int n = 0; n < 20000; ++n) {
      const double w = std::exp(uniform(-40, -1)), v = std::exp(uniform(-20, 1));
      const Pair<double> pair{0.4, w, w, v, uniform(3, 9), uniform(3, 9), 0, 0, 0.5, 0.5};
      ASSERT_TRUE(moves(friction(fluid, pair, 0.01)));
      ASSERT_TRUE(moves(conduction(ConductionProposal::exponential)(fluid, pair, 0.01)));
    }
  }
}

}  // namespace
}  // namespace driftless::two_body
