#pragma once

#include "integrators/flows.hpp"

namespace driftless {

/// Velocity Verlet with the conservative forces that puts its energy error back, pair by pair
/// (derived). A kick of F_ij dt/2 from v to v_h gives a pair the kinetic energy
/// (dt/2) F_ij (v + v_h)/2, v along e, so that the step's error is exactly a sum over pairs of
///   Delta_ij = psi(r') - psi(r) + (dt/4) F_ij (v + v_h) + (dt/4) F'_ij (v_h + v'),
/// which is O(dt^3). Each internal energy pays half: u_i -= sum_j Delta_ij/2. Momentum is
/// untouched, only relative velocities enter, and total energy is kept to rounding.
class EnergyKeepingVerlet {
 public:
  void step(System& system, double dt) {
    const auto potential = system.potential_shares();
    half_kick(system, dt);
    system.move(dt);
    half_kick(system, dt);
    const auto& moved = system.potential_shares();
    system.update([&](std::size_t i, Vector&, double& u) { u -= moved[i] - potential[i]; });
  }

 private:
  void half_kick(System& system, double dt) {
    const Fluid& fluid = system.fluid();
    if (!fluid.has_repulsion()) return;
    before_ = system.motion();
    system.kick(dt / 2);
    // At the midpoint it makes no difference which end of the kick a pair takes for its start.
    system.accumulate(
        before_,
        [&](const auto& after_kick, const auto& before_kick) {
          return conservative_work(fluid, 0.5 * dt * fluid.repulsive_force(after_kick), after_kick,
                                   before_kick);
        },
        work_);
    system.apply(work_);
  }

  Motion before_;
  Exchange work_;
};

}  // namespace driftless
