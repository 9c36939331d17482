#pragma once

#include <cmath>
#include <vector>

#include "integrators/flows.hpp"

namespace driftless {

/// Solves p' = p + sum f(u'), u' = u + sum g(p', u') over the whole system by fixed-point iteration
/// and finishes the step with the Euler move r' = r + v dt.
///   momentum(start, end)      -> the pair's momentum transfer f, from energies u' alone
///   energy(start, end, f)     -> Transfer whose energies are g
/// Each round takes p' from the last u' and u' from that p' with the same f, so that what g
/// conserves is conserved to rounding in every round. Converged when no u' moves by more than
/// `tolerance` of the mean internal energy. Throws StepFailure.
class EndPointIteration {
 public:
  template <class Momentum, class Energy>
  void step(System& system, double dt, double tolerance, Momentum&& momentum, Energy&& energy) {
    constexpr int most_rounds = 100;
    trial_ = system.motion();
    for (int round = 0; round < most_rounds; ++round) {
      system.count_solver_iteration();
      system.accumulate(
          trial_,
          [&](const auto& start, const auto& end) { return Transfer{momentum(start, end)}; },
          exchange_);
      set_velocities(system);
      system.accumulate(
          trial_,
          [&](const auto& start, const auto& end) {
            return energy(start, end, momentum(start, end));
          },
          exchange_);
      set_energies(system, tolerance);
      if (moving_.empty()) {
        system.move(dt);
        system.set_motion(trial_);
        return;
      }
    }
    throw StepFailure(FailureCause::not_converged, moving_);
  }

 private:
  void set_velocities(const System& system) {
    const auto& start = system.motion();
    for (std::size_t i = 0; i < system.size(); ++i) {
      trial_.velocity[i] = start.velocity[i] + exchange_.momentum[i] / system.fluid().mass();
    }
  }

  /// Takes the new energies and notes whose still moved.
  void set_energies(const System& system, double tolerance) {
    const auto& start = system.motion();
    const auto& id = system.state().id;
    const double limit = tolerance * system.internal_energy() / static_cast<double>(system.size());
    std::vector<std::uint32_t> negative;
    moving_.clear();
    for (std::size_t i = 0; i < system.size(); ++i) {
      const double next = start.internal_energy[i] + exchange_.energy[i];
      if (!std::isfinite(next)) throw StepFailure(FailureCause::non_finite, {id[i]});
      if (next <= 0) negative.push_back(id[i]);
      if (std::abs(next - trial_.internal_energy[i]) > limit) moving_.push_back(id[i]);
      trial_.internal_energy[i] = next;
    }
    // No coefficient exists at a negative energy: the iteration cannot go on from here.
    if (!negative.empty()) throw StepFailure(FailureCause::negative_internal_energy, negative);
  }

  Motion trial_;
  Exchange exchange_;
  std::vector<std::uint32_t> moving_;  ///< ids that have not converged
};

/// Gamma at the end of the step and everything else at its start [Bonet Avalos, Mackie, J. Chem.
/// Phys. 111, 5267 (1999), eq. 2.5]: f = F^C dt - zeta v dt + Gamma' dt^{1/2} W.
template <class V>
V end_point_momentum(const Fluid& fluid, const Pair<V>& start, const Pair<V>& end, double dt) {
  using std::sqrt;
  V momentum(0);
  if (fluid.has_repulsion()) momentum += fluid.repulsive_force(start.r) * dt;
  if (fluid.has_friction()) {
    momentum += sqrt(fluid.friction(end).noise_squared * dt) * start.noise -
                fluid.friction(start).friction * start.v * dt;
  }
  return momentum;
}

/// Heat with Lambda at the end of the step [same, eq. 2.6]:
/// q = lambda (theta_j - theta_i) dt + Lambda' dt^{1/2} W_q. No explicit noise-induced heat.
template <class V>
Transfer<V> end_point_conduction(const Fluid& fluid, const Pair<V>& start, const Pair<V>& end,
                                 double dt) {
  using std::sqrt;
  if (!fluid.has_conduction()) return {};
  const V heat = fluid.conduction(start).rate * dt +
                 sqrt(fluid.conduction(end).noise_squared * dt) * start.heat_noise;
  return {V(0), heat, -heat};
}

}  // namespace driftless
