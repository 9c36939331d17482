#include "integrators/methods.hpp"
#include "integrators/shardlow.hpp"

namespace driftless {
namespace {

/// The ABOBA order that Shang [SIAM J. Sci. Comput. 43 (2021)] gave isothermal DPD, carried
/// over to internal energies (derived; not published for them): half a move, half a kick, one sweep
/// of pair updates, half a kick, half a move,
///   A(dt/2) B(dt/2) O(dt) B(dt/2) A(dt/2)
/// where O is the sweep of shardlow.hpp, by default with the exact solution at frozen coefficients
/// and the pair's kinetic energy change put back into its internal energies. Noise-free it is of
/// first order, as pairs are swept in one direction. Conserves momentum, and energy to rounding
/// without a potential.
class ShardlowAboba : public Integrator {
 public:
  explicit ShardlowAboba(const ShardlowChoices& choices) : choices_(choices) {}

  void step(System& system, double dt) override {
    system.move(dt / 2);
    system.kick(dt / 2);
    shardlow_sweep(system, dt, SweepOrder::forward, 0, choices_);
    system.kick(dt / 2);
    system.move(dt / 2);
  }

 private:
  ShardlowChoices choices_;
};

}  // namespace

const Method shardlow_aboba = {
    .name = "shardlow-aboba",
    .title = "Shardlow sweep in ABOBA order (derived from Shang 2021)",
    .reference =
        "order of Shang, SIAM J. Sci. Comput. 43 (2021), with the energy update of Lisal, "
        "Brennan, Avalos, J. Chem. Phys. 135, 204105 (2011): derived",
    .conserves = "momentum; energy to rounding without a potential",
    .energy_ideal = EnergyClaim::exact,
    .order_independent = false,
    .isothermal = true,
    .isothermal_pair_law_exact = true,
    .runs_thermal_repulsion = with_any_options,
    .stays_consistent =
        [](const Options& options, const Fluid& fluid) {
          return shardlow_is_consistent(fluid,
                                        option<bool>(shardlow_aboba, options, "as_published"));
        },
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = shardlow_options("exponential"),
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<ShardlowAboba>(shardlow_choices(shardlow_aboba, options));
    }};

}  // namespace driftless
