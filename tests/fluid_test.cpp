#include "model/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

/// Laws are analytic: central differences of steps h err by about h^2 = 1e-8.
double derivative(const std::function<double(double)>& f, double x) {
  const double h = 1e-4 * std::abs(x);
  return (f(x + h) - f(x - h)) / (2 * h);
}

Pair<double> some_pair(Uniform& uniform, const Fluid& fluid) {
  Pair<double> pair{};
  pair.r = uniform(0.05, 0.85);
  pair.w_friction = fluid.friction_weight(pair.r);
  pair.w_heat = fluid.heat_weight(pair.r);
  pair.v = uniform(-2, 2);
  pair.u_i = uniform(2, 40);
  pair.u_j = uniform(2, 40);
  return pair;
}

const std::vector<FrictionClosure> closures = {FrictionClosure::noise, FrictionClosure::friction};
const std::vector<HeatForm> heat_forms = {HeatForm::inverse_temperature, HeatForm::temperature};

/// Calls test(fluid, pair) for both closures, both heat forms, several k and many pairs.
template <class Test>
void for_many_pairs(Test&& test) {
  Uniform uniform(5);
  for (const auto closure : closures) {
    for (const auto heat : heat_forms) {
      for (const double boltzmann : {0.0, 0.5, 2.0}) {
        const Terms terms{closure, heat, true};
        SCOPED_TRACE(terms.name() + ", k = " + std::to_string(boltzmann));
        const Fluid fluid(small_fluid(terms, boltzmann));
        for (int n = 0; n < 30; ++n) test(fluid, some_pair(uniform, fluid));
      }
    }
  }
}

void expect_close(double a, double b, double relative) {
  EXPECT_NEAR(a, b, relative * std::max(std::abs(a), std::abs(b)) + 1e-300);
}

TEST(Friction, ObeysFluctuationDissipationWithTheMeanInverseTemperature) {
  for_many_pairs([](const Fluid& fluid, const Pair<double>& pair) {
    const auto law = fluid.friction(pair);
    const double theta_i = pair.u_i / 12, theta_j = pair.u_j / 12;
    const double mean = 1 / (0.5 * (1 / theta_i + 1 / theta_j));
    expect_close(law.noise_squared, 2 * fluid.boltzmann() * law.friction * mean, 1e-14);
    EXPECT_GT(law.friction, 0);
  });
}

TEST(Friction, InducedTermIsTheDerivativeOfTheNoiseAmplitude) {
  for_many_pairs([](const Fluid& fluid, const Pair<double>& pair) {
    const auto noise_squared = [&](double u_i, double u_j) {
      Pair<double> changed = pair;
      changed.u_i = u_i;
      changed.u_j = u_j;
      return fluid.friction(changed).noise_squared;
    };
    const double along_i =
        derivative([&](double u) { return noise_squared(u, pair.u_j); }, pair.u_i);
    const double along_j =
        derivative([&](double u) { return noise_squared(pair.u_i, u); }, pair.u_j);
    EXPECT_NEAR(fluid.friction(pair).induced, (along_i + along_j) / 4, 1e-7);
    const bool induces =
        fluid.parameters().friction_closure == FrictionClosure::friction && fluid.fluctuates();
    EXPECT_EQ(fluid.friction(pair).induced > 0, induces);
  });
}

TEST(Friction, OfEitherClosureKeepsItsCoefficientWhateverTheTemperatures) {
  for_many_pairs([](const Fluid& fluid, const Pair<double>& pair) {
    Pair<double> hotter = pair;
    hotter.u_i *= 1.7;
    const auto law = fluid.friction(pair), changed = fluid.friction(hotter);
    const auto& f = fluid.parameters();
    if (f.friction_closure == FrictionClosure::friction) {
      EXPECT_EQ(law.friction, changed.friction);
      EXPECT_EQ(law.friction, f.friction * pair.w_friction);
      EXPECT_EQ(changed.noise_squared > law.noise_squared, fluid.fluctuates());
    } else {
      EXPECT_EQ(law.noise_squared, changed.noise_squared);
      EXPECT_LT(changed.friction, law.friction);
    }
  });
}

