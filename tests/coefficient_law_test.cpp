#include "model/coefficient_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/differentiable.hpp"
#include "model/equation_of_state.hpp"
#include "model/exchange_laws.hpp"
#include "model/fluid.hpp"
#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

constexpr double reference = 1.1, range = 0.95;

/// Depends on the distance and on both temperatures, not through one mean alone.
Differentiable bent(double distance, const Differentiable& theta_i, const Differentiable& theta_j) {
  const Differentiable sum = theta_i + theta_j;
  const Differentiable difference = theta_i - theta_j;
  return exp(-distance * sum) + 0.3 * difference * difference / sum + 1 / (theta_i * theta_j);
}

struct NamedLaw {
  const char* name;
  CoefficientLaw law;
};
std::vector<NamedLaw> all_laws() {
  return {{"constant", CoefficientLaw()},
          {"power 3", CoefficientLaw::power(3, reference)},
          {"power -0.7", CoefficientLaw::power(-0.7, reference)},
          {"any", CoefficientLaw::any(bent, reference, range)}};
}

struct NamedState {
  const char* name;
  EquationOfState state;
};
std::vector<NamedState> all_states() {
  return {{"constant", EquationOfState::constant_heat_capacity(12)},
          {"linear", EquationOfState::linear_heat_capacity(8, 5, 1.1)},
          {"table", EquationOfState::table({{0.2, 1}, {0.6, 5}, {1.1, 13}, {1.7, 20}, {3, 50}})},
          {"reservoir", EquationOfState::reservoir(1.4)}};
}

/// A pair of particles, or of a particle and a wall, each with its own equation of state.
struct Bodies {
  EquationOfState i, j;
  double k, r, u_i, u_j;

  Bodies with(double new_u_i, double new_u_j) const { return {i, j, k, r, new_u_i, new_u_j}; }
  PairTemperatures<double> temperatures() const {
    return {i.temperature(u_i), j.temperature(u_j), i.inverse_heat_capacity(u_i),
            j.inverse_heat_capacity(u_j)};
  }
  Coefficient<double> coefficient(const CoefficientLaw& law) const {
    return 3.0 * law.factor(r, i.temperature(u_i), j.temperature(u_j));
  }
};

using Intensity = Coefficient<double> (*)(const CoefficientLaw&, const Bodies&);

Coefficient<double> as_given(const CoefficientLaw& law, const Bodies& b) {
  return b.coefficient(law);
}
Coefficient<double> of_friction(const CoefficientLaw& law, const Bodies& b) {
  return friction_intensity(b.coefficient(law), b.temperatures());
}
Coefficient<double> of_heat(const CoefficientLaw& law, const Bodies& b) {
  return heat_intensity(b.coefficient(law), b.temperatures());
}

/// (d/du_i + sign d/du_j) f, by central differences, which err by about 1e-9 f/u.
template <class Function>
double along(double sign, const Bodies& b, Function&& f) {
  const double h = 1e-5 * std::min(b.u_i, b.u_j);
  return (f(b.with(b.u_i + h, b.u_j + sign * h)) - f(b.with(b.u_i - h, b.u_j - sign * h))) /
         (2 * h);
}

/// The weight exp(S/k) of equilibrium, relative to that of the pair's state.
double weight(const Bodies& from, const Bodies& to) {
  return std::exp((from.i.entropy_gain(from.u_i, to.u_i - from.u_i) +
                   from.j.entropy_gain(from.u_j, to.u_j - from.u_j)) /
                  from.k);
}

/// How far friction and its induced part are from (1/4)(d/du_i + d/du_j)[Gamma^2 exp(S/k)],
/// relative to exp(S/k): then nothing flows in equilibrium.
double friction_current(const FrictionLaw<double>& law, const Bodies& b, Intensity intensity,
                        const CoefficientLaw& coefficient) {
  const double needed =
      along(1, b,
            [&](const Bodies& at) {
              const auto there = friction_law(at.k, intensity(coefficient, at), at.temperatures());
              return there.noise_squared * weight(b, at);
            }) /
      4;
  return std::abs(law.friction + law.induced - needed) / (law.friction + std::abs(law.induced));
}

