#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "integrators/flows.hpp"
#include "model/differentiable.hpp"
#include "tests/small_system.hpp"

// Any entropy s(u), and coefficients that follow the temperatures, in isolated ideal systems. Two
// averages are known exactly for every s(u). With d = 3(N - 1) the law of (K, u_1, ..., u_N) at a
// fixed sum is K^(d/2 - 1) exp(sum s(u_i)/k); integration by parts along d/du_i - d/dK, and along
// sum (u_i - <u>) d/du_i, <u> being the mean over the particles, gives
//   <1/theta_i> = k (d/2 - 1) <1/K>
//   <sum (u_i - <u>)/(k theta_i)> = -(N - 1).
// The first says that T_kin and T_int agree, N finite or not, the second that the energies are
// spread as they should be. They hold at any sum: a method's slow drift of energy does not matter.

namespace driftless::testing {
namespace {

constexpr std::size_t particles = 30;

/// With k = 1 and heat capacities of about 12, what is noise-induced is large.
FluidParameters fluid_of(FrictionClosure closure, HeatForm heat) {
  FluidParameters f;
  f.mass = 1.25;
  f.temperature = 1.1;
  f.heat_capacity = 12;
  f.friction = 3;
  f.friction_closure = closure;
  f.conduction = 3;
  f.heat_form = heat;
  return f;
}

FluidParameters with_slope(FluidParameters f) {
  f.heat_capacity_slope = 4;
  return f;
}

/// A heat capacity that has a maximum, as near a transition.
FluidParameters with_table(FluidParameters f) {
  f.equation_of_state = {{0.4, 4}, {0.8, 8}, {1.0, 11}, {1.2, 15}, {1.6, 20}, {2.4, 29}};
  return f;
}

FluidParameters with_exponents(FluidParameters f) {
  f.friction_temperature_exponent = 1.5;
  f.conduction_temperature_exponent = 1;
  return f;
}

struct Case {
  std::string name;
  FluidParameters fluid;
};

std::vector<Case> cases() {
  using enum FrictionClosure;
  const auto inverse = HeatForm::inverse_temperature, direct = HeatForm::temperature;
  return {
      {"slope", with_slope(fluid_of(noise, direct))},
      {"table", with_table(fluid_of(FrictionClosure::friction, inverse))},
      {"table and exponents", with_exponents(with_table(fluid_of(noise, direct)))},
      {"exponents, noise, inverse", with_exponents(fluid_of(noise, inverse))},
      {"exponents, friction, inverse",
       with_exponents(fluid_of(FrictionClosure::friction, inverse))},
      {"exponents, friction, direct", with_exponents(fluid_of(FrictionClosure::friction, direct))}};
}

System start(const FluidParameters& parameters, std::uint64_t seed) {
  const Fluid fluid(parameters);
  Uniform uniform(seed);
  const Box box{Vector::Constant(2.6)};
  State state;
  const double spread =
      std::sqrt(3 * fluid.boltzmann() * fluid.parameters().temperature / fluid.mass());
  Vector mean = Vector::Zero();
  for (std::uint32_t i = 0; i < particles; ++i) {
    state.position.push_back(uniform.vector(0, 2.6));
    state.velocity.push_back(spread * uniform.vector(-1, 1));
    state.internal_energy.push_back(fluid.internal_energy(fluid.parameters().temperature));
    state.id.push_back(i);
    mean += state.velocity.back() / particles;
  }
  for (auto& velocity : state.velocity) velocity -= mean;
  return System(fluid, box, state, Noise(seed, 0));
}

/// Both averages as ratios to their exact values, less 1.
struct Balance {
  double kinetic, spread;
};

Balance balance_of(const System& system) {
  const auto& energies = system.state().internal_energy;
  const double n = particles, k = system.fluid().boltzmann();
  const double mean = system.internal_energy() / n;
  double inverse = 0, spread = 0;
  for (std::size_t i = 0; i < particles; ++i) {
    const double by_theta = 1 / system.equation_of_state(i).temperature(energies[i]);
    inverse += by_theta / n;
    spread -= (energies[i] - mean) * by_theta / (k * (n - 1));
  }
  // k (d/2 - 1)/K less 1/theta, in units of 1/T.
  const double of_kinetic = k * (1.5 * (n - 1) - 1) / system.kinetic_energy();
  return {system.fluid().parameters().temperature * (of_kinetic - inverse), spread - 1};
}

struct ZScores {
  double kinetic, spread;
  double largest() const { return std::max(std::abs(kinetic), std::abs(spread)); }
};

double z_score(const std::vector<double>& blocks) {
  const double n = static_cast<double>(blocks.size());
  const double mean = std::accumulate(blocks.begin(), blocks.end(), 0.0) / n;
  double squares = 0;
  for (const double x : blocks) squares += (x - mean) * (x - mean);
  return mean / std::sqrt(squares / (n * (n - 1)));
}

/// Means over 50 blocks of time, each of many correlation times (about one unit).
ZScores run(Integrator& integrator, const FluidParameters& parameters, double step_size,
            double duration, std::uint64_t seed) {
  constexpr int blocks = 50, every = 8;
  System system = start(parameters, seed);
  const auto steps = [&](double time) { return static_cast<std::uint64_t>(time / step_size); };
  std::uint64_t next = 1 + steps(40);
  judge::run(integrator, system, step_size, 1, next);
  std::vector<double> kinetic, spread;
  const auto samples = steps(duration) / blocks / every;
  for (int block = 0; block < blocks; ++block) {
    Balance sum{0, 0};
    for (std::uint64_t n = 0; n < samples; ++n, next += every) {
      judge::run(integrator, system, step_size, next, next + every);
      const auto now = balance_of(system);
      sum.kinetic += now.kinetic;
      sum.spread += now.spread;
    }
    kinetic.push_back(sum.kinetic / static_cast<double>(samples));
    spread.push_back(sum.spread / static_cast<double>(samples));
  }
  return {z_score(kinetic), z_score(spread)};
}

ZScores run(std::string_view method, const FluidParameters& parameters, double step_size,
            double duration, std::uint64_t seed) {
  const auto integrator = find_method(method)->make({});
  return run(*integrator, parameters, step_size, duration, seed);
}

/// Student's t of 49 degrees of freedom is beyond 7 in fewer than 1e-8 of the cases; the bias of
/// the first-order methods at the steps below is not above one standard error.
constexpr double limit = 8;

class Thermodynamics : public ::testing::TestWithParam<Case> {};

TEST_P(Thermodynamics, IsThatOfTheEntropyUnderASplittingThatIsExactForPairs) {
  const auto z = run("metropolized-splitting", GetParam().fluid, 0.05, 500, 1);
  EXPECT_LT(std::abs(z.kinetic), limit);
  EXPECT_LT(std::abs(z.spread), limit);
}

TEST_P(Thermodynamics, IsThatOfTheEntropyUnderShardlowsSplitting) {
  const auto z = run("shardlow-s1", GetParam().fluid, 0.005, 200, 2);
  EXPECT_LT(std::abs(z.kinetic), limit);
  EXPECT_LT(std::abs(z.spread), limit);
}

TEST_P(Thermodynamics, IsThatOfTheEntropyUnderTheExplicitMethod) {
  const auto z = run("averaged-drift", GetParam().fluid, 0.005, 200, 3);
  EXPECT_LT(std::abs(z.kinetic), limit);
  EXPECT_LT(std::abs(z.spread), limit);
}

INSTANTIATE_TEST_SUITE_P(Any, Thermodynamics, ::testing::ValuesIn(cases()), [](const auto& chosen) {
  std::string name = chosen.param.name;
  std::erase_if(name, [](char c) { return c == ' ' || c == ','; });
  return name;
});

/// Euler-Maruyama, if wanted without the noise-induced heat.
class ExplicitScheme : public Integrator {
 public:
  explicit ExplicitScheme(bool with_induced_heat) : with_induced_heat_(with_induced_heat) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.accumulate(
        [&](const Pair<double>& pair) {
          const double left_out = with_induced_heat_ ? 0 : fluid.conduction(pair).induced * dt;
          return euler_exchange(fluid, pair, dt) += Transfer<double>{0, -left_out, left_out};
        },
        exchange_);
    system.move(dt);
    system.apply(exchange_);
  }

