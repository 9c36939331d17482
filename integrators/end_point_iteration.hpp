#pragma once

#include <cmath>
#include <vector>

#include "integrators/flows.hpp"

namespace driftless {

/// One round of the iteration that solves p' = p + sum f(u'), u' = u + sum g(p', u') over the whole
/// system: p' from the last u', then the next u' from that p' and the same f, so that what g
/// conserves is conserved to rounding in every round.
///   momentum(start, end)      -> the pair's momentum transfer f, from energies u' alone
///   energy(start, end, f)     -> Transfer whose energies are g
class EndPointRound {
 public:
  /// Begins at the present motion.
  void start(const System& system) { trial_ = system.motion(); }

  template <class Momentum, class Energy>
  void evaluate(System& system, Momentum&& momentum, Energy&& energy) {
    system.count_solver_iteration();
    system.accumulate(
        trial_, [&](const auto& start, const auto& end) { return Transfer{momentum(start, end)}; },
        exchange_, {}, Rounds::several);
    take_momenta(system);
    system.accumulate(
        trial_,
        [&](const auto& start, const auto& end) {
          return energy(start, end, momentum(start, end));
        },
        exchange_, {}, Rounds::several);
    take_surroundings_energy(system);
  }

  /// Where the round started: the last u', and after it the p' that follow.
  Motion& trial() { return trial_; }
  /// What the round makes of u' of a particle.
  double next(const System& system, std::size_t i) const {
    return system.motion().internal_energy[i] + exchange_.energy[i];
  }

 private:
  void take_momenta(const System& system) {
    const Motion& start = system.motion();
    for (std::size_t i = 0; i < system.size(); ++i) {
      trial_.velocity[i] = start.velocity[i] + exchange_.momentum[i] * (1 / system.mass(i));
    }
    for (std::size_t n = 0; n < surrounding_places; ++n) {
      trial_.surroundings[n].momentum =
          start.surroundings[n].momentum + exchange_.surroundings[n].momentum;
    }
  }
  void take_surroundings_energy(const System& system) {
    for (std::size_t n = 0; n < surrounding_places; ++n) {
      trial_.surroundings[n].energy =
          system.motion().surroundings[n].energy + exchange_.surroundings[n].energy;
    }
  }

  Motion trial_;
  Exchange exchange_;
};

/// Repeats the round until no u' moves by more than `tolerance` of the mean internal energy, and
/// finishes the step with the Euler move r' = r + v dt. Throws StepFailure. It stays plain: what
/// acceleration saves in rounds it costs in work on vectors (tests/benchmark/fixed_point.cpp).
class EndPointIteration {
 public:
  template <class Momentum, class Energy>
  void step(System& system, double dt, double tolerance, Momentum&& momentum, Energy&& energy) {
    constexpr int most_rounds = 100;
    // Where no amplitude follows the energies the first round solves the equations: another one
    // would find the same bits.
    const bool is_explicit = !system.fluid().noise_follows_energies();
    round_.start(system);
    for (int n = 0; n < most_rounds; ++n) {
      round_.evaluate(system, momentum, energy);
      take_energies(system, tolerance);
      if (moving_.empty() || is_explicit) {
        Motion& start = round_.trial();
        system.swap_motion(start);
        system.move_along(start.velocity, dt);
        return;
      }
    }
    throw StepFailure(FailureCause::not_converged, moving_);
  }

 private:
  /// Takes the new energies and notes whose still moved.
  void take_energies(const System& system, double tolerance) {
    auto& energies = round_.trial().internal_energy;
    const auto& id = system.state().id;
    const double limit = tolerance * system.internal_energy() / static_cast<double>(system.size());
    std::vector<std::uint32_t> negative;
    moving_.clear();
    for (std::size_t i = 0; i < system.size(); ++i) {
      const double next = round_.next(system, i);
      if (!std::isfinite(next)) throw StepFailure(FailureCause::non_finite, {id[i]});
      if (next <= 0) negative.push_back(id[i]);
      if (std::abs(next - energies[i]) > limit) moving_.push_back(id[i]);
      energies[i] = next;
    }
    // No coefficient exists at a negative energy: the iteration cannot go on from here.
    if (!negative.empty()) throw StepFailure(FailureCause::negative_internal_energy, negative);
  }

  EndPointRound round_;
  std::vector<std::uint32_t> moving_;  ///< ids that have not converged
};

/// Gamma at the end of the step and everything else at its start [Bonet Avalos, Mackie, J. Chem.
/// Phys. 111, 5267 (1999), eq. 2.5]: f = F^C dt - zeta v dt + Gamma' dt^{1/2} W.
template <class V>
V end_point_momentum(const Fluid& fluid, const Pair<V>& start, const Pair<V>& end, double dt) {
  using std::sqrt;
  V momentum(0);
  if (fluid.has_repulsion()) momentum += fluid.repulsive_force(start) * dt;
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