/// The same of (1/2)(d/du_i - d/du_j)[Lambda^2 exp(S/k)]; relative to both heat rates.
double heat_current(const ConductionLaw<double>& law, const Bodies& b, Intensity intensity,
                    const CoefficientLaw& coefficient) {
  const double needed = along(-1, b,
                              [&](const Bodies& at) {
                                const auto there = conduction_law(at.k, intensity(coefficient, at),
                                                                  at.temperatures());
                                return there.noise_squared * weight(b, at);
                              }) /
                        2;
  return std::abs(law.rate + law.induced - needed) / (std::abs(law.rate) + std::abs(law.induced));
}

/// Calls test(law, bodies) for every law, every two equations of state and several energies.
template <class Test>
void for_all(Test&& test) {
  Uniform uniform(7);
  for (const auto& law : all_laws()) {
    for (const auto& first : all_states()) {
      for (const auto& second : all_states()) {
        if (first.state.is_reservoir() && second.state.is_reservoir()) continue;  // no particle
        SCOPED_TRACE(std::string(law.name) + ", " + first.name + ", " + second.name);
        for (int n = 0; n < 20; ++n) {
          test(law.law, Bodies{first.state, second.state, 0.5, uniform(0.05, 0.9), uniform(4, 30),
                               uniform(4, 30)});
        }
      }
    }
  }
}

constexpr double by_differences = 1e-6;

TEST(Exchange, HasNoCurrentInEquilibriumWhateverLawAndEquationOfState) {
  for_all([](const CoefficientLaw& law, const Bodies& b) {
    for (const auto intensity : {as_given, of_friction}) {
      const auto friction = friction_law(b.k, intensity(law, b), b.temperatures());
      EXPECT_LT(friction_current(friction, b, intensity, law), by_differences);
    }
    for (const auto intensity : {as_given, of_heat}) {
      const auto heat = conduction_law(b.k, intensity(law, b), b.temperatures());
      EXPECT_LT(heat_current(heat, b, intensity, law), by_differences);
    }
  });
}

// The test of that test: derivatives of the law, or the heat capacities' change, forgotten.
TEST(Exchange, WithATermForgottenHasACurrent) {
  const auto law = CoefficientLaw::power(3, reference);
  const auto capacity = EquationOfState::linear_heat_capacity(8, 5, 1.1);
  const Bodies b{capacity, EquationOfState::constant_heat_capacity(12), 0.5, 0.3, 9, 20};
  auto zeta = b.coefficient(law);
  zeta.by_theta_i = zeta.by_theta_j = 0;
  const auto at = b.temperatures();
  EXPECT_GT(
      friction_current(friction_law(b.k, friction_intensity(zeta, at), at), b, of_friction, law),
      1e-2);
  EXPECT_GT(friction_current(friction_law(b.k, zeta, at), b, as_given, law), 1e-2);
  EXPECT_GT(heat_current(conduction_law(b.k, heat_intensity(zeta, at), at), b, of_heat, law), 1e-2);
  EXPECT_GT(heat_current(conduction_law(b.k, zeta, at), b, as_given, law), 1e-2);

  auto mean_capacity = at;
  mean_capacity.inverse_capacity_i = at.theta_i / b.u_i;
  const auto intensity = of_friction(law, b);
  EXPECT_GT(friction_current(friction_law(b.k, intensity, mean_capacity), b, of_friction, law),
            1e-4);
  EXPECT_GT(heat_current(conduction_law(b.k, of_heat(law, b), mean_capacity), b, of_heat, law),
            1e-2);
}

TEST(Exchange, InducedTermsAreTheDerivativesOfTheNoises) {
  for_all([](const CoefficientLaw& law, const Bodies& b) {
    for (const auto intensity : {as_given, of_friction, of_heat}) {
      const auto strength = [&](const Bodies& at) { return 2 * at.k * intensity(law, at).value; };
      const auto friction = friction_law(b.k, intensity(law, b), b.temperatures());
      const auto heat = conduction_law(b.k, intensity(law, b), b.temperatures());
      EXPECT_NEAR(friction.induced, along(1, b, strength) / 4, 1e-8 * friction.noise_squared);
      EXPECT_NEAR(heat.induced, along(-1, b, strength) / 2, 1e-8 * heat.noise_squared);
    }
  });
}