 private:
  bool with_induced_heat_;
  Exchange exchange_;
};

TEST(ThermodynamicsOfAFault, FindsTheNoiseInducedFrictionLeftOut) {
  auto parameters = fluid_of(FrictionClosure::noise, HeatForm::inverse_temperature);
  parameters.friction_temperature_exponent = 3;
  const auto sound = find_method("shardlow-s1")->make({});
  const auto published = find_method("shardlow-s1")->make({{"as_published", true}});
  EXPECT_LT(run(*sound, parameters, 0.01, 600, 4).largest(), limit);
  EXPECT_GT(std::abs(run(*published, parameters, 0.01, 600, 5).kinetic), limit);
}

TEST(ThermodynamicsOfAFault, FindsTheNoiseInducedHeatLeftOut) {
  auto parameters = fluid_of(FrictionClosure::noise, HeatForm::temperature);
  parameters.conduction = 6;
  parameters.conduction_temperature_exponent = 2;
  ExplicitScheme sound(true), faulty(false);
  EXPECT_LT(run(sound, parameters, 0.005, 800, 6).largest(), limit);
  EXPECT_GT(std::abs(run(faulty, parameters, 0.005, 800, 7).spread), limit);
}

TEST(ThermodynamicsOfAFault, FindsATemperatureOfAnotherHeatCapacity) {
  // Samples judged by the constant heat capacity that the particles do not have.
  auto parameters = with_slope(fluid_of(FrictionClosure::noise, HeatForm::temperature));
  const auto integrator = find_method("metropolized-splitting")->make({});
  System system = start(parameters, 9);
  judge::run(*integrator, system, 0.05, 1, 800);
  const auto seen_as = [&](const FluidParameters& f) {
    return System(Fluid(f), system.box(), system.state(), Noise(1, 0));
  };
  const double right = balance_of(seen_as(parameters)).kinetic;
  parameters.heat_capacity_slope = 0;
  EXPECT_GT(std::abs(balance_of(seen_as(parameters)).kinetic - right), 0.01);
}

TEST_P(Thermodynamics, KeepsEnergyToRoundingWhereTheMethodDoes) {
  int ran = 0;
  for (const Method* method : methods()) {
    const Fluid fluid(GetParam().fluid);
    if (method->energy_ideal != EnergyClaim::exact || refusal(*method, fluid)) continue;
    System system = start(GetParam().fluid, 10);
    const double energy = system.total_energy();
    const auto integrator = method->make({});
    judge::run(*integrator, system, 0.01, 1, 200);
    EXPECT_NEAR(system.total_energy(), energy, 1e-12 * energy) << method->name;
    EXPECT_LT(system.momentum().norm(), 1e-11) << method->name;
    ++ran;
  }
  EXPECT_GE(ran, 8);
}

/// Central differences of steps h err by about h^2 = 1e-8.
template <class Function>
double derivative(Function&& f, double x) {
  const double h = 1e-4 * x;
  return (f(x + h) - f(x - h)) / (2 * h);
}

Pair<double> some_pair(const Fluid& fluid, Uniform& uniform) {
  Pair<double> pair{};
  pair.r = uniform(0.05, 0.85);
  pair.w_friction = fluid.friction_weight(pair.r);
  pair.w_heat = fluid.heat_weight(pair.r);
  pair.v = uniform(-2, 2);
  pair.u_i = uniform(4, 28);
  pair.u_j = uniform(4, 28);
  return pair;
}

TEST_P(Thermodynamics, HasLawsWhoseInducedTermsAreDerivativesOfTheirNoise) {
  const Fluid fluid(GetParam().fluid);
  Uniform uniform(11);
  for (int n = 0; n < 50; ++n) {
    const auto pair = some_pair(fluid, uniform);
    const auto slopes_of = [&](auto&& quantity) {
      const auto at = [&](double u_i, double u_j) {
        Pair<double> changed = pair;
        changed.u_i = u_i;
        changed.u_j = u_j;
        return quantity(changed);
      };
      return AmplitudeSlopes<double>{
          derivative([&](double u) { return at(u, pair.u_j); }, pair.u_i),
          derivative([&](double u) { return at(pair.u_i, u); }, pair.u_j)};
    };
    const auto gamma = slopes_of([&](const auto& at) { return fluid.friction(at).noise_squared; });
    const auto lambda =
        slopes_of([&](const auto& at) { return fluid.conduction(at).noise_squared; });
    const auto friction = fluid.friction(pair);
    const auto heat = fluid.conduction(pair);
    // Kinks of a table's heat capacity cost the differences some accuracy.
    const double relative = 1e-4;
    const auto near = [&](double a, double b, double scale) {
      EXPECT_NEAR(a, b, relative * (std::abs(a) + scale));
    };
    near(friction.induced, (gamma.by_u_i + gamma.by_u_j) / 4, friction.noise_squared);
    near(heat.induced, (lambda.by_u_i - lambda.by_u_j) / 2, heat.noise_squared);
    near(2 * fluid.friction_noise_slopes(pair).by_u_i * friction.noise_squared, gamma.by_u_i,
         friction.noise_squared);
    near(2 * fluid.heat_noise_slopes(pair).by_u_j * heat.noise_squared, lambda.by_u_j,
         heat.noise_squared);
    const double theta_i = fluid.temperature(pair.u_i), theta_j = fluid.temperature(pair.u_j);
    EXPECT_NEAR(heat.rate, fluid.conductivity(pair) * (theta_j - theta_i),
                1e-12 * std::abs(heat.rate));
    EXPECT_NEAR(heat.noise_squared,
                2 * fluid.boltzmann() * fluid.conductivity(pair) * theta_i * theta_j,
                1e-12 * heat.noise_squared);
    EXPECT_NEAR(friction.noise_squared,
                2 * fluid.boltzmann() * friction.friction * fluid.mean_temperature(pair),
                1e-12 * friction.noise_squared);
  }
}

TEST(CoefficientsOfAFluid, AreThoseOfTheClosuresWhereTheFactorIsOne) {
  const CoefficientLaw one = CoefficientLaw::any(
      [](double, const Differentiable&, const Differentiable&) { return Differentiable(1.0); }, 1.1,
      1);
  Uniform uniform(12);
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const auto heat : {HeatForm::inverse_temperature, HeatForm::temperature}) {
      auto parameters = with_slope(fluid_of(closure, heat));
      const Fluid plain(parameters);
      parameters.friction_law = parameters.conduction_law = one;
      const Fluid factored(parameters);
      for (int n = 0; n < 20; ++n) {
        const auto pair = some_pair(plain, uniform);
        const auto a = plain.friction(pair), b = factored.friction(pair);
        EXPECT_NEAR(a.friction, b.friction, 1e-14 * a.friction);
        EXPECT_NEAR(a.noise_squared, b.noise_squared, 1e-14 * a.noise_squared);
        EXPECT_NEAR(a.induced, b.induced, 1e-14 * a.noise_squared);
        const auto c = plain.conduction(pair), d = factored.conduction(pair);
        EXPECT_NEAR(c.rate, d.rate, 1e-13 * c.noise_squared);
        EXPECT_NEAR(c.noise_squared, d.noise_squared, 1e-14 * c.noise_squared);
        EXPECT_NEAR(c.induced, d.induced, 1e-13 * c.noise_squared);
      }
    }
  }
}

