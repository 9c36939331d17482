#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "tests/planted_schemes.hpp"
#include "tests/two_body_checks.hpp"

// Tests of the tests: the misprints of the sources and the mistakes that are easily made, each put
// into a small explicit scheme and each caught by the checks that judge the methods; the scheme
// without a fault passes all of them.
namespace driftless::two_body {
namespace {

Bench nearly_isothermal() {
  return make_bench(50, FrictionClosure::noise, HeatForm::inverse_temperature);
}
Bench small_capacity(FrictionClosure closure, HeatForm form) {
  return make_bench(3, closure, form, 0.5);
}

Schedule schedule(const Bench& bench) {
  const bool isothermal = bench.law().shape > 10;
  Schedule run;
  run.dt = isothermal ? 0.2 : 0.04;
  run.measure = 32;
  run.ensembles = isothermal ? 40 : 20;
  run.pairs.seed = 2024;
  return run;
}

Ladder climbed(const Bench& bench, const Factory& make) {
  return climb(bench, make, schedule(bench));
}

/// Everything that the methods are held to, for an explicit scheme of first order.
Verdict all_checks(const Ladder& ladder, int order = 1, EnergyClaim energy = EnergyClaim::drifts) {
  for (const Verdict& verdict : {limit_is_exact(ladder, order), shrinks_at_order(ladder, order),
                                 momentum_is_kept(ladder), energy_as_claimed(ladder, energy),
                                 few_failures(ladder, 0.06), sharp(ladder, order, 0.01)}) {
    if (!verdict) return verdict;
  }
  return {};
}

void expect_sound(const Bench& bench, const Factory& make) {
  const Verdict verdict = all_checks(climbed(bench, make));
  EXPECT_TRUE(verdict) << verdict.complaint;
}
void expect_wrong_law(const Bench& bench, const Factory& make) {
  EXPECT_FALSE(limit_is_exact(climbed(bench, make), 1));
}

TEST(PlantedFaults, WithoutAFaultEveryCheckHolds) {
  const auto sound = scheme([](const Fluid& fluid, const Pair<double>& pair, double dt) {
    return euler_exchange(fluid, pair, dt);
  });
  expect_sound(nearly_isothermal(), sound);
  expect_sound(nearly_isothermal(), scheme(with_friction([](auto&) {})));
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    expect_sound(small_capacity(closure, HeatForm::inverse_temperature), sound);
  }
  expect_sound(small_capacity(FrictionClosure::friction, HeatForm::temperature), sound);
}

TEST(PlantedFaults, FluctuationDissipationOffByATwentieth) {
  expect_wrong_law(nearly_isothermal(),
                   scheme(with_friction([](auto& law) { law.noise_squared *= 1.05; })));
}

TEST(PlantedFaults, FluctuationDissipationOffByTwo) {
  expect_wrong_law(nearly_isothermal(),
                   scheme(with_friction([](auto& law) { law.noise_squared *= 2; })));
}

// Marsh, Coveney 1998, eq. 13 as printed, A_D^2 = A_R where A_R^2 = A_D is meant: the amplitude of
// the noise becomes the square of what should be its square.
TEST(PlantedFaults, AmplitudeOfTheNoiseSquaredTheWrongWay) {
  expect_wrong_law(
      nearly_isothermal(),
      scheme(with_friction([](auto& law) { law.noise_squared = std::pow(law.noise_squared, 4); })));
}

// Mackie et al. 1999, eqs. 2.13 and 2.14 as printed: 1/Theta = 1/theta_i + 1/theta_j, without 1/2.
TEST(PlantedFaults, PairTemperatureWithoutTheHalf) {
  expect_wrong_law(nearly_isothermal(),
                   scheme(with_friction([](auto& law) { law.noise_squared /= 2; })));
}

TEST(PlantedFaults, MissingNoiseInducedFriction) {
  const auto bench = small_capacity(FrictionClosure::friction, HeatForm::inverse_temperature);
  expect_wrong_law(bench, scheme(with_friction([](auto& law) { law.induced = 0; })));
  for (const auto* name : {"shardlow-s1", "shardlow-s2", "shardlow-aboba"}) {
    expect_wrong_law(bench, registered(name, {{"as_published", true}}));
  }
}

TEST(PlantedFaults, MissingNoiseInducedHeat) {
  expect_wrong_law(small_capacity(FrictionClosure::noise, HeatForm::temperature),
                   scheme(with_heat([](const auto& law, const auto& pair, double dt) {
                     const double q =
                         law.rate * dt + std::sqrt(law.noise_squared * dt) * pair.heat_noise;
                     return Transfer<double>{0, q, -q};
                   })));
}

// Mackie et al. 1999, eq. 2.32 as printed: Lambda W_q without its sign, the same for i and j.
TEST(PlantedFaults, HeatNoiseOfOneSign) {
  const auto ladder = climbed(
      nearly_isothermal(), scheme(with_heat([](const auto& law, const auto& pair, double dt) {
        const double q = (law.rate + law.induced) * dt;
        const double noise = std::sqrt(law.noise_squared * dt) * pair.heat_noise;
        return Transfer<double>{0, noise + q, noise - q};
      })));
  EXPECT_FALSE(limit_is_exact(ladder, 1));
  EXPECT_FALSE(energy_drifts(ladder));  // the walk of the energy does not shrink with the step
}

TEST(PlantedFaults, HeatNoiseNotAntisymmetric) {
  const auto ladder =
      climbed(nearly_isothermal(), [] { return std::make_unique<IndependentHeatNoises>(); });
  EXPECT_FALSE(limit_is_exact(ladder, 1));
  EXPECT_FALSE(energy_drifts(ladder));
}

/// The energy is lost at the rate Gamma^2/m of a pair, here kT in a unit of time, at every step.
void expect_energy_lost(const PairExchange& exchange) {
  const Bench bench = nearly_isothermal();
  Schedule run = schedule(bench);
  run.settle = 1;
  run.measure = 2;  // the energy sinks by no more than a few hundredths
  const Ladder ladder = climb(bench, scheme(exchange), run);
  EXPECT_FALSE(energy_rate_vanishes(ladder));
  for (const auto& rung : ladder.rungs) {
    EXPECT_NEAR(rung.energy_rate.mean, -1, 0.25 + z_bound * rung.energy_rate.error);
  }
  std::array<Measured, 3> rates;
  for (int n = 0; n < 3; ++n) rates[n] = ladder.rungs[n].energy_rate;
  const Measured limit = extrapolated(rates, 1);
  EXPECT_NEAR(limit.mean, -1, 0.05 + z_bound * limit.error);
}

void expect_energy_kept_in_the_limit(const PairExchange& exchange) {
  const Bench bench = nearly_isothermal();
  const Verdict verdict = all_checks(climbed(bench, scheme(exchange)));
  EXPECT_TRUE(verdict) << verdict.complaint;
}

// Mackie et al. 1999, eqs. 2.25 and 2.27: the random force's work at the midpoint velocity is
// right; as printed it is that of the new velocities alone.
TEST(PlantedFaults, RandomWorkOfTheNewVelocities) {
  expect_energy_kept_in_the_limit(
      with_work([](const Fluid& fluid, double v, double drag, double kick) {
        const double new_v = v + (kick - drag) / fluid.reduced_mass();
        return 0.5 * (v * drag - 0.5 * (v + new_v) * kick);
      }));
  expect_energy_lost(with_work([](const Fluid& fluid, double v, double drag, double kick) {
    const double new_v = v + (kick - drag) / fluid.reduced_mass();
    return 0.5 * (v * drag - new_v * kick);
  }));
}

// Mackie et al. 1999, eq. 2.32: -Gamma^2 W^2 dt/2m is right, printed is twice as much.
TEST(PlantedFaults, SecondOrderTermOfTheWorkTwice) {
  const auto with_coefficient = [](double coefficient) {
    return with_work([coefficient](const Fluid& fluid, double v, double drag, double kick) {
      return 0.5 * v * (drag - kick) - coefficient * kick * kick / fluid.mass();
    });
  };
  expect_energy_kept_in_the_limit(with_coefficient(0.5));
  expect_energy_lost(with_coefficient(1));
}

// A start in the exact law hides what never moves: without conduction u_i - u_j keeps its law.
TEST(PlantedFaults, ConductionLeftOutIsSeenFromFarAway) {
  const Bench bench = nearly_isothermal();
  const auto no_heat = scheme([](const Fluid& fluid, const Pair<double>& pair, double dt) {
    return euler_friction(fluid, pair, dt);
  });
  Schedule run = schedule(bench);
  run.measure = 8;
  const Outcome near = measure(bench, no_heat, run);
  run.settle = 14;
  run.pairs.start = Start::far;
  run.pairs.seed += 1;
  EXPECT_FALSE(same_law(near, measure(bench, no_heat, run)));
}

/// A sound method whose particles are pushed a little, all in one direction.
class Pushed : public Integrator {
 public:
  void step(System& system, double dt) override {
    sound_->step(system, dt);
    system.update([](std::size_t, Vector& velocity, double&) { velocity.x() += 1e-10; });
  }