TEST(Friction, OfBothClosuresAgreesAtTheReferenceTemperature) {
  Uniform uniform(8);
  for (int n = 0; n < 30; ++n) {
    const Fluid noise(small_fluid({FrictionClosure::noise}, 0.5));
    const Fluid friction(small_fluid({FrictionClosure::friction}, 0.5));
    Pair<double> pair = some_pair(uniform, noise);
    pair.u_i = pair.u_j = noise.internal_energy(noise.parameters().temperature);
    const auto a = noise.friction(pair), b = friction.friction(pair);
    expect_close(a.friction, b.friction, 1e-14);
    expect_close(a.noise_squared, b.noise_squared, 1e-14);
    expect_close(a.friction, 4 * pair.w_friction, 1e-14);
    // and nowhere else
    pair.u_i *= 1.1;
    EXPECT_GT(std::abs(noise.friction(pair).friction / friction.friction(pair).friction - 1), 0.01);
  }
}

TEST(Conduction, ObeysFluctuationDissipation) {
  for_many_pairs([](const Fluid& fluid, const Pair<double>& pair) {
    const auto law = fluid.conduction(pair);
    const double theta_i = pair.u_i / 12, theta_j = pair.u_j / 12;
    const double lambda = law.rate / (theta_j - theta_i);
    EXPECT_GT(lambda, 0);
    expect_close(law.noise_squared, 2 * fluid.boltzmann() * lambda * theta_i * theta_j, 1e-10);
  });
}

TEST(Conduction, InducedTermIsTheDerivativeOfTheNoiseAmplitude) {
  for_many_pairs([](const Fluid& fluid, const Pair<double>& pair) {
    const auto noise_squared = [&](double u_i, double u_j) {
      Pair<double> changed = pair;
      changed.u_i = u_i;
      changed.u_j = u_j;
      return fluid.conduction(changed).noise_squared;
    };
    const double along_i =
        derivative([&](double u) { return noise_squared(u, pair.u_j); }, pair.u_i);
    const double along_j =
        derivative([&](double u) { return noise_squared(pair.u_i, u); }, pair.u_j);
    EXPECT_NEAR(fluid.conduction(pair).induced, (along_i - along_j) / 2, 1e-7);
    const bool induces =
        fluid.parameters().heat_form == HeatForm::temperature && fluid.fluctuates();
    EXPECT_EQ(fluid.conduction(pair).induced != 0, induces);
  });
}

TEST(Conduction, IsAntisymmetricInThePair) {
  for_many_pairs([](const Fluid& fluid, const Pair<double>& pair) {
    Pair<double> swapped = pair;
    std::swap(swapped.u_i, swapped.u_j);
    const auto law = fluid.conduction(pair), other = fluid.conduction(swapped);
    expect_close(law.rate, -other.rate, 1e-14);
    expect_close(law.induced, -other.induced, 1e-12);
    expect_close(law.noise_squared, other.noise_squared, 1e-14);
    const auto friction = fluid.friction(pair), mirrored = fluid.friction(swapped);
    expect_close(friction.friction, mirrored.friction, 1e-14);
    expect_close(friction.induced, mirrored.induced, 1e-14);
  });
}

TEST(Conduction, FormsAgreeNearOneTemperatureWhereLambdaIsLOverTSquared) {
  auto f = small_fluid({FrictionClosure::noise, HeatForm::inverse_temperature}, 0.5);
  const Fluid inverse(f);
  f.heat_form = HeatForm::temperature;
  f.conduction /= f.temperature * f.temperature;
  const Fluid direct(f);
  const double u = inverse.internal_energy(f.temperature);
  const Pair<double> pair{0.3,
                          inverse.friction_weight(0.3),
                          inverse.heat_weight(0.3),
                          0.1,
                          u * (1 - 1e-7),
                          u * (1 + 1e-7),
                          0,
                          0};
  expect_close(inverse.conduction(pair).rate, direct.conduction(pair).rate, 1e-6);
  expect_close(inverse.conduction(pair).noise_squared, direct.conduction(pair).noise_squared, 1e-6);
  EXPECT_EQ(direct.conduction(pair).rate,
            6 / (1.1 * 1.1) * pair.w_heat * (pair.u_j / 12 - pair.u_i / 12));
}

TEST(Entropy, HasTheInverseTemperatureAsDerivative) {
  const Fluid fluid(small_fluid({}, 1));
  for (const double u : {0.1, 3.0, 50.0}) {
    const double slope = derivative([&](double x) { return fluid.entropy(x); }, u);
    expect_close(slope, 1 / fluid.temperature(u), 1e-7);
    expect_close(
        derivative([&](double x) { return fluid.internal_energy(x); }, fluid.temperature(u)),
        fluid.heat_capacity(u), 1e-9);
    expect_close(fluid.internal_energy(fluid.temperature(u)), u, 1e-15);
  }
}

