#include "integrators/choice.hpp"
#include "integrators/methods.hpp"
#include "integrators/metropolis.hpp"

namespace driftless {
namespace {

/// Metropolized splitting [Stoltz, J. Comput. Phys. 340, 451 (2017)]: velocity Verlet with the
/// conservative forces alone, then all pairs one after the other, each pair's friction and each
/// pair's conduction proposed in one dimension and accepted or refused against the pair's exact law
/// (metropolis.hpp). The author's program conducts in a sweep of its own after that of friction;
/// here a pair conducts right after its friction, another order of the same moves.
///   `conduction_proposal`  "euler" as published, or "exponential", which stays good at any step
///   `symmetric`            half a sweep, velocity Verlet, half a sweep in reverse order (derived)
/// Exact in law but for the Verlet part at any step; internal energies never fall below 0.
/// Noise-free it is of first order: coefficients are frozen in a pair's update. Conserves momentum,
/// and energy to rounding without a potential.
class MetropolizedSplitting : public Integrator {
 public:
  MetropolizedSplitting(ConductionProposal proposal, bool symmetric)
      : proposal_(proposal), symmetric_(symmetric) {}

  void step(System& system, double dt) override {
    if (symmetric_) sweep(system, dt / 2, {.stage = {0, 2}, .uniforms = true});
    velocity_verlet(system, dt);
    if (symmetric_) {
      sweep(system, dt / 2, {.order = SweepOrder::reverse, .stage = {1, 2}, .uniforms = true});
    } else {
      sweep(system, dt, {.stage = 0, .uniforms = true});
    }
  }

 private:
  void sweep(System& system, double dt, const Sweep& how) const {
    const Fluid& fluid = system.fluid();
    system.sweep(
        [&](const auto& pair) { return metropolis_exchange(fluid, pair, dt, proposal_, how); },
        how);
  }

  ConductionProposal proposal_;
  bool symmetric_;
};

}  // namespace

const Method metropolized_splitting = {
    .name = "metropolized-splitting",
    .title = "Metropolized splitting (Stoltz 2017)",
    .reference = "Stoltz, J. Comput. Phys. 340, 451 (2017)",
    .conserves = "momentum; energy to rounding without a potential; the law of isolated pairs",
    .energy_ideal = EnergyClaim::exact,
    .order_independent = false,
    .pair_law_exact = true,
    .runs_thermal_repulsion = with_any_options,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"conduction_proposal", std::string("euler"),
                 "proposal of conduction: \"euler\" or \"exponential\""},
                {"symmetric", false, "half a sweep before and half a sweep after Verlet"}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<MetropolizedSplitting>(
          conduction_proposal_choice(metropolized_splitting, options),
          option<bool>(metropolized_splitting, options, "symmetric"));
    }};

}  // namespace driftless
