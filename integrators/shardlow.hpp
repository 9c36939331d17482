#pragma once

#include "integrators/flows.hpp"

namespace driftless {

/// The pair update of Shardlow [SIAM J. Sci. Comput. 24, 1267 (2003)] with the pair's kinetic
/// energy change put back into its internal energies [Lisal, Brennan, Avalos, J. Chem. Phys. 135,
/// 204105 (2011)], coefficients frozen at the start of the update:
///   v1 = v + (1/mu) (-zeta v dt/2 + Gamma dt^{1/2} W/2)
///   v' = [v1 + Gamma dt^{1/2} W/(2 mu)] / (1 + zeta dt/(2 mu))
///   f = mu (v' - v),  u_i -= mu (v'^2 - v^2)/4,  u_j likewise
/// Freezing Gamma leaves the noise-induced friction out: zeta is raised by it unless
/// `as_published`.
template <class V>
Transfer<V> shardlow_friction(const Fluid& fluid, const Pair<V>& pair, double dt,
                              bool as_published) {
  using std::sqrt;
  const double mu = fluid.reduced_mass();
  const auto law = fluid.friction(pair);
  const V zeta = as_published ? law.friction : law.friction + law.induced;
  const V kick = sqrt(law.noise_squared * dt) * pair.noise;
  const V explicit_half = pair.v + (kick - zeta * pair.v * dt) / (2 * mu);
  const V v = (explicit_half + kick / (2 * mu)) / (1 + zeta * dt / (2 * mu));
  const V heat = -0.25 * mu * (v - pair.v) * (v + pair.v);
  return {mu * (v - pair.v), heat, heat};
}

/// Without the noise-induced friction the limit is the model only where there is none.
inline bool shardlow_is_consistent(const Fluid& fluid, bool as_published) {
  const bool induces =
      fluid.has_friction() && fluid.parameters().friction_closure == FrictionClosure::friction;
  return !(as_published && induces);
}

/// Friction of a pair, then its conduction, at dt; in a reverse sweep the other way round.
template <class V>
Transfer<V> shardlow_exchange(const Fluid& fluid, const Pair<V>& pair, double dt, SweepOrder order,
                              bool as_published) {
  const auto friction = [&](const Pair<V>& state) {
    return fluid.has_friction() ? shardlow_friction(fluid, state, dt, as_published) : Transfer<V>{};
  };
  const auto conduction = [&](const Pair<V>& state) {
    return fluid.has_conduction() ? euler_conduction(fluid, state, dt) : Transfer<V>{};
  };
  if (order == SweepOrder::forward) {
    auto total = friction(pair);
    return total += conduction(after(fluid, pair, total));
  }
  auto total = conduction(pair);
  return total += friction(after(fluid, pair, total));
}

/// All pairs one after the other over dt.
inline void shardlow_sweep(System& system, double dt, SweepOrder order, unsigned stage,
                           bool as_published) {
  const Fluid& fluid = system.fluid();
  system.sweep(
      [&](const auto& pair) { return shardlow_exchange(fluid, pair, dt, order, as_published); },
      {.order = order, .stage = stage});
}

}  // namespace driftless
