// A method of your own, in a file of your own: copy it, change the name, write your scheme.

#include <cmath>

#include "integrators/integrator.hpp"

namespace {

using namespace driftless;

/// What a pair exchanges within dt, from the state as it stands: the conservative force, friction
/// and conduction of the Ito equations, each with its noise and with the drift that the noise
/// induces. The fluid gives the coefficients, whatever its closures.
///
/// V is double or several pairs at once: no `if` on a value of V (there is `select`), and functions
/// like sqrt without `std::`. Particle i receives +momentum along the pair's direction e and
/// energy_i; particle j receives -momentum and energy_j.
template <class V>
Transfer<V> collide(const Fluid& fluid, const Pair<V>& pair, double dt) {
  using std::sqrt;
  Transfer<V> total;
  if (fluid.has_repulsion()) total.momentum += fluid.repulsive_force(pair) * dt;
  if (fluid.has_friction()) {
    const auto law = fluid.friction(pair);
    const V drag = (law.friction + law.induced) * pair.v * dt;
    const V kick = sqrt(law.noise_squared * dt) * pair.noise;
    // What the pair's motion loses becomes heat, half in each particle.
    const V heat =
        0.5 * (pair.v * (drag - kick) - law.noise_squared * dt / (2 * fluid.reduced_mass(pair)));
    total += {kick - drag, heat, heat};
  }
  if (fluid.has_conduction()) {
    const auto law = fluid.conduction(pair);
    const V heat = (law.rate + law.induced) * dt + sqrt(law.noise_squared * dt) * pair.heat_noise;
    total += {V(0), heat, -heat};
  }
  return total;
}

/// Collide, then stream: Euler-Maruyama for momenta and internal energies, and positions move with
/// the new velocities.
class MyEuler : public Integrator {
 public:
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.accumulate([&](const auto& pair) { return collide(fluid, pair, dt); }, exchange_);
    system.apply(exchange_);
    system.move(dt);
  }

 private:
  Exchange exchange_;  // kept to save its memory; it carries nothing from step to step
};

/// The name in studies and what the method claims. The suites hold it to every claim, both ways:
/// to claim less than is true fails too. What is not named here has the value of Method.
const Method my_euler = {
    .name = "example-euler",
    .title = "Explicit Euler-Maruyama, collide then stream (example)",
    .reference =
        "Kloeden and Platen, Numerical Solution of Stochastic Differential Equations "
        "(1992), section 9.1",
    .conserves = "momentum; energy in the mean, to first order",
    .weak_order = 1,
    .noise_free_order = 1,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<MyEuler>();
    }};

/// Behind the method, as it reads it.
const Registration registered(my_euler);

}  // namespace
