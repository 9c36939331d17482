#include "integrators/trotter.hpp"
#include "integrators/methods.hpp"
#include "integrators/relaxation.hpp"

namespace driftless {
namespace {

/// Stochastic Trotter splitting by pairs [De Fabritiis, Serrano, Espanol, Coveney, Physica A 361,
/// 429 (2006); Serrano et al., Math. Comput. Simul. 72, 190 (2006)]: every pair's conservative,
/// dissipative and random force together, half a step for all pairs in turn, the move, and half a
/// step in reverse order with noise of its own:
///   prod_{N..1} e^{dt L_pair/2} e^{dt L_move} prod_{1..N} e^{dt L_pair/2}
/// The papers have isothermal DPD and a single energy-conserving particle; a pair's internal
/// energies are carried over from that (derived), see trotter_friction. Noise-free it is of second
/// order under the closure `friction` without conduction; what is frozen in a pair's update brings
/// it down to the first. Conserves momentum, and energy to rounding without a potential.
class Trotter : public Integrator {
 public:
  void step(System& system, double dt) override {
    sweep(system, dt / 2, {.order = SweepOrder::forward, .stage = {0, 2}});
    system.move(dt);
    sweep(system, dt / 2, {.order = SweepOrder::reverse, .stage = {1, 2}});
  }

 private:
  static void sweep(System& system, double dt, const Sweep& how) {
    const Fluid& fluid = system.fluid();
    system.sweep([&](const auto& pair) { return trotter_exchange(fluid, pair, dt, how); }, how);
  }
};

}  // namespace

const Method trotter = {
    .name = "trotter",
    .title = "Stochastic Trotter splitting by pairs (after De Fabritiis 2006)",
    .reference =
        "De Fabritiis, Serrano, Espanol, Coveney, Physica A 361, 429 (2006); Serrano et al., Math. "
        "Comput. Simul. 72, 190 (2006), with a pair's internal energies derived from them",
    .conserves = "momentum; energy to rounding without a potential",
    .energy_ideal = EnergyClaim::exact,
    .order_independent = false,
    .isothermal = true,
    .isothermal_pair_law_exact = true,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<Trotter>();
    }};

}  // namespace driftless
