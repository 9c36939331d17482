#pragma once

#include "integrators/relaxation.hpp"

namespace driftless {

/// A pair under its conservative, dissipative and random force over dt at a fixed distance, the
/// coefficients frozen, zeta raised by what is noise-induced:
///   v' = e^{-x} v + (F^C/zeta)(1 - e^{-x}) + (Gamma/mu) {dt (1 - e^{-2x})/(2x)}^{1/2} W,
///   x = zeta dt/mu
/// solves mu dv = (F^C - zeta v) dt + Gamma dB. Of the transfer f = mu (v' - v) the part F^C dt is
/// conservative and its work belongs to the potential; the rest is paid by the internal energies at
/// the midpoint velocity, u_i -= (f - F^C dt)(v + v')/4, u_j likewise.
template <class V>
Transfer<V> trotter_friction(const Fluid& fluid, const Pair<V>& pair, double dt) {
  const double mu = fluid.reduced_mass(pair);
  const V force = fluid.has_repulsion() ? fluid.repulsive_force(pair) : V(0);
  if (!fluid.has_friction()) return Transfer{force * dt};
  const auto law = fluid.friction(pair);
  const V zeta = law.friction + law.induced;
  const V dv = ornstein_uhlenbeck(pair, zeta, law.noise_squared, mu, dt) +
               force * dt / mu * mean_decay(zeta * dt / mu);
  const V momentum = mu * dv;
  const V heat = -0.25 * (momentum - force * dt) * (2 * pair.v + dv);
  return {momentum, heat, heat};
}

/// All forces of a pair, then its conduction, over dt; in a reverse sweep the other way round.
template <class V>
Transfer<V> trotter_exchange(const Fluid& fluid, const Pair<V>& pair, double dt, const Sweep& how) {
  return one_after_the_other(
      fluid, pair, how, [&](const Pair<V>& seen) { return trotter_friction(fluid, seen, dt); },
      [&](const Pair<V>& seen) {
        return fluid.has_conduction() ? euler_conduction(fluid, seen, dt) : Transfer<V>{};
      });
}

}  // namespace driftless
