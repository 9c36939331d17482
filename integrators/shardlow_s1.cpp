#include "integrators/methods.hpp"
#include "integrators/shardlow.hpp"

namespace driftless {
namespace {

/// Shardlow splitting, one sweep [Shardlow 2003, S1; Lisal, Brennan, Avalos 2011, SSA-VV]: every
/// pair one after the other by the update of shardlow.hpp, conduction pairwise within it; then
/// velocity Verlet with the conservative forces alone. `update` "exponential" solves a pair's
/// velocity exactly at frozen coefficients; `temperatures` "frozen" are those at the start of the
/// sweep, as in LAMMPS; `order` "ids" takes the pairs by ascending ids. Conserves momentum, and
/// energy to rounding without a potential; with one the Verlet part drifts.
class ShardlowS1 : public Integrator {
 public:
  explicit ShardlowS1(const ShardlowChoices& choices) : choices_(choices) {}

  void step(System& system, double dt) override {
    shardlow_sweep(system, dt, SweepOrder::forward, 0, choices_);
    velocity_verlet(system, dt);
  }

 private:
  ShardlowChoices choices_;
};

}  // namespace

const Method shardlow_s1 = {
    .name = "shardlow-s1",
    .title = "Shardlow splitting, one sweep (SSA-VV)",
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
          return shardlow_is_consistent(fluid, option<bool>(shardlow_s1, options, "as_published"));
        },
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = shardlow_options("half-implicit"),
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<ShardlowS1>(shardlow_choices(shardlow_s1, options));
    }};

}  // namespace driftless
