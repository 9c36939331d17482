#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "integrators/second_order_terms.hpp"
#include "tests/planted_schemes.hpp"
#include "tests/small_system.hpp"

// The second-order terms of avalos-mackie-explicit against the implicit algorithm from whose
// expansion they come: on the same noise, one step of either differs by O(dt^{3/2}) if every term
// is there, by O(dt) if one is missing, among them the products of different pairs' noises.
namespace driftless::testing {
namespace {

constexpr double boltzmann = 0.5;

std::vector<Terms> all_terms() {
  std::vector<Terms> all;
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const auto heat : all_heat_forms()) {
      for (const bool potential : {false, true}) all.push_back({closure, heat, potential});
    }
  }
  return all;
}

using Make = std::function<std::unique_ptr<Integrator>()>;

Make method(std::string_view name, const Options& options = {}) {
  return [=] { return find_method(name)->make(options); };
}

State one_step(const Make& make, const Terms& terms, double dt) {
  System system(Fluid(small_fluid(terms, boltzmann)), small_box(),
                small_state(small_fluid(terms, boltzmann)), Noise(7, 0));
  system.set_step(1);
  make()->step(system, dt);
  return system.state();
}

const Make implicit = method("avalos-mackie-implicit", {{"symmetric_work", true}});

/// The power of dt with which one step's difference from the implicit algorithm vanishes.
double order_of_difference(const Make& make, const Terms& terms) {
  const auto difference = [&](double dt) {
    const auto apart =
        distance(small_box(), one_step(make, terms, dt), one_step(implicit, terms, dt));
    EXPECT_LT(apart.position, 1e-15);
    return std::max(apart.velocity, apart.internal_energy);
  };
  return std::log(difference(1e-4) / difference(1e-6)) / std::log(100);
}

class SecondOrderTerms : public ::testing::TestWithParam<Terms> {};

TEST_P(SecondOrderTerms, AreThoseOfTheImplicitAlgorithm) {
  EXPECT_NEAR(order_of_difference(method("avalos-mackie-explicit"), GetParam()), 1.5, 0.1);
}

// The work of one pair's noise done on what another one moves is of the same order.
TEST_P(SecondOrderTerms, AreNotTheOwnProductsAlone) {
  const auto own = method("avalos-mackie-explicit", {{"own_products", true}});
  EXPECT_NEAR(order_of_difference(own, GetParam()), 1, 0.1);
}

TEST_P(SecondOrderTerms, AreNotTheirMeans) {
  EXPECT_NEAR(order_of_difference(method("averaged-drift"), GetParam()), 1, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Terms, SecondOrderTerms, ::testing::ValuesIn(all_terms()));

// ---- One wrong term at a time. ------------------------------------------------------------------

/// The scheme with changed changes.
class Changed : public Integrator {
 public:
  using Change = std::function<void(NoiseChanges<double>&)>;
  explicit Changed(Change change) : change_(std::move(change)) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.accumulate([&](const auto& pair) { return noise_exchange(fluid, pair, dt); }, exchange_);
    Motion trial = system.motion();
    for (std::size_t i = 0; i < system.size(); ++i) {
      trial.velocity[i] += exchange_.momentum[i] / fluid.mass();
      trial.internal_energy[i] += exchange_.energy[i];
    }
    system.accumulate(
        trial,
        [&](const Pair<double>& start, const TrialPair<double>& end) {
          auto found = changes(start, end);
          change_(found);
          return expanded_exchange(fluid, start, found, dt);
        },
        exchange_);
    system.move(dt);
    system.apply(exchange_);
  }

 private:
  Change change_;
  Exchange exchange_;
};

double order_with(const Changed::Change& change, const Terms& terms) {
  return order_of_difference([&] { return std::make_unique<Changed>(change); }, terms);
}

TEST(SecondOrderFaults, AreSeen) {
  const Terms everywhere{FrictionClosure::friction, HeatForm::temperature, true};
  EXPECT_NEAR(order_with([](auto&) {}, everywhere), 1.5, 0.1);
  EXPECT_NEAR(order_with([](auto& change) { change.v = 0; }, everywhere), 1, 0.1);
  // Twice the work of the pair's own noise, as eq. 2.32 is printed.
  EXPECT_NEAR(order_with([](auto& change) { change.v *= 2; }, everywhere), 1, 0.1);
  EXPECT_NEAR(order_with([](auto& change) { change.u_i = 0; }, everywhere), 1, 0.1);
  EXPECT_NEAR(order_with([](auto& change) { std::swap(change.u_i, change.u_j); }, everywhere), 1,
              0.1);
}