TEST(Repulsion, IsTheGradientOfThePotentialAndTheLaplacianItsDivergence) {
  const Fluid fluid(small_fluid({FrictionClosure::noise, HeatForm::none, true}, 1));
  for (const double r : {0.05, 0.3, 0.6, 0.89}) {
    const double slope = derivative([&](double x) { return fluid.potential(x); }, r);
    EXPECT_NEAR(fluid.repulsive_force(r), -slope, 1e-6);
    // div of (psi' e) is (r^2 psi')'/r^2 in three dimensions
    const double flux =
        derivative([&](double x) { return -x * x * fluid.repulsive_force(x); }, r) / (r * r);
    EXPECT_NEAR(fluid.potential_laplacian(r), flux, 1e-5 / r);
  }
  EXPECT_EQ(fluid.repulsive_force(0.0), 15);
  EXPECT_EQ(fluid.potential(0.0), 15 * 0.9 / 2);
  for (const double r : {0.9, 0.91, 5.0}) {
    EXPECT_EQ(fluid.repulsive_force(r), 0);
    EXPECT_EQ(fluid.potential(r), 0);
    EXPECT_EQ(fluid.potential_laplacian(r), 0);
  }
}

TEST(Weight, IsThePowerOfTheDistanceToItsOwnRange) {
  auto f = small_fluid({FrictionClosure::noise, HeatForm::temperature}, 1);
  for (const double exponent : {0.5, 1.0, 2.0, 3.5}) {
    f.weight_exponent = exponent;
    const Fluid fluid(f);
    for (const double r : {0.0, 0.2, 0.7, 0.94}) {
      expect_close(fluid.friction_weight(r), std::pow(1 - r, exponent), 1e-13);
      expect_close(fluid.heat_weight(r), std::pow(1 - r / 0.95, exponent), 1e-13);
    }
    EXPECT_EQ(fluid.friction_weight(1.0), 0);
    EXPECT_EQ(fluid.heat_weight(0.96), 0);
    EXPECT_EQ(fluid.friction_weight(7.0), 0);
  }
}

TEST(Range, IsTheLargestOfTheTermsThatAct) {
  FluidParameters f;
  f.repulsion_range = 3;
  f.friction_range = 2;
  f.heat_range = 4;
  EXPECT_EQ(Fluid(f).range(), 0);
  f.friction = 1;
  EXPECT_EQ(Fluid(f).range(), 2);
  f.repulsion = 1;
  EXPECT_EQ(Fluid(f).range(), 3);
  f.conduction = 1;  // without a form there is no conduction
  EXPECT_EQ(Fluid(f).range(), 3);
  EXPECT_FALSE(Fluid(f).has_conduction());
  f.heat_form = HeatForm::temperature;
  EXPECT_EQ(Fluid(f).range(), 4);
  f.conduction = 0;
  EXPECT_FALSE(Fluid(f).has_conduction());
}

/// The message of a refusal; empty if the parameters are accepted.
std::string refusal_of(double FluidParameters::*parameter, double value) {
  FluidParameters f;
  f.*parameter = value;
  try {
    Fluid fluid(f);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

struct Parameter {
  const char* name;
  double FluidParameters::*member;
  bool may_be_zero;
};
const Parameter parameters[] = {
    {"boltzmann", &FluidParameters::boltzmann, true},
    {"mass", &FluidParameters::mass, false},
    {"temperature", &FluidParameters::temperature, false},
    {"heat_capacity", &FluidParameters::heat_capacity, false},
    {"repulsion", &FluidParameters::repulsion, true},
    {"repulsion_range", &FluidParameters::repulsion_range, false},
    {"friction", &FluidParameters::friction, true},
    {"friction_range", &FluidParameters::friction_range, false},
    {"conduction", &FluidParameters::conduction, true},
    {"heat_range", &FluidParameters::heat_range, false},
    {"weight_exponent", &FluidParameters::weight_exponent, false},
};

TEST(FluidParameters, OutOfTheirRangeAreRefusedByNameAndValue) {
  for (const auto& parameter : parameters) {
    SCOPED_TRACE(parameter.name);
    EXPECT_EQ(refusal_of(parameter.member, 0.5), "");
    EXPECT_EQ(refusal_of(parameter.member, 0) == "", parameter.may_be_zero);
    const std::string range = parameter.may_be_zero ? ">= 0" : "> 0";
    EXPECT_EQ(refusal_of(parameter.member, -0.25),
              std::string(parameter.name) + " is -0.25, allowed is " + range);
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      EXPECT_EQ(refusal_of(parameter.member, value).find(parameter.name), 0U);
    }
  }
}

}  // namespace
}  // namespace driftless::testing