TEST(Exchange, InducedTermsAreTheSumAndDifferenceOfTheSlopes) {
  for_all([](const CoefficientLaw& law, const Bodies& b) {
    for (const auto intensity : {as_given, of_friction, of_heat}) {
      const auto at = b.temperatures();
      const auto slopes = amplitude_slopes(intensity(law, b), at);
      const auto friction = friction_law(b.k, intensity(law, b), at);
      const auto heat = conduction_law(b.k, intensity(law, b), at);
      const double size = std::abs(slopes.by_u_i) + std::abs(slopes.by_u_j);
      EXPECT_NEAR(friction.induced / (friction.noise_squared / 2), slopes.by_u_i + slopes.by_u_j,
                  1e-13 * size);
      EXPECT_NEAR(heat.induced / heat.noise_squared, slopes.by_u_i - slopes.by_u_j, 1e-13 * size);
      const auto logarithm = [&](const Bodies& there) {
        return 0.5 * std::log(intensity(law, there).value);
      };
      EXPECT_NEAR(along(1, b, logarithm), slopes.by_u_i + slopes.by_u_j, 1e-7);
      EXPECT_NEAR(along(-1, b, logarithm), slopes.by_u_i - slopes.by_u_j, 1e-7);
    }
  });
}

TEST(Exchange, KeepsItsCoefficientAndFluctuationDissipation) {
  for_all([](const CoefficientLaw& law, const Bodies& b) {
    const auto at = b.temperatures();
    const double coefficient = 3 * law.factor(b.r, at.theta_i, at.theta_j).value;
    const auto friction = friction_law(b.k, of_friction(law, b), at);
    EXPECT_NEAR(friction.friction / coefficient, 1, 1e-14);
    EXPECT_NEAR(friction.noise_squared / (2 * b.k * friction.friction * at.mean()), 1, 1e-14);
    const auto heat = conduction_law(b.k, of_heat(law, b), at);
    EXPECT_NEAR(heat.rate, coefficient * (at.theta_j - at.theta_i), 1e-14 * coefficient);
    EXPECT_NEAR(heat.noise_squared / (2 * b.k * coefficient * at.product()), 1, 1e-14);
  });
}

TEST(Exchange, IsAntisymmetricInThePair) {
  for_all([](const CoefficientLaw& law, const Bodies& b) {
    const Bodies swapped{b.j, b.i, b.k, b.r, b.u_j, b.u_i};
    for (const auto intensity : {as_given, of_friction, of_heat}) {
      const auto friction = friction_law(b.k, intensity(law, b), b.temperatures());
      const auto mirrored = friction_law(b.k, intensity(law, swapped), swapped.temperatures());
      EXPECT_NEAR(friction.induced, mirrored.induced, 1e-13 * friction.noise_squared);
      const auto heat = conduction_law(b.k, intensity(law, b), b.temperatures());
      const auto other = conduction_law(b.k, intensity(law, swapped), swapped.temperatures());
      EXPECT_NEAR(heat.induced, -other.induced, 1e-13 * heat.noise_squared);
      EXPECT_NEAR(heat.rate, -other.rate, 1e-13 * heat.noise_squared);
    }
  });
}

