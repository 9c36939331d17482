#pragma once

#include "integrators/flows.hpp"

namespace driftless {

/// Half of the kinetic energy that a pair gains in half a kick, from either internal energy.
template <class V>
Transfer<V> half_kick_work(const Fluid& fluid, const Pair<V>& start, const TrialPair<V>& end,
                           double dt) {
  const V work = 0.125 * dt * fluid.repulsive_force(start.r) * (start.v + end.v);
  return {V(0), -work, -work};
}

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
    const auto& force = system.conservative_force();
    trial_ = system.motion();
    for (std::size_t i = 0; i < system.size(); ++i) {
      trial_.velocity[i] += force[i] * (dt / (2 * fluid.mass()));
    }
    system.accumulate(
        trial_,
        [&](const auto& start, const auto& end) { return half_kick_work(fluid, start, end, dt); },
        work_);
    for (std::size_t i = 0; i < system.size(); ++i) trial_.internal_energy[i] += work_.energy[i];
    system.set_motion(trial_);
  }

  Motion trial_;
  Exchange work_;
};

}  // namespace driftless