TEST(CoefficientsOfAFluid, ArePowersOfTheMeanTemperatureQuotedAtTheFluids) {
  const auto parameters =
      with_exponents(fluid_of(FrictionClosure::friction, HeatForm::temperature));
  const Fluid fluid(parameters);
  Uniform uniform(13);
  auto pair = some_pair(fluid, uniform);
  pair.u_i = pair.u_j = fluid.internal_energy(1.1);
  EXPECT_NEAR(fluid.friction(pair).friction, 3 * pair.w_friction, 1e-14);
  EXPECT_NEAR(fluid.conductivity(pair), 3 * pair.w_heat, 1e-14);
  pair.u_i = fluid.internal_energy(4.4);
  EXPECT_NEAR(fluid.friction(pair).friction, 3 * pair.w_friction * std::pow(2, 1.5), 1e-13);
  EXPECT_NEAR(fluid.conductivity(pair), 3 * pair.w_heat * 2, 1e-13);
}

TEST(CoefficientsOfAFluid, ThatFollowTemperaturesAreOnlyForMethodsBuiltForIt) {
  auto parameters = fluid_of(FrictionClosure::noise, HeatForm::inverse_temperature);
  const auto refusing = [&] {
    std::vector<std::string_view> names;
    for (const Method* method : methods()) {
      if (refusal(*method, Fluid(parameters))) names.push_back(method->name);
    }
    return names;
  };
  const Method& shardlow = *find_method("shardlow-s1");
  const Options published = {{"as_published", true}};
  EXPECT_TRUE(refusing().empty());
  EXPECT_TRUE(is_consistent(shardlow, published, Fluid(parameters)));
  EXPECT_FALSE(Fluid(parameters).noise_follows_energies());
  parameters.conduction_temperature_exponent = 2;
  EXPECT_TRUE(refusing().empty());
  EXPECT_TRUE(Fluid(parameters).noise_follows_energies());
  EXPECT_FALSE(Fluid(parameters).friction_noise_follows_energies());
  parameters.friction_temperature_exponent = 1;
  const auto names = refusing();
  parameters.friction_temperature_exponent = 0;
  parameters.friction_closure = FrictionClosure::friction;
  EXPECT_EQ(names, refusing());
  EXPECT_GE(names.size(), 3U);
  parameters.friction_closure = FrictionClosure::noise;
  parameters.friction_temperature_exponent = 1;
  EXPECT_FALSE(is_consistent(shardlow, published, Fluid(parameters)));
  EXPECT_TRUE(is_consistent(shardlow, {}, Fluid(parameters)));
  parameters.boltzmann = 0;
  EXPECT_TRUE(refusing().empty());
}