/// What Fluid says with the constant factors of its four closures.
TEST(Exchange, OfAConstantLawIsThatOfTheFluid) {
  Uniform uniform(5);
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const auto form : {HeatForm::inverse_temperature, HeatForm::temperature}) {
      for (const double k : {0.0, 0.5}) {
        const Fluid fluid(small_fluid({closure, form, true}, k));
        const auto& f = fluid.parameters();
        const auto state = EquationOfState::constant_heat_capacity(f.heat_capacity);
        for (int n = 0; n < 30; ++n) {
          Pair<double> pair{};
          pair.r = uniform(0.05, 0.85);
          pair.w_friction = fluid.friction_weight(pair.r);
          pair.w_heat = fluid.heat_weight(pair.r);
          pair.u_i = uniform(2, 40);
          pair.u_j = uniform(2, 40);
          const Bodies b{state, state, k, pair.r, pair.u_i, pair.u_j};
          const auto at = b.temperatures();
          const auto g = CoefficientLaw().factor(b.r, at.theta_i, at.theta_j);
          const bool noise = closure == FrictionClosure::noise;
          const auto friction_factor = noise ? f.temperature * g : friction_intensity(g, at);
          const auto friction = friction_law(k, f.friction * pair.w_friction * friction_factor, at);
          const auto expected = fluid.friction(pair);
          EXPECT_NEAR(friction.friction, expected.friction, 1e-14 * expected.friction);
          EXPECT_NEAR(friction.noise_squared, expected.noise_squared, 1e-14 * friction.friction);
          EXPECT_NEAR(friction.induced, expected.induced, 1e-14 * friction.friction);
          const bool inverse = form == HeatForm::inverse_temperature;
          const auto heat_factor = inverse ? g : heat_intensity(g, at);
          const auto heat = conduction_law(k, f.conduction * pair.w_heat * heat_factor, at);
          const auto expected_heat = fluid.conduction(pair);
          const double size = f.conduction * pair.w_heat * 10;
          EXPECT_NEAR(heat.rate, expected_heat.rate, 1e-14 * size);
          EXPECT_NEAR(heat.noise_squared, expected_heat.noise_squared, 1e-14 * size);
          EXPECT_NEAR(heat.induced, expected_heat.induced, 1e-14 * size);
          const auto slopes = amplitude_slopes(friction_factor, at);
          const auto heat_slopes = amplitude_slopes(heat_factor, at);
          EXPECT_NEAR(slopes.by_u_i, fluid.friction_noise_slopes(pair).by_u_i, 1e-14);
          EXPECT_NEAR(slopes.by_u_j, fluid.friction_noise_slopes(pair).by_u_j, 1e-14);
          EXPECT_NEAR(heat_slopes.by_u_i, fluid.heat_noise_slopes(pair).by_u_i, 1e-14);
          EXPECT_NEAR(heat_slopes.by_u_j, fluid.heat_noise_slopes(pair).by_u_j, 1e-14);
        }
      }
    }
  }
}

TEST(CoefficientLaw, IsThePowerOfTheGeometricMeanTemperature) {
  const auto law = CoefficientLaw::power(3, 2);
  EXPECT_FALSE(law.is_constant());
  EXPECT_NEAR(law.factor(0.4, 1.0, 9.0).value, std::pow(3 / 2.0, 3), 1e-14);
  EXPECT_NEAR(law.factor(0.4, 2.0, 2.0).value, 1, 1e-15);
  EXPECT_NEAR(law.factor(0.4, 2.0, 2.0).by_theta_i, 1.5 / 2, 1e-15);
  EXPECT_EQ(CoefficientLaw::power(0, 2), CoefficientLaw());
  EXPECT_TRUE(CoefficientLaw::power(0, 2).is_constant());
}

TEST(CoefficientLaw, OfAFunctionIsThatFunction) {
  const auto law = CoefficientLaw::any(bent, reference, range);
  const double i = 0.8, j = 1.7, r = 0.3;
  const auto g = law.factor(r, i, j);
  EXPECT_NEAR(g.value, std::exp(-r * 2.5) + 0.3 * 0.81 / 2.5 + 1 / (0.8 * 1.7), 1e-15);
  const double h = 1e-5;
  EXPECT_NEAR(g.by_theta_i,
              (law.factor(r, i + h, j).value - law.factor(r, i - h, j).value) / (2 * h), 1e-9);
  EXPECT_NEAR(g.by_theta_j,
              (law.factor(r, i, j + h).value - law.factor(r, i, j - h).value) / (2 * h), 1e-9);
  // and the power as a function is the power
  const auto written = CoefficientLaw::any(
      [](double, const Differentiable& a, const Differentiable& b) -> Differentiable {
        return pow(a * b / (reference * reference), 1.5);
      },
      reference, range);
  const auto closed = CoefficientLaw::power(3, reference).factor(r, i, j);
  EXPECT_NEAR(written.factor(r, i, j).value, closed.value, 1e-14);
  EXPECT_NEAR(written.factor(r, i, j).by_theta_i, closed.by_theta_i, 1e-14);
  EXPECT_NEAR(written.factor(r, i, j).by_theta_j, closed.by_theta_j, 1e-14);
  const auto copy = law;
  EXPECT_EQ(copy, law);
  EXPECT_NE(law, written);
}

