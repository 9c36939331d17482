#include "integrators/choice.hpp"
#include "integrators/methods.hpp"
#include "integrators/pairwise_exchange.hpp"

namespace driftless {
namespace {

/// Pairwise thermostat of Peters [Europhys. Lett. 66, 311 (2004)] with the pair's own internal
/// energies for a bath [Pastewka, Kauzlaric, Greiner, Korvink, Phys. Rev. E 73, 037701 (2006)]:
/// velocity Verlet with the conservative forces alone, then all pairs one after the other by
/// peters_friction of pairwise_exchange.hpp. Added here are conduction, an Euler step after the
/// friction of each pair, and the noise-induced friction of the closure `friction`. `scheme` "II"
/// differs from shardlow-s1 with `update` "exponential" only in that Verlet comes first. Keeps
/// Maxwell's law at fixed internal energies for any step; as these are not fixed, the pair's law is
/// off by what vanishes with k/phi and with the step. Conserves momentum, and energy to rounding
/// without a potential.
class Peters : public Integrator {
 public:
  explicit Peters(bool exponential) : exponential_(exponential) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    velocity_verlet(system, dt);
    const Sweep how;
    system.sweep(
        [&](const auto& pair) {
          return friction_and_conduction(
              fluid, pair, how,
              [&](const auto& seen) { return peters_friction(fluid, seen, dt, exponential_); },
              [&](const auto& seen) { return euler_conduction(fluid, seen, dt); });
        },
        how);
  }

 private:
  bool exponential_;
};

}  // namespace

const Method peters = {
    .name = "peters",
    .title = "Pairwise thermostat with local baths (Peters 2004, Pastewka 2006)",
    .reference =
        "Peters, Europhys. Lett. 66, 311 (2004); "
        "Pastewka, Kauzlaric, Greiner, Korvink, Phys. Rev. E 73, 037701 (2006)",
    .conserves = "momentum; energy to rounding without a potential",
    .energy_ideal = EnergyClaim::exact,
    .order_independent = false,
    .isothermal = true,
    .isothermal_pair_law_exact = true,
    .runs_thermal_repulsion = with_any_options,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"scheme", std::string("I"), "of Peters 2004: \"I\" or \"II\""}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<Peters>(choice(peters, options, "scheme", {"I", "II"}) == "II");
    }};

}  // namespace driftless