/// An implicit method has to iterate where its end-point amplitudes follow the energies.
TEST(CoefficientsOfAFluid, MakeEndPointAmplitudesAMatterOfIteration) {
  const auto rounds = [](const FluidParameters& parameters) {
    System system = start(parameters, 14);
    const auto integrator = find_method("avalos-mackie-midpoint")->make({});
    judge::run(*integrator, system, 0.01, 1, 11);
    return system.counters().solver_iterations;
  };
  auto parameters = fluid_of(FrictionClosure::noise, HeatForm::inverse_temperature);
  EXPECT_EQ(rounds(parameters), 10U);
  parameters.friction_temperature_exponent = 1.5;
  EXPECT_GT(rounds(parameters), 20U);
}

std::string complaint_about(const FluidParameters& parameters) {
  try {
    const Fluid fluid(parameters);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(CoefficientsOfAFluid, AndItsEquationOfStateAreRefusedByNameWhereTheyMakeNoSense) {
  auto bent = fluid_of(FrictionClosure::noise, HeatForm::none);
  bent.equation_of_state = {{1, 10}, {2, 9}};
  EXPECT_NE(complaint_about(bent).find("point 2 of the equation of state"), std::string::npos);
  bent.equation_of_state = {{1, 10}, {2, 19}};
  EXPECT_EQ(complaint_about(bent), "");
  bent.heat_capacity_slope = 1;
  EXPECT_EQ(complaint_about(bent),
            "heat_capacity_slope is 1, allowed is 0 where an equation of state is given by points");
  auto steep = fluid_of(FrictionClosure::noise, HeatForm::none);
  steep.heat_capacity_slope = 12;
  EXPECT_EQ(complaint_about(steep).find("heat_capacity_slope is 12"), 0U);
  auto twice = fluid_of(FrictionClosure::noise, HeatForm::none);
  twice.friction_temperature_exponent = 1;
  twice.friction_law = CoefficientLaw::power(1, 1);
  EXPECT_EQ(complaint_about(twice),
            "friction_temperature_exponent is 1, allowed is 0 where a law is given");
  auto bath = fluid_of(FrictionClosure::noise, HeatForm::none);
  bath.conduction = 0;
  bath.isothermal = true;
  bath.friction_law = CoefficientLaw::power(1, 1);
  EXPECT_NE(complaint_about(bath).find("allowed is none in an isothermal fluid"),
            std::string::npos);
}

TEST(EquationsOfState, OfSpeciesAreTheirOwn) {
  auto parameters = with_slope(fluid_of(FrictionClosure::noise, HeatForm::temperature));
  SpeciesParameters other{2, 8, 0, {{1, 10}, {2, 30}}};
  parameters.further_species = {other};
  const Fluid fluid(parameters);
  EXPECT_FALSE(fluid.has_constant_heat_capacities());
  EXPECT_DOUBLE_EQ(fluid.equation_of_state(1).temperature(30.0), 2);
  EXPECT_DOUBLE_EQ(fluid.internal_energy(1.1), 1.1 * (12 - 0.5 * 4 * 1.1));
}

}  // namespace
}  // namespace driftless::testing
