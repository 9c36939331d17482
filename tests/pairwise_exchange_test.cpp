#include <gtest/gtest.h>

#include <cmath>

#include "integrators/pairwise_exchange.hpp"
#include "integrators/shardlow.hpp"
#include "integrators/trotter.hpp"
#include "tests/planted_schemes.hpp"
#include "tests/two_body_checks.hpp"

// Updates of a pair's relative velocity as linear maps v' = c v + s W at fixed coefficients: what
// they keep, how they relax, and what becomes of that in a bath of internal energy.
namespace driftless::two_body {
namespace {

/// c and s of an update without much change of the internal energies.
struct Map {
  double decay, spread;
};

template <class Update>
Map map_of(const Fluid& fluid, Update&& update) {
  // So much internal energy that its change is rounding.
  const double u = 1e12;
  const auto change = [&](double v, double noise) {
    const Pair<double> pair{0.4, 0.36, 0, v, u, u, noise, 0};
    return v + update(pair).momentum / fluid.reduced_mass();
  };
  return {change(1, 0), change(0, 1)};
}

/// A fluid whose particles have the temperature 1.3 at an internal energy of 10^12.
Fluid bath(FrictionClosure closure) {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.mass = 2.4;
  f.temperature = 1.3;
  f.heat_capacity = 1e12 / 1.3;
  f.friction = 3;
  f.friction_closure = closure;
  return Fluid(f);
}

constexpr double relaxation = 3 * 0.36 / 1.2;  // zeta w/mu
constexpr double variance = 0.5 * 1.3 / 1.2;   // k T/mu

template <class Update>
void expect_maxwell_kept(const Fluid& fluid, Update&& update, double decay) {
  const Map map = map_of(fluid, update);
  EXPECT_NEAR(map.decay, decay, 1e-12);
  EXPECT_NEAR(map.decay * map.decay * variance + map.spread * map.spread, variance, 1e-12);
}

TEST(PairUpdates, KeepMaxwellsLawInABathAtAnyStep) {
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    const Fluid fluid = bath(closure);
    for (const double dt : {1e-9, 1e-3, 0.1, 2.0}) {
      const double x = relaxation * dt;
      const auto peters = [&](bool exponential) {
        return [&fluid, dt, exponential](const auto& pair) {
          return peters_friction(fluid, pair, dt, exponential);
        };
      };
      expect_maxwell_kept(fluid, peters(false), 1 - x);
      expect_maxwell_kept(fluid, peters(true), std::exp(-x));
      const auto shardlow = [&](bool exponential) {
        return [&fluid, dt, exponential](const auto& pair) {
          return shardlow_friction(fluid, pair, dt, {.exponential = exponential});
        };
      };
      expect_maxwell_kept(fluid, shardlow(false), (1 - x / 2) / (1 + x / 2));
      expect_maxwell_kept(fluid, shardlow(true), std::exp(-x));
      expect_maxwell_kept(
          fluid, [&](const auto& pair) { return trotter_friction(fluid, pair, dt); }, std::exp(-x));
    }
  }
}

// Euler's is not one of them.
TEST(PairUpdates, OfEulerDoNot) {
  const Fluid fluid = bath(FrictionClosure::friction);
  const Map map = map_of(fluid, [&](const auto& pair) { return euler_friction(fluid, pair, 0.1); });
  EXPECT_GT(std::abs(map.decay * map.decay * variance + map.spread * map.spread - variance), 1e-3);
}

TEST(PairUpdates, OfPetersEndTheStepBeyondTwoRelaxationTimes) {
  const Fluid fluid = bath(FrictionClosure::friction);
  const Pair<double> pair{0.4, 0.36, 0, 1, 1e12, 1e12, 1, 0};
  EXPECT_TRUE(std::isfinite(peters_friction(fluid, pair, 1.99 / relaxation, false).momentum));
  EXPECT_FALSE(std::isfinite(peters_friction(fluid, pair, 2.01 / relaxation, false).momentum));
}

TEST(MeanDecay, IsRightToRoundingForEveryArgument) {
  for (double x = 1e-12; x < 1e3; x *= 1.37) {
    EXPECT_NEAR(mean_decay(x) * x / -std::expm1(-x), 1, 1e-13) << x;
  }
  EXPECT_EQ(mean_decay(0.0), 1);
}

// Under a constant force: the exact solution, and the dissipated power is what heats.
TEST(TrotterFriction, SolvesTheMotionUnderAConstantForce) {
  auto f = bath(FrictionClosure::friction).parameters();
  f.boltzmann = 0;
  f.repulsion = 7;
  const Fluid fluid(f);
  const double mu = fluid.reduced_mass(), force = 7 * 0.6, zeta = relaxation * mu, dt = 0.6;
  const Pair<double> pair{0.4, 0.36, 0, 1.1, 1e12, 1e12, 0, 0};
  const auto transfer = trotter_friction(fluid, pair, dt);
  const double end = force / zeta + (1.1 - force / zeta) * std::exp(-relaxation * dt);
  EXPECT_NEAR(pair.v + transfer.momentum / mu, end, 1e-13);
  const double kinetic = 0.5 * mu * (end * end - 1.1 * 1.1),
               conservative = force * dt * (1.1 + end) / 2;
  EXPECT_NEAR(transfer.energy_i + transfer.energy_j, conservative - kinetic, 1e-12);
  EXPECT_EQ(transfer.energy_i, transfer.energy_j);
}

// Of many pairs a share of 1 - e^{-rate zeta dt/mu} jumps, bounds at 6.1 standard errors.
TEST(LoweAndersen, JumpsAtTheRateOfTheFriction) {
  const Fluid fluid = bath(FrictionClosure::friction);
  const Noise noise(3, 0);
  constexpr std::uint32_t pairs = 100000;
  for (const double rate : {0.5, 1.0, 3.0}) {
    for (const double dt : {0.01, 1.0}) {
      double jumps = 0;
      for (std::uint32_t n = 0; n < pairs; ++n) {
        const double normal = noise.pair_normals(2 * n, 2 * n + 1, 0, true, false).friction;
        const double uniform = noise.pair_uniforms(2 * n, 2 * n + 1, 0).friction;
        const Pair<double> pair{0.4, 0.36, 0, 1, 1e12, 1e12, normal, 0, uniform, 1};
        const auto transfer = lowe_andersen_friction(fluid, pair, dt, rate, Resampling::exact);
        jumps += transfer.momentum != 0 ? 1 : 0;
      }
      const double expected = -std::expm1(-rate * relaxation * dt);
      EXPECT_NEAR(jumps / pairs, expected, z_bound * std::sqrt(expected / pairs));
    }
  }
}

}  // namespace
}  // namespace driftless::two_body