TEST(CoefficientLaw, GivesLanesWhatItGivesOnePair) {
  Uniform uniform(3);
  for (const auto& [name, law] : all_laws()) {
    SCOPED_TRACE(name);
    for (int round = 0; round < 100; ++round) {
      std::vector<double> r(Lanes::count()), i(r), j(r);
      for (std::size_t n = 0; n < r.size(); ++n) {
        r[n] = uniform(0, 1);
        i[n] = uniform(0.3, 3);
        j[n] = uniform(0.3, 3);
      }
      const auto lanes =
          law.factor(Lanes::load(r.data()), Lanes::load(i.data()), Lanes::load(j.data()));
      std::vector<double> value(r), by_i(r), by_j(r);
      lanes.value.store(value.data());
      lanes.by_theta_i.store(by_i.data());
      lanes.by_theta_j.store(by_j.data());
      for (std::size_t n = 0; n < r.size(); ++n) {
        const auto one = law.factor(r[n], i[n], j[n]);
        EXPECT_NEAR(value[n], one.value, 1e-14 * one.value);
        EXPECT_NEAR(by_i[n], one.by_theta_i, 1e-13 * (1 + std::abs(one.by_theta_i)));
        EXPECT_NEAR(by_j[n], one.by_theta_j, 1e-13 * (1 + std::abs(one.by_theta_j)));
      }
    }
  }
}

/// The message of a refusal; empty if nothing is refused.
std::string refusal(const CoefficientLaw::Function& function) {
  try {
    CoefficientLaw::any(function, 2, 1);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(CoefficientLaw, RefusesAFunctionWhereItIsNoLaw) {
  using D = Differentiable;
  const std::string place =
      "the law of a coefficient is refused at distance 0.07 and temperatures ";
  EXPECT_EQ(refusal([](double, const D& i, const D&) -> D { return i; }),
            place +
                "0.62 and 1.14: it is 0.62, but 1.14 with the temperatures exchanged; it has "
                "to be the same");
  EXPECT_EQ(refusal([](double, const D& i, const D& j) -> D { return i * j - 1; }),
            place + "0.62 and 0.62: it is -0.6156, allowed is > 0");
  EXPECT_EQ(refusal([](double, const D& i, const D& j) -> D { return sqrt(i + j - 3); }),
            place + "0.62 and 0.62: its value or a derivative is not a finite number");
  // a function that drops its derivatives would lose the noise-induced terms
  EXPECT_EQ(refusal([](double, const D& i, const D& j) -> D { return i.value() * j.value(); }),
            place +
                "0.62 and 0.62: its derivative by the first temperature is said to be 0, but "
                "is 0.62");
  EXPECT_EQ(refusal([](double r, const D&, const D&) -> D { return 0.1 + r; }), "");
  EXPECT_EQ(refusal(bent), "");
  EXPECT_THROW(CoefficientLaw::any(bent, 0, 1), std::invalid_argument);
  EXPECT_THROW(CoefficientLaw::any(bent, 1, 0), std::invalid_argument);
  EXPECT_THROW(CoefficientLaw::power(std::nan(""), 1), std::invalid_argument);
  EXPECT_THROW(CoefficientLaw::power(1, -1), std::invalid_argument);
}

}  // namespace
}  // namespace driftless::testing
