#include "integrators/choice.hpp"
#include "integrators/methods.hpp"
#include "integrators/pairwise_exchange.hpp"

namespace driftless {
namespace {

/// Lowe-Andersen dynamics with internal energies [after Lowe, Europhys. Lett. 47, 145 (1999)]:
/// velocity Verlet with the conservative forces alone, then all pairs one after the other by
/// lowe_andersen_friction of pairwise_exchange.hpp, their conduction by Metropolis with the
/// exponential proposal of metropolis.hpp. How a pair's velocity is drawn anew where it has
/// internal energies is not published: `resampling` "exact" is derived, "maxwell" is the plain
/// transcription.
///   `rate`  of the jumps in units of zeta/mu; at 1 relative velocities decay in the mean as in the
///           model
/// Pairs jump where the model's diffuse: the law at equilibrium is the model's, its dynamics is
/// not, however small the step, so that the method is not consistent with it. Conserves momentum,
/// and energy to rounding without a potential.
class LoweAndersen : public Integrator {
 public:
  LoweAndersen(double rate, Resampling resampling) : rate_(rate), resampling_(resampling) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    velocity_verlet(system, dt);
    const Sweep how{.uniforms = true};
    system.sweep(
        [&](const auto& pair) {
          return friction_and_conduction(
              fluid, pair, how,
              [&](const auto& seen) {
                return lowe_andersen_friction(fluid, seen, dt, rate_, resampling_);
              },
              [&](const auto& seen) {
                return metropolis_conduction(fluid, seen, dt, ConductionProposal::exponential);
              });
        },
        how);
  }

 private:
  double rate_;
  Resampling resampling_;
};

}  // namespace

const Method lowe_andersen = {
    .name = "lowe-andersen",
    .title = "Lowe-Andersen jumps with internal energies (after Lowe 1999)",
    .reference = "after Lowe, Europhys. Lett. 47, 145 (1999); the exact resampling is derived",
    .conserves = "momentum; energy to rounding without a potential; the law of isolated pairs",
    .energy_ideal = EnergyClaim::exact,
    .consistent = false,
    .order_independent = false,
    .pair_law_exact = true,
    .isothermal = true,
    .isothermal_pair_law_exact = true,
    .runs_thermal_repulsion = with_any_options,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"rate", 1.0, "of jumps, in units of zeta/mu, above 0"},
                {"resampling", std::string("exact"), "of velocities: \"exact\" or \"maxwell\""}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      const auto word = choice(lowe_andersen, options, "resampling", {"exact", "maxwell"});
      return std::make_unique<LoweAndersen>(
          positive_number(lowe_andersen, options, "rate"),
          word == "exact" ? Resampling::exact : Resampling::maxwell);
    }};

}  // namespace driftless
