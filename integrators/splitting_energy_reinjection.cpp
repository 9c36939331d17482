#include "integrators/energy_keeping_verlet.hpp"
#include "integrators/methods.hpp"
#include "integrators/midpoint_work.hpp"

namespace driftless {
namespace {

/// Splitting with energy reinjection, SER [Homman, Maillet, Roussel, Stoltz, J. Chem. Phys. 144,
/// 024112 (2016)]: velocity Verlet with the conservative forces alone, then friction and noise of
/// all pairs at once,
///   v' = v + sum_j f_ij e/m,   f = -(zeta + induced) v dt + Gamma dt^{1/2} W
///   u' = u - sum_j (1/2) f_ij (v + v')/2 + q
/// so that the midpoint velocities, all pairs' forces included, put the kinetic energy change back
/// exactly. Added here are conduction, an Euler step of the same state, and the noise-induced
/// friction of the closure `friction`.
/// `reinject_potential` (derived) puts the Verlet part's error back as well, pair by pair
/// (energy_keeping_verlet.hpp): total energy is then kept to rounding with a potential too.
/// Conserves momentum, and energy to rounding without a potential.
class SplittingEnergyReinjection : public Integrator {
 public:
  explicit SplittingEnergyReinjection(bool reinject_potential)
      : reinject_potential_(reinject_potential) {}

  void step(System& system, double dt) override {
    if (reinject_potential_) {
      verlet_.step(system, dt);
    } else {
      velocity_verlet(system, dt);
    }
    exchange_.step(system, dt);
  }

 private:
  bool reinject_potential_;
  EnergyKeepingVerlet verlet_;
  MidpointWork exchange_;
};

}  // namespace

const Method splitting_energy_reinjection = {
    .name = "splitting-energy-reinjection",
    .title = "Splitting with energy reinjection (SER, Homman 2016)",
    .reference = "Homman, Maillet, Roussel, Stoltz, J. Chem. Phys. 144, 024112 (2016)",
    .conserves = "momentum; energy to rounding without a potential",
    .energy_ideal = EnergyClaim::exact,
    .runs_thermal_repulsion =
        [](const Options& options) {
          return !option<bool>(splitting_energy_reinjection, options, "reinject_potential");
        },
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"reinject_potential", false, "put the Verlet part's energy error back, too"}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<SplittingEnergyReinjection>(
          option<bool>(splitting_energy_reinjection, options, "reinject_potential"));
    }};

}  // namespace driftless
