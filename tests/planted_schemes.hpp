#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "experiments/judge/two_body/measure.hpp"
#include "integrators/flows.hpp"

/// Small explicit schemes into which a fault can be put.
namespace driftless::two_body {

using PairExchange = std::function<Transfer<double>(const Fluid&, const Pair<double>&, double)>;

/// Euler-Maruyama for isolated frozen pairs with an exchange given from outside.
class Scheme : public Integrator {
 public:
  explicit Scheme(PairExchange exchange) : pair_exchange_(std::move(exchange)) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.accumulate([&](const Pair<double>& pair) { return pair_exchange_(fluid, pair, dt); },
                      exchange_);
    system.apply(exchange_);
  }

 private:
  PairExchange pair_exchange_;
  Exchange exchange_;
};

inline Factory scheme(PairExchange exchange) {
  return [exchange = std::move(exchange)] { return std::make_unique<Scheme>(exchange); };
}

inline Factory registered(std::string_view name, Options options = {}) {
  const Method* method = find_method(name);
  if (!method) throw std::logic_error("no method named " + std::string(name));
  return [method, options = std::move(options)] { return method->make(options); };
}

/// euler_friction with another friction law.
inline Transfer<double> friction_by(const FrictionLaw<double>& law, const Fluid& fluid,
                                    const Pair<double>& pair, double dt) {
  const double drag = (law.friction + law.induced) * pair.v * dt;
  const double kick = std::sqrt(law.noise_squared * dt) * pair.noise;
  const double heat =
      0.5 * (pair.v * (drag - kick) - law.noise_squared * dt / (2 * fluid.reduced_mass()));
  return {kick - drag, heat, heat};
}

/// The sound exchange but for a change of the friction law.
inline PairExchange with_friction(std::function<void(FrictionLaw<double>&)> change) {
  return [change = std::move(change)](const Fluid& fluid, const Pair<double>& pair, double dt) {
    auto law = fluid.friction(pair);
    change(law);
    auto total = friction_by(law, fluid, pair, dt);
    return total += euler_conduction(fluid, pair, dt);
  };
}

/// The sound exchange but for the heat, which goes to i and to j.
inline PairExchange with_heat(
    std::function<Transfer<double>(const ConductionLaw<double>&, const Pair<double>&, double)>
        heat) {
  return [heat = std::move(heat)](const Fluid& fluid, const Pair<double>& pair, double dt) {
    auto total = euler_friction(fluid, pair, dt);
    return total += heat(fluid.conduction(pair), pair, dt);
  };
}

/// The sound exchange but for the energy that each particle receives from friction, given drag,
/// kick and the relative velocity's change.
inline PairExchange with_work(std::function<double(const Fluid&, double, double, double)> work) {
  return [work = std::move(work)](const Fluid& fluid, const Pair<double>& pair, double dt) {
    const auto law = fluid.friction(pair);
    const double drag = (law.friction + law.induced) * pair.v * dt;
    const double kick = std::sqrt(law.noise_squared * dt) * pair.noise;
    const double heat = work(fluid, pair.v, drag, kick);
    Transfer<double> total{kick - drag, heat, heat};
    return total += euler_conduction(fluid, pair, dt);
  };
}

/// Heat noises of i and j drawn independently.
class IndependentHeatNoises : public Integrator {
 public:
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    const auto noise = [&](const Pair<double>& pair) {
      return std::sqrt(fluid.conduction(pair).noise_squared * dt) * pair.heat_noise;
    };
    system.accumulate(
        [&](const Pair<double>& pair) {
          auto total = euler_exchange(fluid, pair, dt);
          total.energy_j += noise(pair);
          return total;
        },
        first_);
    system.accumulate(
        [&](const Pair<double>& pair) {
          return Transfer<double>{0, 0, noise(pair)};
        },
        second_, 1);
    system.apply(first_);
    system.apply(second_);
  }

 private:
  Exchange first_, second_;
};

}  // namespace driftless::two_body
