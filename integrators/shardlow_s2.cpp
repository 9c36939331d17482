#include "integrators/methods.hpp"
#include "integrators/shardlow.hpp"

namespace driftless {
namespace {

/// Shardlow splitting, symmetric [Shardlow 2003, S2; with internal energies as in Lisal, Brennan,
/// Avalos 2011]: half a sweep, velocity Verlet with the conservative forces alone, half a sweep in
/// reverse order with noise of its own. Noise-free it is of second order under the closure
/// `friction` without conduction; the friction frozen at the start of a pair's update under the
/// closure `noise`, and the Euler step of conduction, leave it at first order. Options as in
/// shardlow-s1. Conserves momentum, and energy to rounding without a potential.
class ShardlowS2 : public Integrator {
 public:
  explicit ShardlowS2(const ShardlowChoices& choices) : choices_(choices) {}

  void step(System& system, double dt) override {
    shardlow_sweep(system, dt / 2, SweepOrder::forward, {0, 2}, choices_);
    velocity_verlet(system, dt);
    shardlow_sweep(system, dt / 2, SweepOrder::reverse, {1, 2}, choices_);
  }

 private:
  ShardlowChoices choices_;
};

}  // namespace

const Method shardlow_s2 = {
    .name = "shardlow-s2",
    .title = "Shardlow splitting, symmetric",
    .reference =
        "Shardlow, SIAM J. Sci. Comput. 24, 1267 (2003); "
        "Lisal, Brennan, Avalos, J. Chem. Phys. 135, 204105 (2011)",
    .conserves = "momentum; energy to rounding without a potential",
    .energy_ideal = EnergyClaim::exact,
    .order_independent = false,
    .isothermal = true,
    .isothermal_pair_law_exact = true,
    .runs_thermal_repulsion = with_any_options,
    .stays_consistent =
        [](const Options& options, const Fluid& fluid) {
          return shardlow_is_consistent(fluid, option<bool>(shardlow_s2, options, "as_published"));
        },
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = shardlow_options("half-implicit"),
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<ShardlowS2>(shardlow_choices(shardlow_s2, options));
    }};

}  // namespace driftless