 private:
  std::unique_ptr<Integrator> sound_ = registered("shardlow-s1")();
};

TEST(PlantedFaults, MomentumThatLeaks) {
  Schedule run = schedule(nearly_isothermal());
  run.ensembles = 2;
  EXPECT_FALSE(momentum_is_kept(climb(
      nearly_isothermal(), [] { return std::make_unique<Pushed>(); }, run)));
  EXPECT_TRUE(momentum_is_kept(climb(nearly_isothermal(), registered("shardlow-s1"), run)));
}

TEST(PlantedFaults, ClaimsThatAreTooBold) {
  const auto ladder = climbed(nearly_isothermal(), registered("averaged-drift"));
  EXPECT_FALSE(energy_as_claimed(ladder, EnergyClaim::exact));
  EXPECT_FALSE(shrinks_at_order(ladder, 2));
  const auto exact = climbed(nearly_isothermal(), registered("shardlow-s1"));
  EXPECT_FALSE(energy_as_claimed(exact, EnergyClaim::drifts));
}

TEST(PlantedFaults, AParticlesOwnKineticEnergyIsNotGalilean) {
  const Bench bench = nearly_isothermal();
  Schedule run = schedule(bench);
  run.measure = 4;
  const auto method = registered("isoenergetic-verlet");
  const Outcome at_rest = measure(bench, method, run);
  run.pairs.frame_velocity = 1e-2 * std::sqrt(bench.thermal_energy() / bench.fluid.mass());
  EXPECT_FALSE(same_in_every_frame(at_rest, measure(bench, method, run)));
}

TEST(PlantedFaults, StepsTooLargeForTheirCopies) {
  const auto bench = small_capacity(FrictionClosure::noise, HeatForm::inverse_temperature);
  Schedule run = schedule(bench);
  run.dt *= 6;
  run.ensembles = 4;
  EXPECT_FALSE(few_failures(climb(bench, registered("shardlow-s1"), run), 0.06));
}

TEST(PlantedFaults, TooFewCopiesAreNotSharp) {
  const auto bench = nearly_isothermal();
  Schedule run = schedule(bench);
  run.ensembles = 1;
  EXPECT_FALSE(sharp(climb(bench, registered("shardlow-s1"), run), 1, 0.01));
}

double integral(const std::function<double(double)>& f, double from, double to) {
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, from, to, 15, 1e-12);
}

