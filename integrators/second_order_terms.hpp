#pragma once

#include "integrators/flows.hpp"

namespace driftless {

/// What the noises change of a pair in a step, to O(dt^{1/2}).
template <class V>
struct NoiseChanges {
  V v, u_i, u_j;
};

/// The exchange of a pair's noises alone, to O(dt^{1/2}): f = Gamma dt^{1/2} W, its work at the
/// velocity of the start, and Lambda dt^{1/2} W^q.
template <class V>
Transfer<V> noise_exchange(const Fluid& fluid, const Pair<V>& pair, double dt) {
  using std::sqrt;
  Transfer<V> total;
  if (fluid.has_friction()) {
    const V kick = sqrt(fluid.friction(pair).noise_squared * dt) * pair.noise;
    const V heat = -0.5 * pair.v * kick;
    total = {kick, heat, heat};
  }
  if (fluid.has_conduction()) {
    const V heat = sqrt(fluid.conduction(pair).noise_squared * dt) * pair.heat_noise;
    total.energy_i += heat;
    total.energy_j -= heat;
  }
  return total;
}

/// Changes by the noises of all pairs, from a trial motion.
template <class V>
NoiseChanges<V> changes(const Pair<V>& start, const TrialPair<V>& end) {
  return {end.dv_i - end.dv_j, end.u_i - start.u_i, end.u_j - start.u_j};
}

/// Changes by the pair's own noises.
template <class V>
NoiseChanges<V> own_changes(const Fluid& fluid, const Pair<V>& pair, double dt) {
  const auto exchange = noise_exchange(fluid, pair, dt);
  return {exchange.momentum / fluid.reduced_mass(pair), exchange.energy_i, exchange.energy_j};
}

/// A pair's exchange over dt to O(dt), the changes by noise inserted into Gamma, Lambda and the
/// random force's work: see avalos-mackie-explicit.
template <class V>
Transfer<V> expanded_exchange(const Fluid& fluid, const Pair<V>& pair,
                              const NoiseChanges<V>& change, double dt) {
  using std::sqrt;
  const auto grown = [&](const AmplitudeSlopes<V>& slopes) {
    return 1 + slopes.by_u_i * change.u_i + slopes.by_u_j * change.u_j;
  };
  Transfer<V> total;
  if (fluid.has_repulsion()) total.momentum += fluid.repulsive_force(pair) * dt;
  if (fluid.has_friction()) {
    const auto law = fluid.friction(pair);
    const V drag = law.friction * pair.v * dt;
    const V kick = sqrt(law.noise_squared * dt) * pair.noise;
    const V grown_kick = kick * grown(fluid.friction_noise_slopes(pair));
    const V heat = 0.5 * (pair.v * (drag - grown_kick) - 0.5 * change.v * kick);
    total += {grown_kick - drag, heat, heat};
  }
  if (fluid.has_conduction()) {
    const auto law = fluid.conduction(pair);
    const V noise = sqrt(law.noise_squared * dt) * pair.heat_noise;
    const V heat = law.rate * dt + noise * grown(fluid.heat_noise_slopes(pair));
    total += {V(0), heat, -heat};
  }
  return total;
}

}  // namespace driftless