// ---- What the terms are for: energy. ------------------------------------------------------------

/// Root mean square over noises of one step's change of the total energy.
double energy_error(const Make& make, const Terms& terms, double dt) {
  const auto f = small_fluid(terms, boltzmann);
  constexpr int noises = 200;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= noises; ++seed) {
    System system(Fluid(f), small_box(), small_state(f), Noise(seed, 0));
    const double before = system.total_energy();
    system.set_step(1);
    make()->step(system, dt);
    sum += std::pow(system.total_energy() - before, 2);
  }
  return std::sqrt(sum / noises);
}

double order_of_energy_error(const Make& make, const Terms& terms) {
  return std::log(energy_error(make, terms, 1e-4) / energy_error(make, terms, 1e-6)) /
         std::log(100);
}

TEST(SecondOrderTerms, KeepEnergyToAHigherOrderThanTheirMeans) {
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    const Terms terms{closure, HeatForm::temperature, true};
    SCOPED_TRACE(terms.name());
    const auto order = [&](std::string_view name, const Options& options = {}) {
      return order_of_energy_error(method(name, options), terms);
    };
    EXPECT_NEAR(order("avalos-mackie-explicit"), 1.5, 0.1);
    EXPECT_NEAR(order("avalos-mackie-implicit"), 1.5, 0.1);
    EXPECT_NEAR(order("avalos-mackie-explicit", {{"own_products", true}}), 1, 0.1);
    EXPECT_NEAR(order("averaged-drift"), 1, 0.1);
  }
}

// ---- The logarithmic slopes that the expansion rests on. ----------------------------------------

TEST(AmplitudeSlopes, AreDerivativesAndMakeTheNoiseInducedDrift) {
  Uniform uniform(5);
  for (const auto& terms : all_terms()) {
    if (terms.heat == HeatForm::none) continue;
    SCOPED_TRACE(terms.name());
    const Fluid fluid(small_fluid(terms, boltzmann));
    const Pair<double> pair{0.3, 0.49, 0.47, 1, uniform(5, 20), uniform(5, 20), 0, 0};
    const auto derivative = [&](auto&& amplitude, double Pair<double>::*energy) {
      const double h = 1e-5;
      Pair<double> up = pair, down = pair;
      up.*energy += h;
      down.*energy -= h;
      return (std::log(amplitude(up)) - std::log(amplitude(down))) / (2 * h);
    };
    const auto gamma = [&](const auto& p) { return std::sqrt(fluid.friction(p).noise_squared); };
    const auto lambda = [&](const auto& p) { return std::sqrt(fluid.conduction(p).noise_squared); };
    const auto friction = fluid.friction_noise_slopes(pair), heat = fluid.heat_noise_slopes(pair);
    EXPECT_NEAR(friction.by_u_i, derivative(gamma, &Pair<double>::u_i), 1e-9);
    EXPECT_NEAR(friction.by_u_j, derivative(gamma, &Pair<double>::u_j), 1e-9);
    EXPECT_NEAR(heat.by_u_i, derivative(lambda, &Pair<double>::u_i), 1e-9);
    EXPECT_NEAR(heat.by_u_j, derivative(lambda, &Pair<double>::u_j), 1e-9);
    const auto friction_law = fluid.friction(pair);
    const auto heat_law = fluid.conduction(pair);
    EXPECT_NEAR(friction_law.induced,
                0.5 * friction_law.noise_squared * (friction.by_u_i + friction.by_u_j), 1e-12);
    EXPECT_NEAR(heat_law.induced, heat_law.noise_squared * (heat.by_u_i - heat.by_u_j), 1e-12);
    EXPECT_NEAR(2 * boltzmann * fluid.conductivity(pair) * fluid.temperature(pair.u_i) *
                    fluid.temperature(pair.u_j),
                heat_law.noise_squared, 1e-12);
  }
}

}  // namespace
}  // namespace driftless::testing