// Mackie et al. 1999, eq. 3.36: P(u) of a canonical particle, u in units of phi T_R, B = k/phi. The
// normalisation is (B T)^((B+1)/B) Gamma((B+1)/B); the printed exponents are the inverses.
TEST(Errata, NormalisationOfTheInternalEnergyLaw) {
  for (const double b : {0.02, 1.0 / 3}) {
    const double temperature = 1.1, x = (b + 1) / b;
    const auto log_norm = [&](double power) {
      return power * std::log(b * temperature) + std::lgamma(power);
    };
    const auto density = [&](double u, double log_normalisation) {
      return u <= 0 ? 0 : std::exp(std::log(u) / b - u / (b * temperature) - log_normalisation);
    };
    const double top = 30 * temperature;
    const auto right = [&](double u) { return density(u, log_norm(x)); };
    EXPECT_NEAR(integral(right, 0, top), 1, 1e-9);
    EXPECT_GT(std::abs(integral([&](double u) { return density(u, log_norm(1 / x)); }, 0, top) - 1),
              0.1);
    // The laws that the methods are held to tend to this one in a large system.
    FluidParameters parameters;
    parameters.boltzmann = b;  // phi = T_R = 1
    const auto law = microcanonical_law(Fluid(parameters), Layout::fluid, 100000000);
    const double e = law.energy_at(temperature);
    const double mean = integral([&](double u) { return u * right(u); }, 0, top);
    const auto centred = [&](int n) {
      return integral([&](double u) { return std::pow(u - mean, n) * right(u); }, 0, top);
    };
    EXPECT_NEAR(law.internal_energy_mean(e) / mean, 1, 1e-6);
    EXPECT_NEAR(law.internal_energy_variance(e) / centred(2), 1, 1e-6);
    EXPECT_NEAR(law.internal_energy_skewness() / (centred(3) / std::pow(centred(2), 1.5)), 1, 1e-5);
  }
}

// Bonet Avalos, Mackie 1999, eq. 3.1: the exponent of the momenta's law is (p - m v)^2/(2 m k T),
// not (p - m v)^2/(k T).
TEST(Errata, ExponentOfTheMomentumLaw) {
  const double k = 0.5, mass = 2.4, temperature = 1.3;
  const auto kinetic_energy = [&](double scale) {
    const double norm = integral([&](double p) { return std::exp(-p * p / scale); }, -30, 30);
    return 3 / norm *
           integral([&](double p) { return p * p / (2 * mass) * std::exp(-p * p / scale); }, -30,
                    30);
  };
  FluidParameters parameters;
  parameters.boltzmann = k;
  parameters.mass = mass;
  const std::size_t particles = 100000000;
  const auto law = microcanonical_law(Fluid(parameters), Layout::fluid, particles);
  const double exact =
      law.kinetic_energy(law.energy_at(temperature)) / static_cast<double>(particles);
  EXPECT_NEAR(kinetic_energy(2 * mass * k * temperature) / exact, 1, 1e-6);
  EXPECT_GT(std::abs(kinetic_energy(k * temperature) / exact - 1), 0.1);
}

}  // namespace
}  // namespace driftless::two_body
